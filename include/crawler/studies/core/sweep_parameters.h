// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>

namespace crawler
{
  class Declarations;

  /// What Sweep/Axes reads, in words.
  extern const std::string sweep_syntax;

  /// Section "Sweep": which scenes `crawler sweep` computes (sweep_design.h reads the axes).
  struct SweepParameters
  {
    static constexpr unsigned int most_points = 10000000;

    std::string design      = "grid";
    std::string axes        = "";
    unsigned int n_points   = 100; ///< of a random or Latin hypercube design
    unsigned int seed       = 1;
    std::string keep_fields = "";
    std::optional<double> point_time_limit; ///< [s]
    std::optional<double> time_limit;       ///< [s]

    void
    add_parameters(Declarations &declarations);
  };
} // namespace crawler
