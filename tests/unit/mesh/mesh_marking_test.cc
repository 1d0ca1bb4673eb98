// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Which cells are divided and joined, and what meshes that gives; also on several ranks.
#include "../../support/ranks.h"
#include "../../support/test.h"

#include <crawler/mesh/mesh_marking.h>

using namespace crawler;

namespace
{
  constexpr auto keep = CellChange::keep, divide = CellChange::divide, join = CellChange::join;
  using Changes = std::vector<CellChange>;
  using Mesh    = std::unique_ptr<Discretization>;

  Mesh
  uniform(const unsigned int n_cells, const double length = 1.)
  {
    return std::make_unique<Discretization>(MPI_COMM_WORLD, length, n_cells, 2);
  }

  unsigned int
  highest_level(const Discretization &mesh)
  {
    unsigned int level = 0;
    for (const Cell &cell : mesh.cells)
      level = std::max(level, cell.level);
    return level;
  }

  /// Cells without gaps, levels of neighbours that fit, and each cell and unknown on one rank.
  void
  expect_sound(const Discretization &mesh, const double length, const unsigned int coarse_cells)
  {
    double end = 0.;
    for (unsigned int c = 0; c < mesh.n_cells(); ++c)
    {
      const Cell &cell = mesh.cells[c];
      EXPECT_NEAR(cell.left, end, 1e-14 * length) << c;
      EXPECT_NEAR(cell.size, std::ldexp(length / coarse_cells, -static_cast<int>(cell.level)), 1e-15 * length);
      if (c > 0)
      {
        EXPECT_LE(std::abs(static_cast<int>(cell.level) - static_cast<int>(mesh.cells[c - 1].level)), 1) << c;
      }
      end = cell.left + cell.size;
    }
    EXPECT_NEAR(end, length, 1e-14 * length);
    EXPECT_EQ(test::over_ranks(mesh.n_local_cells()), mesh.n_cells());
    EXPECT_EQ(test::over_ranks(static_cast<unsigned int>(mesh.n_owned())), mesh.n_unknowns());
    for (unsigned int c = 0; c < mesh.n_local_cells(); ++c)
    {
      EXPECT_EQ(mesh.cell_left[c], mesh.cells[mesh.first_cell + c].left);
      EXPECT_EQ(mesh.cell_size[c], mesh.cells[mesh.first_cell + c].size);
    }
  }

  void
  expect_same_cells(const Discretization &a, const Discretization &b)
  {
    ASSERT_EQ(a.n_cells(), b.n_cells());
    for (unsigned int c = 0; c < a.n_cells(); ++c)
    {
      EXPECT_NEAR(a.cells[c].left, b.cells[c].left, 1e-15);
      EXPECT_EQ(a.cells[c].level, b.cells[c].level);
    }
  }
} // namespace

TEST(MeshMarking, DividesUntilTheRestIsBelowATenth)
{
  const Mesh mesh = uniform(16);
  MeshLimits limits;
  limits.tolerance = 1.;
  for (const double ratio : {0.1, 0.5, 0.8, 0.97})
  {
    std::vector<double> indicators(16);
    for (unsigned int c = 0; c < 16; ++c)
      indicators[c] = 3. * std::pow(ratio, (5 * c) % 16);
    const Changes changes = mark_for_division(indicators, *mesh, limits);
    ASSERT_EQ(changes.size(), 16u);
    double rest = 0.;
    for (unsigned int c = 0; c < 16; ++c)
      if (changes[c] == keep)
        rest += indicators[c];
      else
        EXPECT_EQ(changes[c], divide);
    EXPECT_LE(rest, 0.1 * limits.tolerance) << ratio;
  }
}

/// The worst cells and their neighbours, no others; nothing if the sum is small enough as it is.
TEST(MeshMarking, DividesNoMoreThanThat)
{
  const Mesh mesh = uniform(16);
  MeshLimits limits;
  limits.tolerance = 1.;
  std::vector<double> indicators(16, 0.005);
  EXPECT_TRUE(mark_for_division(indicators, *mesh, limits).empty());
  indicators[0] = 2.;
  indicators[7] = 1.;
  Changes expected(16, keep);
  for (const unsigned int c : {0, 1, 6, 7, 8})
    expected[c] = divide;
  EXPECT_EQ(mark_for_division(indicators, *mesh, limits), expected);
}

TEST(MeshMarking, RespectsTheLimits)
{
  std::vector<double> indicators(16, 0.);
  indicators[5] = 2.;
  MeshLimits limits;
  limits.tolerance  = 1.;
  Mesh mesh         = uniform(16);
  limits.most_cells = 31;
  EXPECT_TRUE(mark_for_division(indicators, *mesh, limits).empty());
  limits.most_cells = 32;
  EXPECT_FALSE(mark_for_division(indicators, *mesh, limits).empty());
  limits.smallest_cell = 0.51 / 16.;
  EXPECT_TRUE(mark_for_division(indicators, *mesh, limits).empty());

  // One place asks for ever smaller cells.
  limits.smallest_cell = 0.9 / 256.;
  limits.most_cells    = 1000;
  for (unsigned int round = 0; round < 10; ++round)
  {
    indicators.assign(mesh->n_cells(), 0.);
    for (unsigned int c = 0; c < mesh->n_cells(); ++c)
      if (mesh->cells[c].left <= 0.3 && 0.3 < mesh->cells[c].left + mesh->cells[c].size)
        indicators[c] = 2.;
    const Changes changes = mark_for_division(indicators, *mesh, limits);
    EXPECT_EQ(changes.empty(), round >= 4) << round;
    if (changes.empty())
      break;
    mesh = mesh->adapted(changes);
    expect_sound(*mesh, 1., 16);
  }
  EXPECT_EQ(highest_level(*mesh), 4u); // 1/256
  EXPECT_LT(mesh->n_cells(), 60u);     // small cells are there only
}

/// A single cell that is divided again and again takes its neighbourhood with it.
TEST(MeshMarking, NeighboursDifferByOneLevel)
{
  for (const unsigned int n_cells : {1u, 3u, 7u})
  {
    constexpr double length = 2.5;
    Mesh mesh               = uniform(n_cells, length);
    for (unsigned int round = 0; round < 6; ++round)
    {
      Changes changes(mesh->n_cells(), keep);
      const auto &cells = mesh->cells;
      const auto worst =
        std::max_element(cells.begin(), cells.end(), [](const Cell &a, const Cell &b) { return a.level < b.level; });
      changes[static_cast<std::size_t>(worst - cells.begin())] = divide;
      mesh                                                     = mesh->adapted(changes);
      expect_sound(*mesh, length, n_cells);
      EXPECT_EQ(highest_level(*mesh), round + 1);
    }
    // Any demands, divisions and joins mixed.
    unsigned int number = 0;
    for (unsigned int round = 0; round < 12; ++round)
    {
      Changes changes(mesh->n_cells());
      for (CellChange &change : changes)
      {
        const double x = std::sin(12.9898 * ++number);
        change         = x > 0.8 ? divide : x > -0.3 ? join : keep;
      }
      const unsigned int level = highest_level(*mesh);
      // What is marked to be divided is divided.
      std::vector<Cell> divided;
      for (unsigned int c = 0; c < mesh->n_cells(); ++c)
        if (changes[c] == divide)
          divided.push_back(mesh->cells[c]);
      mesh = mesh->adapted(changes);
      expect_sound(*mesh, length, n_cells);
      EXPECT_LE(highest_level(*mesh), level + 1);
      for (const Cell &was : divided)
        for (const Cell &cell : mesh->cells)
          if (cell.left + 0.5 * cell.size > was.left && cell.left + 0.5 * cell.size < was.left + was.size)
          {
            EXPECT_EQ(cell.level, was.level + 1);
          }
    }
  }
}

TEST(MeshMarking, JoinsPairsOnly)
{
  MeshLimits limits;
  limits.tolerance  = 1.;
  const Mesh coarse = uniform(6);
  EXPECT_TRUE(mark_for_joining(std::vector<double>(6, 0.), *coarse, limits).empty()); // nothing was divided
  Mesh mesh = uniform(6);
  mesh      = mesh->adapted({divide, keep, divide, divide, keep, divide});
  // Cells: 0 0 | 1 | 2 2 | 3 3 | 4 | 5 5
  const Changes all = {join, join, keep, join, join, join, join, keep, join, join};
  EXPECT_EQ(mark_for_joining(std::vector<double>(10, 0.), *mesh, limits), all);

  // A pair with one large indicator stays.
  std::vector<double> indicators(10, 0.);
  indicators[6] = 1.;
  Changes three = all;
  three[5] = three[6] = keep;
  EXPECT_EQ(mark_for_joining(indicators, *mesh, limits), three);

  // Two pairs of ten cells are not worth a change.
  indicators[0] = 1.;
  EXPECT_TRUE(mark_for_joining(indicators, *mesh, limits).empty());

  // Halves of different cells, and single halves, are not joined.
  mesh = mesh->adapted({keep, join, keep, keep, join, join, keep, keep, join, keep});
  EXPECT_EQ(mesh->n_cells(), 10u);
  mesh = mesh->adapted(all);
  expect_same_cells(*mesh, *coarse);
  expect_sound(*mesh, 1., 6);
}

/// What is joined does not ask at once to be divided again.
TEST(MeshMarking, JoinedCellsAreNotDividedAgain)
{
  MeshLimits limits;
  limits.tolerance = 1.;
  Mesh mesh        = uniform(8);
  mesh             = mesh->adapted(Changes(8, divide));
  for (double indicator = 1e-8; indicator < 1.; indicator *= 2.)
  {
    if (mark_for_joining(std::vector<double>(16, indicator), *mesh, limits).empty())
      continue;
    // A joined cell's indicator, for a smooth stretch: twice one cell's, times 2^(2 q).
    const Mesh coarse = uniform(8);
    EXPECT_TRUE(mark_for_division(std::vector<double>(8, 2. * indicator * 16.), *coarse, limits).empty());
  }
}
