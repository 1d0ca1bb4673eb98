// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// Values of general laws at the points [cell][point] of a run of cells, for the present state; f is the friction per
  /// reference length, N the force in the body. The first two, k and m are always set; without @p f_u friction does not
  /// depend on the place, without @p N_rate the force does not depend on the stretch rate.
  template <typename Number>
  struct PointLaws
  {
    Number *N, *f, *f_u, *f_v, *w_f_w, *N_w, *N_rate, *k;
    const Number *m;
  };
} // namespace crawler
