// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/output/usual_size.h>

using namespace crawler;

namespace
{
  constexpr int n_places = 50;
  constexpr double tenth = 1.1;

  /// Rows of sin(x + t), @p rows_a_unit of them from @p begin to @p end.
  void
  add_wave(UsualSize &size, const double begin, const double end, const int rows_a_unit)
  {
    for (int j = 0; j <= (end - begin) * rows_a_unit; ++j)
    {
      const double t = begin + static_cast<double>(j) / rows_a_unit;
      std::vector<double> row;
      for (int i = 0; i < n_places; ++i)
        row.push_back(std::sin(2. * std::numbers::pi * (static_cast<double>(i) / n_places + t)));
      size.add(t, row);
    }
  }
} // namespace

// A wave fills the scale.
TEST(UsualSize, IsTheLargestOfAWave)
{
  UsualSize size;
  add_wave(size, 0., 2., 64);
  EXPECT_LE(size.value(), 1.);
  EXPECT_GE(size.value(), 1. / tenth);
}

// The instant counts for how long it lasts, not for how many rows show it.
TEST(UsualSize, LeavesOutAnInstantHoweverManyRowsItHas)
{
  UsualSize size;
  for (int j = 0; j <= 1000; ++j)
    size.add(1e-5 * j, std::vector<double>(n_places, 500.));
  add_wave(size, 0.01, 2., 64);
  EXPECT_LE(size.value(), tenth);
  EXPECT_GE(size.value(), 1. / tenth);
  const auto [low, high] = size.within({-500., 0.25});
  EXPECT_EQ(low, -size.value());
  EXPECT_EQ(high, 0.25);
}

// A narrow part of the body that grips is no wider for that.
TEST(UsualSize, LeavesOutASmallPartOfTheBody)
{
  UsualSize size;
  for (int j = 0; j <= 100; ++j)
  {
    std::vector<double> row(200, 1.);
    row[j] = row[j + 1] = row[j + 2] = 100.;
    size.add(j, row);
  }
  EXPECT_LE(size.value(), tenth);
  EXPECT_GE(size.value(), 1.);
}

// What is large for longer belongs to the gait.
TEST(UsualSize, KeepsWhatLasts)
{
  UsualSize size;
  for (int j = 0; j <= 100; ++j)
    size.add(j, std::vector<double>(n_places, j % 20 == 0 ? 100. : 1.));
  EXPECT_EQ(size.value(), 100.);
}

// A first picture has nothing to compare with, and a body at rest has no size.
TEST(UsualSize, OfOneRowIsItsLargest)
{
  UsualSize size;
  EXPECT_EQ(size.value(), 0.);
  size.add(0., std::vector<double>{0., -3., 2., NAN});
  EXPECT_EQ(size.value(), 3.);
  UsualSize rest;
  rest.add(0., std::vector<double>(n_places, 0.));
  rest.add(1., std::vector<double>(n_places, 0.));
  EXPECT_EQ(rest.value(), 0.);
}
