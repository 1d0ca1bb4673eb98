// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/stress.h"
#include "../../support/temporary_folder.h"
#include "../../support/test.h"

#include <crawler/output/active_stress_table.h>
#include <crawler/scene/active_stress/segments.h>

using namespace crawler;

// Between two rows of the table lines give the signal of each segment back, jumps included.
TEST(SegmentTable, HasTheSignalsAndWhenTheySwitch)
{
  for (const std::optional<double> &rate_limit : {std::optional<double>(), std::optional<double>(1.5)})
  {
    const Segments stress({.number = 3, .amplitude = {0.3, -0.2, 0.1}, .rate_limit = rate_limit}, 1., 2.);
    const test::TemporaryFolder folder;
    write_segment_tables(folder.path, stress, 2., 10, {"mm", "s", "mN"});
    std::ifstream file(folder.path / "segments.csv");
    std::string line;
    std::getline(file, line);
    EXPECT_EQ(line, "t [s],segment 1 [mN],segment 2 [mN],segment 3 [mN]");
    std::vector<std::array<double, 4>> rows;
    while (std::getline(file, line))
    {
      auto &row = rows.emplace_back();
      ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &row[0], &row[1], &row[2], &row[3]), 4) << line;
    }
    ASSERT_GT(rows.size(), 10u);
    EXPECT_EQ(rows.front()[0], 0.);
    EXPECT_EQ(rows.back()[0], 2.);
    const auto places = stress.middles();
    for (std::size_t j = 1; j < rows.size(); ++j)
      if (rows[j][0] > rows[j - 1][0])
        for (const double part : {0.01, 0.5, 0.99})
          for (std::size_t i = 0; i < 3; ++i)
          {
            const double t = std::lerp(rows[j - 1][0], rows[j][0], part);
            EXPECT_NEAR(
              std::lerp(rows[j - 1][i + 1], rows[j][i + 1], part), test::values(stress, {places[i]}, t)[0], 1e-7)
              << t;
          }
    std::ifstream switching(folder.path / "segment_switching.csv");
    std::getline(switching, line);
    EXPECT_EQ(line, "t [s],segment,on");
    EXPECT_EQ(std::count(std::istreambuf_iterator<char>(switching), {}, '\n'),
              static_cast<std::ptrdiff_t>(stress.switching_times(2.).size()));
  }
  EXPECT_TRUE(test::complaint({{"Output/Segment table", "10"}}).starts_with("Output/Segment table: "))
    << "a wave has no segments";
}
