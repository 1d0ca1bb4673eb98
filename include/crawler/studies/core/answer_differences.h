// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/parameters.h>

#include <array>
#include <functional>
#include <vector>

namespace crawler
{
  /// How far apart the values of an entry should be whose answers have this error, relative to the value [1].
  double
  step_of_differences(double relative_error);

  /// Where the other answers are, in steps: two differences, one of them far coarser.
  inline constexpr std::array<int, 4> around_answer = {{-4, -1, 1, 4}};

  /// What `crawler run` answers if an entry is larger by @p step times each of @p places.
  struct VariedAnswers
  {
    std::vector<Parameters> parameters;
    std::vector<int> places; ///< around_answer, or 1, 2, 3, 4 or their negatives
    double step;             ///< in units of the entry
  };

  /**
   * Derivatives of the displacement and of other numbers by an entry, as differences of fourth order of whole answers,
   * for scenes and methods that have no adjoint (doc/numerics.md, "Sensitivities"). The bound is the difference to a
   * coarse formula, what a kink would do, and what the bounds of the answers make of it. @p result is the answer in the
   * middle. A reason is set instead where an answer is missing or has no bound. Returns false if the displacement seems
   * to have a kink; then nothing is set.
   */
  bool
  differentiate_answers(VariedAnswers varied,
                        const SimulationResult &result,
                        EntrySensitivity &sensitivity,
                        const std::function<bool()> &keep_going);
} // namespace crawler
