// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>
#include <crawler/scene/body.h>

#include <memory>
#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Active stress/Library".
  struct LibraryParameters
  {
    std::string file       = "libmy_stress.so";
    std::string parameters = "";

    void
    add_parameters(Declarations &declarations);
  };

  /**
   * Loads an active stress from a shared object compiled by the user (stress_plugin.h). Exceptions and values that are
   * not finite are caught and kept as failures; the values are NaN there, which ends a run in order on all ranks.
   * Throws InputError if there is no such file, if it is not a shared object for this machine or not a plug-in of this
   * version, if it does not know one of the parameters, or, with its message, if it throws.
   */
  std::unique_ptr<ActiveStress>
  load_library(const LibraryParameters &parameters, const Body &body, double end_time);
} // namespace crawler
