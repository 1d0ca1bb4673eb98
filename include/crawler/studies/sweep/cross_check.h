// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/base/words.h>
#include <crawler/studies/core/compute.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace crawler
{
  /// Answer of one run to a scene.
  struct Claim
  {
    std::string run;    ///< its name in explanations
    std::string status; ///< finished and inverted are answers; anything else (failed, stopped, ...) claims nothing
    double displacement   = NAN; ///< at the end time, if finished [length]
    double promised_error = NAN; ///< error of the displacement, if promised [length]
    double inversion_time = NAN; ///< time of inversion, if inverted [time]
  };

  /// Knowledge about the inversion of a scene without a run (doc/theory.md, "When a body can invert").
  struct InversionFacts
  {
    double end_time      = 1.;   ///< T [time]
    bool possible_inside = true; ///< a > -1
    /// Earliest and latest time of inversion of an end; infinite if no end inverts.
    double earliest_at_end = HUGE_VAL;
    double latest_at_end   = HUGE_VAL;
  };

  /// Relative tolerance, as a part of the end time, within which times of inversion agree.
  constexpr double inversion_time_tolerance = 1e-3;

  /// Verdict on whether the runs of one scene can all be right.
  struct Verdict
  {
    enum Kind
    {
      agree,               ///< all answers are consistent
      unchecked,           ///< no two answers to compare
      silent_wrong_answer, ///< two answers contradict each other, or one contradicts the theory
    };
    Kind kind = unchecked;
    std::string explanation; ///< explanation of a wrong answer, in a sentence
  };
  template <>
  inline constexpr const char *words_of<Verdict::Kind>[] = {"agree", "unchecked", "silent wrong answer"};

  /**
   * Compares answers to one scene. Each of @p runs is compared with @p refined, or, if that one gave no answer, with
   * each other run; and each, including refined, with the theory. Two answers contradict each other if
   * - both finished, and the displacements differ by more than the sum of the promised errors (no promise, no check);
   * - one finished, and the other inverted before T;
   * - both inverted, at different times.
   * An answer contradicts the theory if
   * - an end must have inverted, but the run did not invert by then;
   * - it inverted earlier than an end, where the body cannot invert inside (a <= -1).
   * Times differ if they do so by more than inversion_time_tolerance T. A run that failed with a name, was stopped or
   * was refused is not an answer, and so never wrong.
   */
  Verdict
  cross_check(const std::vector<Claim> &runs, const Claim &refined, const InversionFacts &facts);

  /// Columns of the other runs of a point, in both forms and refined, and of the verdict, in the table of a sweep (a
  /// contract, doc/user_guide.md, "Sweep").
  std::vector<RowFile::Column>
  checked_columns();

  /// Values in these columns for each of @p points, which have been computed, all with gait numbers or all without.
  /// Failures are the status of a run. The runs of all points share the lanes (compute_all()); each has the time limit
  /// of a point. Results are of no use once @p interrupted returns true.
  std::vector<RowFile::Row>
  checked_values(const std::vector<const Task *> &points, const std::function<bool()> &interrupted);
} // namespace crawler
