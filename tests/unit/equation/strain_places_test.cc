// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/equation/strain_places.h>
#include <crawler/equation/stretch_history.h>

#include <cmath>

using namespace crawler;

namespace
{
  /// Strain at these points of the displacement 1e3 + s^q, which elements of this degree represent.
  std::vector<double>
  strain_of(const unsigned int degree, const std::vector<double> &points, const double sensor_length)
  {
    const std::vector<Cell> cells   = {{0., 0.5, 0, false}, {0.5, 0.25, 1, true}, {0.75, 1.25, 0, false}}; // L = 2
    const ReferenceElement &element = reference_element(degree);
    std::vector<double> u, result(points.size());
    for (const Cell &cell : cells)
      for (unsigned int i = u.empty() ? 0 : 1; i < element.n; ++i)
        u.push_back(1e3 + std::pow(cell.left + cell.size * element.nodes[i], degree));
    StrainPlaces(cells, element, points, sensor_length).evaluate(u, result);
    return result;
  }

  constexpr double strain_round_off = 1e-11; // of numbers near 1e3 and cells of 0.25
} // namespace

/// Points beyond the body are its ends.
TEST(StrainPlaces, PointsOfPolynomials)
{
  for (const unsigned int degree : {1u, 3u, 8u})
  {
    const auto found  = strain_of(degree, {-0.3, 0.2, 0.5, 1.9, 2.7}, 0.);
    const double at[] = {0., 0.2, 0.5, 1.9, 2.};
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i] / std::pow(2., degree - 1.),
                  degree * std::pow(at[i] / 2., degree - 1.),
                  degree * degree * strain_round_off);
  }
  EXPECT_TRUE(strain_of(2, {}, 0.).empty());
}

/// Sensors that extend beyond the body are moved inside; they may be as long as it is, or tiny.
TEST(StrainPlaces, MeansOfPolynomials)
{
  for (const double length : {2., 0.8, 0.01})
    for (const double middle : {-0.1, 0.2, 0.5, 1.1, 1.95, 3.})
    {
      const double left = std::clamp(middle - length / 2., 0., 2. - length), right = left + length;
      const double mean = (std::pow(right, 3.) - std::pow(left, 3.)) / length;
      EXPECT_NEAR(strain_of(3, {middle}, length).front(), mean, strain_round_off / length)
        << length << " at " << middle;
    }
}

/// Also of a body of one cell, whose degree was taken for one more.
TEST(StretchHistory, IsKeptInACheckpoint)
{
  for (const unsigned int n_cells : {1u, 2u, 7u})
    for (const unsigned int degree : {1u, 6u})
    {
      std::vector<Cell> cells;
      for (unsigned int c = 0; c < n_cells; ++c)
        cells.push_back({1. * c, 1., 0, false});
      StretchHistory::Step step{
        0., 0.5, std::make_shared<const std::vector<Cell>>(cells), &reference_element(degree), {}};
      for (auto &u : step.u)
        u.assign(n_cells * degree + 1, 0.25);
      StretchHistory history, resumed;
      history.add(step, 0.);
      Archive read(archived(history));
      resumed.exchange(read);
      const StretchHistory::Step *found = resumed.find(0.2);
      ASSERT_NE(found, nullptr);
      EXPECT_EQ(found->element, step.element);
      EXPECT_EQ(found->u, step.u);
    }
}
