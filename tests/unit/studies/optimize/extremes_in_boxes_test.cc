// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../../support/test.h"

#include <crawler/studies/optimize/extremes_in_boxes.h>

using namespace crawler;

namespace
{
  constexpr double two_pi = 2. * std::numbers::pi;

  std::vector<double>
  seen(const ExtremesInBoxes &boxes, const auto &stretch)
  {
    std::vector<double> values;
    for (const double t : boxes.times)
      for (const double s : boxes.points)
        values.push_back(stretch(s, t));
    return values;
  }
} // namespace

/// The crest of a wave has the same height in all boxes that it crosses, and the largest of all is the largest.
TEST(ExtremesInBoxes, OfATravellingWave)
{
  const ExtremesInBoxes boxes(8, 1.);
  const auto wave = [](const double s, const double t) { return 1. + 0.2 * std::sin(two_pi * (s + t + 0.0137)); };
  const std::vector<StretchPlace> extremes = boxes.find(seen(boxes, wave));
  ASSERT_EQ(extremes.size(), 2u * 8 * 8);
  unsigned int n_crests = 0;
  for (std::size_t e = 0; e < extremes.size(); ++e)
  {
    const StretchPlace &own = extremes[e];
    EXPECT_NEAR(own.value, wave(own.s, own.t), 2e-5) << e;
    EXPECT_NEAR(own.s * 8., static_cast<double>(e / 2 % 8) + 0.5, 0.65) << e;
    EXPECT_NEAR(own.t * 8., std::floor(static_cast<double>(e) / 16.) + 0.5, 0.65) << e;
    if (e % 2 == 1 && own.value > 1.2 - 2e-5)
      ++n_crests;
  }
  EXPECT_GE(n_crests, 15u);
}

/// A standing wave has its extremes between the places where it is looked at.
TEST(ExtremesInBoxes, BetweenPointsAndTimes)
{
  const ExtremesInBoxes boxes(8, 1.);
  const auto wave = [](const double s, const double t) {
    return 1. + 0.2 * std::sin(two_pi * (s - 0.053)) * std::sin(two_pi * (t - 0.071));
  };
  double smallest = 1., largest = 1.;
  for (const StretchPlace &one : boxes.find(seen(boxes, wave)))
  {
    smallest = std::min(smallest, one.value);
    largest  = std::max(largest, one.value);
  }
  EXPECT_NEAR(smallest, 0.8, 1e-6);
  EXPECT_NEAR(largest, 1.2, 1e-6);
}

/// The stretch jumps where segments meet, on a point of the grid and between points: nothing is beyond its sides.
TEST(ExtremesInBoxes, OfSegments)
{
  const std::vector<double> edges = {0.25, 0.61};
  const ExtremesInBoxes boxes(8, 1., {edges, {0.4}});
  const auto stretch = [&](const double s, const double t) {
    return (s < edges[0] ? 0.9 + 0.1 * s : s < edges[1] ? 1.2 - 0.1 * s : 0.8 + 0.05 * s) + (t < 0.4 ? 0.01 * t : 0.02);
  };
  double smallest = 2., largest = 0.;
  for (const StretchPlace &one : boxes.find(seen(boxes, stretch)))
  {
    EXPECT_NEAR(one.value, stretch(one.s, one.t), 1e-12) << one.s << ", " << one.t;
    smallest = std::min(smallest, one.value);
    largest  = std::max(largest, one.value);
  }
  EXPECT_NEAR(smallest, 0.8 + 0.05 * edges[1], 1e-9);
  EXPECT_NEAR(largest, 1.2 - 0.1 * edges[0] + 0.02, 1e-9);
}

/// Runs of many strides have no more boxes than those of four, and are looked at as often in each stride.
TEST(ExtremesInBoxes, OfManyStrides)
{
  EXPECT_EQ(ExtremesInBoxes::boxes_in_time(0.3), 8u);
  EXPECT_EQ(ExtremesInBoxes::boxes_in_time(4.), ExtremesInBoxes::boxes_in_time(15.));
  EXPECT_GE(ExtremesInBoxes(32, 15.).times.size(), 15u * 120);
  EXPECT_LE(ExtremesInBoxes(32, 1e6).times.size(), 2600u);
}

TEST(ExtremesInBoxes, WhereOnlyThoseOfTheRunAreKnown)
{
  const ExtremesInBoxes boxes(8, 1.);
  unsigned int n_strained = 0;
  for (const StretchPlace &one : boxes.place({0.3, 1., 0.7}, {1., 0.2, 1.3}))
    n_strained += one.value != 1.;
  EXPECT_EQ(n_strained, 2u);
}
