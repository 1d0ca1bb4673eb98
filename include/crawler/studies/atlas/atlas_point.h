// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/atlas/cross_check.h>
#include <crawler/studies/core/parameters.h>

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// What one of the runs at a point of the atlas gave; what is not known is not a number.
  struct AtlasRun
  {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    std::string status; ///< finished, inverted, failed, stopped, refused; empty if it was not asked for
    std::string reason, message;
    double displacement   = unknown; ///< at the end time, if finished [length]
    double promised_error = unknown; ///< of the displacement, that Accuracy stands for [length]
    double measured_error = unknown; ///< difference of the displacement to that of the refined run [length]
    double inversion_s = unknown, inversion_t = unknown;
    double min_stretch = unknown;
    double steps = unknown, seconds = unknown;
    bool is_stretch = false; ///< from the start
  };

  /// A point of the atlas: one scene, computed in several ways.
  struct AtlasPoint
  {
    enum Run
    {
      automatic, ///< what `crawler run` answers
      position,
      stretch,
      refined,
      n_runs
    };
    static constexpr std::array<const char *, n_runs> run_names = {{"run", "position", "stretch", "refined"}};

    std::array<AtlasRun, n_runs> runs;
    std::string outcome; ///< finished, inverted inside, inverted at end, failed: REASON, stopped: REASON, refused,
                         ///< silent wrong answer
    Verdict verdict;
  };

  /// A point at which the program crashed twice: it has no answer, and the reason says so.
  AtlasPoint
  crashed_point();

  /// Computes the scenes of all @p points in all forms and refined, and compares. Nothing is thrown: what goes wrong is
  /// the status of a run. Nothing is returned if @p interrupted said so before the end.
  std::optional<std::vector<AtlasPoint>>
  compute_points(const std::vector<Parameters> &points, const std::function<bool()> &interrupted);
} // namespace crawler
