// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/parameters.h>

#include <array>
#include <functional>
#include <vector>

namespace crawler
{
  /// Step between answers with this relative error from which an entry is differentiated, relative to its value [1].
  double
  step_of_differences(double relative_error);

  /// Places of the other answers, in steps: two differences, one of them far coarser.
  inline constexpr std::array<int, 4> around_answer = {{-4, -1, 1, 4}};

  /// Parameters of answers with an entry increased by @p step times each of @p places.
  struct VariedAnswers
  {
    std::vector<Parameters> parameters;
    std::vector<int> places; ///< around_answer, or 1, 2, 3, 4 or their negatives
    double step;             ///< in units of the entry
  };

  /**
   * Derivatives of the displacement and of other numbers by an entry, as differences of fourth order of whole answers,
   * for scenes and methods that have no adjoint (doc/numerics.md, "Sensitivities"). The error bound is the sum of the
   * difference to a coarse formula, the contribution of a kink, and the error bounds of the answers. @p result is the
   * answer in the middle. A reason is set instead where an answer is missing or has no bound. Returns false, with
   * nothing set, if the displacement seems to have a kink.
   */
  bool
  differentiate_answers(VariedAnswers varied,
                        const SimulationResult &result,
                        EntrySensitivity &sensitivity,
                        const std::function<bool()> &keep_going);
} // namespace crawler
