// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace crawler
{
  /// Refinement of the cells towards the ends of the body and both sides of each discontinuity in space.
  struct Grading
  {
    unsigned int levels = 0;    ///< cells added at each of these places; 0: none
    double ratio        = 0.25; ///< ratio of the sizes of neighbours among them [1], in (0, 1)
  };

  /**
   * The ends of the cells of a body of length 1, from 0 to 1; empty if all cells have one size, 1/n_cells. @p breaks
   * (ascending, in (0, 1)) are ends of cells. The pieces between them get at least one cell each, two if they are
   * graded, and cells of one size in proportion to their lengths as far as whole numbers allow: @p n_cells altogether,
   * or min_graded_cells() if that is more. Then the cell at each end of a piece is divided at ratio^levels, ...,
   * ratio^2, ratio of its size, seen from that end.
   */
  std::vector<double>
  cell_ends(unsigned int n_cells, const std::vector<double> &breaks, const Grading &grading);

  /// Least number of cells, before grading, that matters: cell_ends() gives the same mesh for fewer.
  unsigned int
  min_graded_cells(std::size_t n_breaks, const Grading &grading);

  /// Number of cells, before grading, of a mesh that is certainly finer than that of @p n_cells: @p factor times as
  /// many, or one more for each piece between breaks if that is more.
  unsigned int
  finer_n_cells(double factor, unsigned int n_cells, std::size_t n_breaks, const Grading &grading);

  /**
   * The ends of cells of a body of length 1 that are images of cells of one size: half of them lie in layers at the
   * ends of the body and at the @p breaks, with cells about twice as large at the distance @p layer. Each piece between
   * the breaks has its share of @p n_cells (4 at least), each divided into @p parts: these meshes are one family, and
   * errors of second order fall with the square of @p parts.
   *
   * The density of the cells of a piece of length l is A/(layer + s) + A/(layer + l - s) + B.
   */
  std::vector<double>
  layered_cell_ends(unsigned int n_cells, unsigned int parts, const std::vector<double> &breaks, double layer);
} // namespace crawler
