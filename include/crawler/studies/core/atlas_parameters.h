// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Atlas": the map that `crawler atlas` makes.
  struct AtlasParameters
  {
    std::string first_axis, second_axis;
    double refinement = 10.;
    double time_limit = 30.; ///< [s]

    void
    add_parameters(Declarations &declarations);
  };
} // namespace crawler
