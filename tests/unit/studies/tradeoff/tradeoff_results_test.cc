// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/tradeoff/tradeoff_results.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

using namespace crawler;

namespace
{
  const double not_known = std::numeric_limits<double>::quiet_NaN();

  /// A row of a single run whose displacement is off by @p error; the reference is 1.
  TradeoffRow
  row(const unsigned long index, const unsigned int cells, const double error, const double seconds)
  {
    TradeoffRow row;
    row.index             = index;
    row.setting.engine    = "fused";
    row.setting.degree    = 4;
    row.setting.cells     = cells;
    row.prm               = "set Degree = 4\n";
    row.status            = "finished";
    row.displacement      = 1. + error;
    row.seconds           = seconds;
    row.setting.tolerance = 0.1;
    return row;
  }

  TradeoffReference
  reference(const double bar)
  {
    TradeoffReference reference;
    reference.first = {"a method", 1., bar};
    reference.bar   = bar;
    reference.size  = 1.;
    return reference;
  }
} // namespace

TEST(ParetoFront, IsWhatNoOtherPointBeats)
{
  EXPECT_EQ(pareto_front({1., 2., 3., 2.5}, {3., 2., 1., 2.5}), (std::vector<bool>{true, true, true, false}));
  // Of two that are as good the cheaper one, of two that are as cheap the better one, of equal ones the first.
  EXPECT_EQ(pareto_front({2., 1.}, {1., 1.}), (std::vector<bool>{false, true}));
  EXPECT_EQ(pareto_front({1., 1.}, {2., 1.}), (std::vector<bool>{false, true}));
  EXPECT_EQ(pareto_front({1., 1.}, {1., 1.}), (std::vector<bool>{true, false}));
  EXPECT_EQ(pareto_front({not_known, 1., 0.5}, {0., not_known, 1.}), (std::vector<bool>{false, false, true}));
  EXPECT_TRUE(pareto_front({}, {}).empty());
}

TEST(ParetoFront, OfRandomPointsIsThatOfTheDefinition)
{
  std::mt19937 random(1);
  std::uniform_int_distribution<int> number(0, 40); // with ties
  std::vector<double> costs(300), errors(300);
  for (std::size_t i = 0; i < costs.size(); ++i)
  {
    costs[i]  = number(random);
    errors[i] = number(random);
  }
  const auto front = pareto_front(costs, errors);
  for (std::size_t i = 0; i < costs.size(); ++i)
  {
    bool beaten = false;
    for (std::size_t j = 0; j < costs.size(); ++j)
      beaten = beaten || (costs[j] <= costs[i] && errors[j] <= errors[i] &&
                          (costs[j] < costs[i] || errors[j] < errors[i] || j < i));
    EXPECT_EQ(front[i], !beaten) << i;
  }
}

TEST(Tradeoff, ErrorsBelowTheBarCountAsTheBar)
{
  const auto results = evaluate(reference(1e-6), {row(1, 8, 1e-9, 2.), row(0, 4, 1e-3, 1.), row(2, 16, 1e-8, 3.)});
  EXPECT_EQ(results.rows[0].index, 0);
  EXPECT_NEAR(results.errors[1], 1e-9, 1e-15);
  EXPECT_EQ(results.shown[1], 1e-6);
  EXPECT_EQ(results.on_front, (std::vector<bool>{true, true, false})); // the last one cannot be told from the middle
  ASSERT_FALSE(results.recommendations.empty());
  EXPECT_EQ(results.recommendations.back().exponent, 6); // nothing is said about 1e-7
}

TEST(Tradeoff, RecommendsTheCheapestThatIsSafe)
{
  // On 4 cells the error is small by luck: with a tighter tolerance it is that of the mesh, 5e-3.
  const auto results =
    evaluate(reference(1e-12), {row(0, 4, 1e-7, 1.), row(1, 4, 5e-3, 2.), row(2, 8, 9e-5, 3.), row(3, 8, 9e-6, 4.)});
  ASSERT_EQ(results.recommendations.size(), 4);
  const std::vector<std::size_t> rows = {0, 2, 2, 3}; // for 1e-2, 1e-3, 1e-4, 1e-5
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    EXPECT_EQ(results.recommendations[i].exponent, i + 2);
    EXPECT_EQ(results.recommendations[i].row, rows[i]);
  }
}

TEST(Tradeoff, BatchesHaveAFrontOfTheirOwn)
{
  auto batch           = row(1, 4, 1e-3, 0.1);
  batch.setting.engine = "batch";
  auto gap             = row(2, 16, 0., not_known);
  gap.status           = "failed";
  gap.displacement     = not_known;
  const auto results   = evaluate(reference(1e-12), {row(0, 4, 1e-3, 1.), batch, gap});
  EXPECT_EQ(results.on_front, (std::vector<bool>{true, true, false}));
  EXPECT_EQ(results.recommendations.size(), 2);
  EXPECT_EQ(results.batch_recommendations.size(), 2);
  EXPECT_EQ(results.batch_recommendations[0].row, 1);
}

TEST(TradeoffRows, ALineThatWasCutOffIsNoRow)
{
  const auto folder = std::filesystem::temp_directory_path() / "crawler_tradeoff_rows_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "rows");
  TradeoffRow first = row(7, 4, 0.1 + 1e-17, 1. / 3.), second = row(8, 4, not_known, not_known);
  second.status  = "failed";
  second.message = "with \"quotes\"\nand two lines";
  for (const unsigned int rank : {0u, 1u})
    TradeoffRowWriter(folder, rank).write(rank == 0 ? first : second);
  {
    std::string line = pack({{9, row(9, 4, 0., 1.)}});
    line.pop_back(); // its end
    std::ofstream(folder / "rows" / "1.jsonl", std::ios::app) << line.substr(0, line.size() / 2);
    std::ofstream(folder / "rows" / "2.jsonl") << line; // whole, but who knows: its end is missing
  }
  for (int i = 0; i < 2; ++i) // what was recovered is there the next time, too
  {
    const auto rows = recover_rows(folder);
    ASSERT_EQ(rows.size(), 2);
    EXPECT_EQ(pack({{7, rows.at(7)}}), pack({{7, first}}));
    EXPECT_EQ(rows.at(7).seconds, 1. / 3.);
    EXPECT_TRUE(std::isnan(rows.at(8).displacement));
    EXPECT_EQ(rows.at(8).message, second.message);
  }
  std::filesystem::remove_all(folder);
}
