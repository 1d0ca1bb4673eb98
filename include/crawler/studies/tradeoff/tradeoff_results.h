// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/tradeoff/tradeoff_table.h>

#include <string>
#include <vector>

namespace crawler
{
  /**
   * Which of the points (cost, error) no other one beats: none is as cheap and as good and better in one of the two. Of
   * equal points the first counts. Points that are not numbers are never on the front.
   */
  std::vector<bool>
  pareto_front(const std::vector<double> &costs, const std::vector<double> &errors);

  /// Use this row for errors of 10^-exponent.
  struct Recommendation
  {
    unsigned int exponent;
    std::size_t row; ///< place in TradeoffResults::rows
  };

  /// All rows with what they mean together.
  struct TradeoffResults
  {
    const Parameters &parameters;
    TradeoffReference reference;
    std::vector<TradeoffRow> rows; ///< all settings
    std::vector<Recommendation> recommendations, batch_recommendations;

    std::size_t
    n_tried() const;

    /// The entries with which `crawler run` gives this row.
    std::string
    prm(std::size_t row) const;
  };

  /**
   * The fronts, and the cheapest setting for 1e-2, 1e-3, ... as far as the bar allows: of those whose error, and
   * that of all tighter tolerances that were tried on their mesh, is below. So a lucky error is not recommended, nor is
   * a level whose own estimate of the error is larger than it promises.
   */
  TradeoffResults
  evaluate(const Parameters &parameters, const TradeoffReference &reference, std::vector<TradeoffRow> rows);

  /// "For 1e-4 use ...", a line for each recommendation.
  std::vector<std::string>
  recommendation_lines(const TradeoffResults &results);

  /// Blocks for a parameter file, each with a comment that says what it costs.
  std::string
  recommendations_prm(const TradeoffResults &results);

  /// How the study went, besides its results.
  struct TradeoffCourse
  {
    std::string status, reason; ///< finished, or stopped by signal or time_limit
    double seconds       = 0.;
    unsigned int n_ranks = 1;
    std::string command_line;
  };

  /// The study as a paragraph.
  std::string
  in_words(const TradeoffResults &results, const TradeoffCourse &course);

  /// The text of summary.json.
  std::string
  tradeoff_json(const TradeoffResults &results, const TradeoffCourse &course);
} // namespace crawler
