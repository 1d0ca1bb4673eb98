// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/mesh/discretization.h>
#include <crawler/mesh/graded_mesh.h>

using namespace crawler;

TEST(GradedMesh, PutsCellsInProportionBetweenTheBreaks)
{
  EXPECT_TRUE(cell_ends(7, {}, {}).empty());
  for (const unsigned int n : {1u, 3u, 4u, 10u, 37u, 1000u})
  {
    const std::vector<double> breaks = {0.05, 0.4, 0.7};
    const std::vector<double> ends   = cell_ends(n, breaks, {});
    EXPECT_EQ(ends.size(), std::max(n, 4u) + 1);
    EXPECT_TRUE(std::is_sorted(ends.begin(), ends.end()));
    EXPECT_EQ(ends.front(), 0.);
    EXPECT_EQ(ends.back(), 1.);
    for (const double s : breaks)
      EXPECT_NE(std::find(ends.begin(), ends.end(), s), ends.end());
    double smallest = 1., largest = 0.;
    for (std::size_t i = 1; i < ends.size(); ++i)
    {
      if (ends[i - 1] >= 0.05) // shorter pieces have one cell
        smallest = std::min(smallest, ends[i] - ends[i - 1]);
      largest = std::max(largest, ends[i] - ends[i - 1]);
    }
    if (n >= 10)
    {
      EXPECT_LT(largest, 1.6 * smallest) << n;
    }
  }
}

TEST(GradedMesh, GoesDownGeometricallyToEndsAndBreaks)
{
  for (const auto &breaks : {std::vector<double>(), std::vector<double>{0.5}})
  {
    const unsigned int levels = 5, pieces = static_cast<unsigned int>(breaks.size()) + 1;
    const std::vector<double> ends = cell_ends(4, breaks, {levels, 0.2});
    EXPECT_EQ(ends.size() - 1, 4 + 2 * levels * pieces);
    for (std::size_t i = 1; i <= levels; ++i)
    {
      EXPECT_NEAR(ends[i], 0.25 * std::pow(0.2, levels + 1 - i), 1e-15);
      EXPECT_NEAR(ends[ends.size() - 1 - i], 1. - ends[i], 1e-15);
    }
    if (!breaks.empty())
    {
      const auto at = std::find(ends.begin(), ends.end(), 0.5) - ends.begin();
      for (std::size_t i = 1; i <= levels; ++i)
      {
        EXPECT_NEAR(ends[at + i] - 0.5, ends[i], 1e-15);
        EXPECT_NEAR(0.5 - ends[at - i], ends[i], 1e-15);
      }
    }
  }
  // A single cell is halved first.
  EXPECT_EQ(cell_ends(1, {}, {1, 0.5}), (std::vector<double>{0., 0.25, 0.5, 0.75, 1.}));
}

/// A mesh that is asked to be finer is: also where pieces have few cells, which are halved to be graded.
TEST(GradedMesh, HasMoreCellsWhereMoreAreAskedFor)
{
  for (const auto &breaks : {std::vector<double>{0.18, 0.46, 0.73}, {0.25, 0.5, 0.75}, {0.9, 0.95}, {0.5}})
    for (const Grading &grading : {Grading{}, Grading{2, 0.25}, Grading{4, 0.4}})
      for (const unsigned int n : {1u, 4u, 5u, 7u, 8u, 11u, 30u})
        for (const double factor : {1.1, 1.5, 2.})
        {
          const auto before = cell_ends(n, breaks, grading);
          const auto after  = cell_ends(finer_n_cells(factor, n, breaks.size(), grading), breaks, grading);
          EXPECT_GT(after.size(), before.size()) << n;
        }
}

/// Cells of any size can be divided and joined; after all is joined the first mesh is there again.
TEST(GradedMesh, CanBeAdapted)
{
  const std::vector<double> ends = cell_ends(3, {0.3}, {2, 0.3});
  auto mesh                      = std::make_unique<Discretization>(MPI_COMM_WORLD, ends, 3);
  const auto first               = mesh->cells;
  ASSERT_EQ(first.size(), ends.size() - 1);
  for (std::size_t c = 0; c < first.size(); ++c)
  {
    EXPECT_EQ(first[c].left, ends[c]);
    EXPECT_EQ(first[c].size, ends[c + 1] - ends[c]);
  }
  for (const unsigned int divided : {1u, 2u, 6u})
  {
    std::vector<CellChange> changes(mesh->n_cells(), CellChange::keep);
    changes[divided] = CellChange::divide;
    mesh             = mesh->adapted(changes);
  }
  EXPECT_GE(mesh->n_cells(), first.size() + 3);
  double left = 0.;
  for (const Cell &cell : mesh->cells)
  {
    EXPECT_NEAR(cell.left, left, 1e-15);
    left = cell.left + cell.size;
  }
  EXPECT_NEAR(left, 1., 1e-15);
  // Joined where the indicators are nothing.
  for (int i = 0; i < 5; ++i)
    mesh = mesh->adapted(std::vector<CellChange>(mesh->n_cells(), CellChange::join));
  ASSERT_EQ(mesh->n_cells(), first.size());
  for (std::size_t c = 0; c < first.size(); ++c)
    EXPECT_NEAR(mesh->cells[c].size, first[c].size, 1e-15);
}

TEST(LayeredMesh, EndsAtTheBreaks)
{
  for (const double layer : {1e-9, 1e-3, 0.02, 0.5})
    for (const unsigned int parts : {1u, 2u, 8u})
    {
      const std::vector<double> breaks = {0.05, 0.4, 0.7};
      const std::vector<double> ends   = layered_cell_ends(26, parts, breaks, layer);
      // In proportion to the lengths of the pieces, 4 at least.
      EXPECT_EQ(ends.size(), parts * (4 + 9 + 8 + 8) + 1);
      EXPECT_EQ(ends.front(), 0.);
      EXPECT_EQ(ends.back(), 1.);
      for (const double s : breaks)
        EXPECT_NE(std::find(ends.begin(), ends.end(), s), ends.end());
      for (std::size_t i = 1; i < ends.size(); ++i)
        EXPECT_GT(ends[i], ends[i - 1]);
    }
}

/// Each mesh of a family contains the coarser ones: extrapolation asks for it.
TEST(LayeredMesh, FinerOnesContainTheCoarser)
{
  for (const double layer : {1e-6, 1e-2, 0.5})
    for (const unsigned int parts : {2u, 3u, 64u})
    {
      const auto coarse = layered_cell_ends(25, 1, {0.3}, layer), fine = layered_cell_ends(25, parts, {0.3}, layer);
      ASSERT_EQ(fine.size() - 1, parts * (coarse.size() - 1));
      for (std::size_t i = 0; i < coarse.size(); ++i)
        EXPECT_NEAR(fine[parts * i], coarse[i], 1e-14 * coarse[i]);
    }
}

TEST(LayeredMesh, HalfOfTheCellsAreInTheLayers)
{
  constexpr unsigned int n = 4000;
  for (const double layer : {1e-7, 1e-5})
  {
    const auto ends = layered_cell_ends(n, 1, {}, layer);
    ASSERT_EQ(ends.size(), n + 1);
    for (std::size_t i = 0; i <= n; ++i)
      EXPECT_NEAR(ends[i], 1. - ends[n - i], 1e-13);
    // Without the layers half as many cells would be as long as the one in the middle.
    const double in_the_middle = ends[n / 2 + 1] - ends[n / 2];
    EXPECT_NEAR(in_the_middle * 0.5 * n, 1., 4. / std::log(1. / layer));
    EXPECT_LT(in_the_middle * 0.5 * n, 1.);
    // Near an end the size is proportional to layer + s.
    const auto size_at = [&](const double s) {
      const auto i = std::upper_bound(ends.begin(), ends.end(), s) - ends.begin();
      return ends[i] - ends[i - 1];
    };
    EXPECT_NEAR(size_at(layer) / size_at(0.), 2., 0.03);
    EXPECT_NEAR(size_at(9. * layer) / size_at(0.), 10., 0.3);
    // As many for each factor of the distance.
    const auto cells_between = [&](const double from, const double to) {
      return std::upper_bound(ends.begin(), ends.end(), to) - std::upper_bound(ends.begin(), ends.end(), from);
    };
    EXPECT_NEAR(1. * cells_between(0., 9. * layer) / n, 0.25 * std::log(10.) / std::log(1. / layer), 0.01);
  }
}
