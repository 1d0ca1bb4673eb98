// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/answer.h>

#include <functional>

namespace crawler
{
  /**
   * Answer where jumps of the active stress move along the body (NumericsChoice::has_fronts). No mesh follows them, and
   * on any mesh the error falls like the size of a cell. But with fronts of the width d in place of the jumps the scene
   * is smooth, and its displacement D(d) is a smooth function of d: so D is computed for d_k = d_0/2^k, by @p
   * answer_of, and extrapolated to 0 by the polynomial through the last of them (doc/numerics.md, "Jumps that move"),
   *
   *   D = sum_k c_k D(d_k),    c_k = prod_(j != k) d_j/(d_j - d_k).
   *
   * The bound is the change by one width less, and |c_k| times the bounds of the runs. Works, the displacement of the
   * last stride and extreme stretches are extrapolated alike; all else is that of the steepest fronts.
   */
  Answer
  answer_of_fronts(const Problem &problem, const std::function<Answer(const Problem &)> &answer_of);

  /// Scene of the run whose pictures and fields are shown: with the steepest fronts in place of jumps that move.
  Scene
  shown_scene(const NumericsChoice &choice, const Scene &scene);
} // namespace crawler
