// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../../support/test.h"

#include <crawler/studies/sweep/sweep_blocks.h>

namespace
{
  using namespace crawler;

  TEST(SweepBlocks, HaveEachPointOnceAndStayWithinTheirAxes)
  {
    for (const auto &[p, chi] : {std::pair(1, 1), {1, 1000}, {7, 13}, {300, 65}, {20, 1000}})
    {
      SweepParameters parameters;
      parameters.axes =
        "A/p : linspace(1, 2, " + std::to_string(p) + "); A/chi : linspace(0, 1, " + std::to_string(chi) + ")";
      const SweepDesign design(parameters);
      unsigned long next = 0;
      for (const SweepBlock &block : sweep_blocks(design))
      {
        ASSERT_EQ(block.first, next);
        ASSERT_TRUE(block.size >= 1 && block.size <= largest_block);
        if (static_cast<unsigned long>(chi) > largest_block / 2)
        {
          ASSERT_EQ(block.first / chi, (block.first + block.size - 1) / chi);
        }
        else if (chi > 1)
        {
          ASSERT_EQ(block.size % chi, 0u) << "whole rows";
        }
        next += block.size;
      }
      EXPECT_EQ(next, design.n_points());
    }
  }

  TEST(SweepBlocks, KeepRowsApartThatAreNotSimilar)
  {
    for (const std::string axis : {"Accuracy : 1e-3, 1e-6", "Time/End time : 1, 2", "Active stress/Generator : a, b"})
    {
      SweepParameters parameters;
      parameters.axes = axis + "; A/chi : linspace(0, 1, 10)";
      const SweepDesign design(parameters);
      EXPECT_EQ(sweep_blocks(design).size(), 2u) << axis;
    }
  }

  TEST(SweepOrder, VisitsEachBlockOnceAndLongOnesFirst)
  {
    for (const bool differ : {false, true})
    {
      const std::string axes = differ ? "Time/End time : 1, 5, 2; " : "";
      SweepPoints points(MPI_COMM_SELF,
                         ParameterFile::from_text("subsection Sweep\n set Axes = " + axes +
                                                    "Body/Anchoring exponent : linspace(1.5, 4, 500)\nend\n",
                                                  "test.prm"));
      const auto blocks = sweep_blocks(points.design());
      std::set<unsigned long> seen;
      double last = 1e300;
      for (const SweepBlock &block : sweep_blocks_in_order(points))
      {
        seen.insert(block.first);
        if (!differ)
          continue;
        const double expected = points.parameters(block.first).time.end_time * static_cast<double>(block.size);
        EXPECT_LE(expected, last);
        last = expected;
      }
      EXPECT_EQ(seen.size(), blocks.size());
      EXPECT_EQ(*seen.rbegin(), blocks.back().first);
    }
  }
} // namespace
