// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>

namespace crawler
{
  /// How samples become a table.
  struct PreparationSettings
  {
    unsigned int largest_gap = 3;      ///< samples in a row that may be filled
    double width_s = 0., width_t = 0.; ///< of the smoothing (base/smoothing_spline.h)
    std::string period;                ///< empty: none; "find"; "whole": the duration; or a number
    std::optional<double> noise;       ///< standard deviation of a sample
    unsigned int n_s = 0, n_t = 0;     ///< equally spaced points of the table; 0: those of the samples
    unsigned int n_cycles = 1;         ///< how often a period is repeated
    std::string material  = "first";   ///< places of markers: "first" frame, "mean" of all, or a list of numbers
    double first_marker   = 0.;        ///< place of the first one, unless there is a list [length]
    std::optional<double> length;      ///< of the body; else that up to the last marker
    std::string ends = "hold";         ///< strain beyond the outermost markers: "hold" or "linear"
  };
} // namespace crawler
