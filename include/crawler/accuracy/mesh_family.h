// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/answer.h>

#include <functional>

namespace crawler
{
  /**
   * Answer of the stretch form with a @p choice (NumericsChoice::is_family): runs on a family of meshes, each twice as
   * fine as the one before, until the extrapolated displacement
   *
   *   R_i = (4 D_i - D_{i-1})/3
   *
   * is as accurate as wanted (doc/numerics.md, "Stretch form"). The bound consists of the last change of R, or of D if
   * the observed order is not 2, and of the change with a tenth of the time tolerance on the coarsest mesh. Works and
   * the displacement of the last stride are extrapolated alike; all else is that of the finest mesh. If the body
   * inverts the time of inversion has to settle. @p options are those of each run, without output times;
   * @p is_for_other_form says, before a mesh that takes very long, whether the position form has a mesh that may do.
   */
  Answer
  answer_of_family(const Problem &problem,
                   const NumericsChoice &choice,
                   const RecordOptions &options,
                   const std::function<bool()> &is_for_other_form);
} // namespace crawler
