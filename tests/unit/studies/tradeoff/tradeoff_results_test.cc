// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/tradeoff/tradeoff_results.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

using namespace crawler;

namespace
{
  const double not_known = std::numeric_limits<double>::quiet_NaN();

  /// The reference is 1.
  TradeoffReference
  reference(const double bar)
  {
    TradeoffReference reference;
    reference.answer = {"a method", 1., bar};
    reference.bar    = bar;
    reference.size   = 1.;
    return reference;
  }

  /// A row of a single run whose displacement is off by @p error.
  TradeoffRow
  row(const unsigned int cells, const double error, const double seconds)
  {
    TradeoffRow row;
    row.setting.engine    = "fused";
    row.setting.degree    = 4;
    row.setting.cells     = cells;
    row.setting.tolerance = 0.1;
    row.status            = "finished";
    row.displacement      = 1. + error;
    row.seconds           = seconds;
    return row;
  }

  TradeoffResults
  results_of(const double bar, std::vector<TradeoffRow> rows)
  {
    static const Parameters parameters;
    for (TradeoffRow &row : rows)
      row.compare(reference(bar));
    return evaluate(parameters, reference(bar), std::move(rows));
  }

  std::vector<bool>
  front_of(const TradeoffResults &results)
  {
    std::vector<bool> front;
    for (const TradeoffRow &row : results.rows)
      front.push_back(row.pareto == "true");
    return front;
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
  const auto results = results_of(1e-6, {row(4, 1e-3, 1.), row(8, 1e-9, 2.), row(16, 1e-8, 3.)});
  EXPECT_NEAR(results.rows[1].error, 1e-9, 1e-15);
  EXPECT_EQ(results.rows[1].shown_error, 1e-6);
  EXPECT_EQ(results.rows[1].below_bar, "true");
  EXPECT_EQ(front_of(results), (std::vector<bool>{true, true, false})); // the last one cannot be told from the middle
  ASSERT_FALSE(results.recommendations.empty());
  EXPECT_EQ(results.recommendations.back().exponent, 6); // nothing is said about 1e-7
}

TEST(Tradeoff, RecommendsTheCheapestThatIsSafe)
{
  // On 4 cells the error is small by luck: with a tighter tolerance it is that of the mesh, 5e-3.
  const auto results = results_of(1e-12, {row(4, 1e-7, 1.), row(4, 5e-3, 2.), row(8, 9e-5, 3.), row(8, 9e-6, 4.)});
  ASSERT_EQ(results.recommendations.size(), 4);
  const std::vector<std::size_t> rows = {0, 2, 2, 3}; // for 1e-2, 1e-3, 1e-4, 1e-5
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    EXPECT_EQ(results.recommendations[i].exponent, i + 2);
    EXPECT_EQ(results.recommendations[i].row, rows[i]);
  }
}

/// A level that says that its error may be larger is not recommended, nor a mesh whose tighter tolerances are not
/// tried.
TEST(Tradeoff, RecommendsNothingThatIsInDoubt)
{
  TradeoffRow level = row(0, 1e-9, 0.1), not_tried = row(8, 0., not_known);
  level.setting       = {};
  level.setting.model = "kinematic";
  level.message       = "the error may be larger";
  not_tried.status.clear();
  const auto results = results_of(1e-12, {level, row(8, 1e-3, 1.), not_tried});
  EXPECT_TRUE(results.recommendations.empty());
  EXPECT_EQ(results.n_tried(), 2);
}

TEST(Tradeoff, BatchesHaveAFrontOfTheirOwn)
{
  auto batch           = row(4, 1e-3, 0.1);
  batch.setting.engine = "batch";
  auto gap             = row(16, 0., not_known);
  gap.status           = "failed";
  gap.displacement     = not_known;
  const auto results   = results_of(1e-12, {row(4, 1e-3, 1.), batch, gap});
  EXPECT_EQ(front_of(results), (std::vector<bool>{true, true, false}));
  EXPECT_EQ(results.recommendations.size(), 2);
  EXPECT_EQ(results.batch_recommendations.size(), 2);
  EXPECT_EQ(results.batch_recommendations[0].row, 1);
}

/// What is read is what was written, also numbers that are not known, quotes and line breaks.
TEST(TradeoffTable, KeepsAllThatIsInARow)
{
  const auto folder = std::filesystem::temp_directory_path() / "crawler_tradeoff_table_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  TradeoffRow first = row(4, 0.1 + 1e-17, 1. / 3.), second = row(8, not_known, not_known);
  second.not_computed("failed", "exception", "with \"quotes\"\nand two lines");
  const std::vector<TradeoffSetting> settings = {first.setting, second.setting, row(16, 0., 0.).setting};
  create_tradeoff_table(folder, settings, {});
  {
    const PointTable table = tradeoff_table();
    RowFile file(MPI_COMM_SELF, folder / table.file, table.group, table.written_columns());
    file.write(0, {{written_row(first)}});
    file.write(1, {{written_row(second)}});
  }
  const auto rows = read_rows(folder, settings);
  ASSERT_EQ(rows.size(), 3);
  EXPECT_EQ(rows[0].seconds, 1. / 3.);
  EXPECT_EQ(rows[0].displacement, first.displacement);
  EXPECT_TRUE(std::isnan(rows[1].displacement));
  EXPECT_EQ(rows[1].message, second.message);
  EXPECT_TRUE(rows[2].status.empty()); // not tried
  std::filesystem::remove_all(folder);
}

TEST(TradeoffReference, AsATextAndBack)
{
  TradeoffReference reference  = ::reference(1. / 3.);
  reference.check              = {"another", 1. + 1e-15, 1e-9};
  const TradeoffReference read = unpack_reference(pack(reference));
  EXPECT_EQ(read.bar, reference.bar);
  EXPECT_EQ(read.check.method, "another");
  EXPECT_EQ(read.check.displacement, reference.check.displacement);
  EXPECT_TRUE(read.is_checked());
}
