// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>

namespace crawler
{
  class Declarations;

  /// Section "Discretization"; what is left empty is chosen from the wanted accuracy.
  struct DiscretizationParameters
  {
    std::optional<unsigned int> degree;
    std::optional<unsigned int> n_cells;

    void
    add_parameters(Declarations &declarations);
  };
} // namespace crawler
