// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/position_form.h>

namespace crawler
{
  /**
   * The state @p y of the position form @p from, on the mesh of @p to; meshes may differ by one level (collective).
   *
   * A halved cell keeps its polynomials. In a cell joined from two halves the stretch becomes its L2 projection; so the
   * displacement at the cell's ends, the length of each cell and (degree 2 and above) the cell's centre of mass stay,
   * and elastic energy can only be lost. Finally a rigid shift makes the centre of mass exact for every degree.
   */
  std::vector<double>
  transferred(const PositionForm &from, std::span<const double> y, const PositionForm &to);
} // namespace crawler
