// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The block-tridiagonal elimination against the sum of all cells, also on several ranks and with more ranks than cells.
#include "../../support/test.h"

#include <crawler/mesh/block_tridiagonal_matrix.h>

using namespace crawler;

namespace
{
  /// A number between -1 and 1 that depends on its place only.
  double
  scattered(const std::size_t i)
  {
    return std::sin(12.9898 * static_cast<double>(i + 1) + 78.233);
  }

  /// Cell block entry: not symmetric, with a dominant diagonal.
  double
  entry(const std::size_t cell, const unsigned int i, const unsigned int j, const unsigned int n)
  {
    return scattered((cell * n + i) * n + j) + (i == j ? 2. * n : 0.);
  }

  void
  fill(BlockTridiagonalMatrix<double> &matrix, const Discretization &d, const std::size_t first_cell)
  {
    const unsigned int n = d.element.n;
    for (std::size_t c = 0; c < d.n_local_cells(); ++c)
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          matrix.blocks[(c * n + i) * n + j] = entry(first_cell + c, i, j, n);
  }
} // namespace

TEST(BlockTridiagonalMatrix, IsTheSumOfItsCells)
{
  for (const unsigned int q : {1u, 2u, 3u, 5u, 8u})
    for (const unsigned int n_cells : {1u, 2u, 3u, 7u, 20u})
    {
      const Discretization d(MPI_COMM_WORLD, 1., n_cells, q);
      BlockTridiagonalMatrix<double> matrix(d);
      const auto first_cell =
        static_cast<std::size_t>(d.n_local_cells() == 0 ? 0 : std::lround(d.cell_left[0] * n_cells));
      fill(matrix, d, first_cell);

      const unsigned int N = n_cells * q + 1;
      std::vector<double> x(N), b(N);
      for (unsigned int i = 0; i < N; ++i)
        x[i] = scattered(1000 + i);
      for (unsigned int c = 0; c < n_cells; ++c)
        for (unsigned int i = 0; i <= q; ++i)
          for (unsigned int j = 0; j <= q; ++j)
            b[c * q + i] += entry(c, i, j, q + 1) * x[c * q + j];

      const std::size_t first = first_cell * q + (d.has_left_neighbour() ? 1 : 0);
      std::vector<double> own(d.n_owned()), result(d.n_owned());
      for (std::size_t i = 0; i < own.size(); ++i)
        own[i] = x[first + i];
      matrix.multiply(own, result);
      for (std::size_t i = 0; i < own.size(); ++i)
        EXPECT_NEAR(result[i], b[first + i], 1e-12 * N) << "multiply, degree " << q << ", cells " << n_cells;

      ASSERT_TRUE(matrix.factorize());
      matrix.solve(result, result);
      for (std::size_t i = 0; i < own.size(); ++i)
        EXPECT_NEAR(result[i], x[first + i], 1e-12) << "solve, degree " << q << ", cells " << n_cells;
    }
}

TEST(BlockTridiagonalMatrix, ReportsASingularMatrix)
{
  const Discretization d(MPI_COMM_WORLD, 1., 6, 3);
  BlockTridiagonalMatrix<double> matrix(d);
  EXPECT_FALSE(matrix.factorize()); // all zeros
  fill(matrix, d, 0);
  if (d.rank == 0)
    matrix.blocks[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(matrix.factorize()); // on every rank
}
