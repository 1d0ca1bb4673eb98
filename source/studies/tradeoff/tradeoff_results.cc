// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/plain_numbers.h>
#include <crawler/base/versions.h>
#include <crawler/studies/tradeoff/tradeoff_results.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    constexpr unsigned int first_exponent = 2, last_exponent = 14;

    /// For each row the largest error of it and of all tighter tolerances on its mesh; infinite if one of them failed.
    std::vector<double>
    safe_errors(const TradeoffResults &results)
    {
      const auto &rows = results.rows;
      std::vector<double> safe(rows.size());
      for (std::size_t i = rows.size(); i-- > 0;)
      {
        // A tighter tolerance for which there was no time says nothing against the looser ones.
        safe[i] = rows[i].is_finished() ? rows[i].shown_error : rows[i].reason == time_limit_reason ? 0. : HUGE_VAL;
        if (i + 1 < rows.size() && same_mesh(rows[i].setting, rows[i + 1].setting))
          safe[i] = std::max(safe[i], safe[i + 1]);
      }
      return safe;
    }

    std::vector<Recommendation>
    recommend(const TradeoffResults &results, const std::vector<double> &safe, const bool batch)
    {
      std::vector<Recommendation> list;
      for (unsigned int exponent = first_exponent; exponent <= last_exponent; ++exponent)
      {
        const double wanted = std::pow(10., -static_cast<double>(exponent));
        std::size_t best    = results.rows.size();
        for (std::size_t i = 0; i < results.rows.size(); ++i)
          if (results.rows[i].is_finished() && results.rows[i].setting.is_batch() == batch &&
              !results.rows[i].breaks_promise() && safe[i] <= wanted &&
              (best == results.rows.size() || results.rows[i].seconds < results.rows[best].seconds))
            best = i;
        if (best == results.rows.size())
          break;
        list.push_back({exponent, best});
      }
      return list;
    }

    /// "1.23 ms"
    std::string
    duration(const double seconds)
    {
      if (std::isnan(seconds))
        return "?";
      return seconds < 1e-3 ? fmt::format("{:.3g} us", 1e6 * seconds)
             : seconds < 1. ? fmt::format("{:.3g} ms", 1e3 * seconds)
                            : fmt::format("{:.3g} s", seconds);
    }

    /// "error 1.2e-05, 0.2 ms, 34 kB"
    std::string
    costs(const TradeoffResults &results, const std::size_t i)
    {
      const TradeoffRow &row  = results.rows[i];
      const std::string error = row.error < row.shown_error
                                  ? fmt::format("error below the bar of {:.1e}", row.shown_error)
                                  : fmt::format("error {:.1e}", row.error);
      return fmt::format("{}, {}{}{}",
                         error,
                         duration(row.seconds),
                         row.setting.is_batch() ? " a body" : "",
                         std::isnan(row.memory) ? "" : fmt::format(", {:.0f} kB", row.memory / 1e3));
    }

    Json
    recommendations_json(const TradeoffResults &results, const std::vector<Recommendation> &list)
    {
      Json array = Json::array();
      for (const auto &[exponent, i] : list)
      {
        const TradeoffRow &row = results.rows[i];
        array.push_back({{"accuracy", std::stod(fmt::format("1e-{}", exponent))},
                         {"index", i},
                         {"setting", in_words(row.setting)},
                         {"error", row.error},
                         {"seconds", row.seconds},
                         {"memory", row.memory},
                         {"prm", row.setting.is_batch() ? Json(nullptr) : Json(results.prm(i))}});
      }
      return array;
    }

    Json
    reference_json(const TradeoffReference &reference)
    {
      if (reference.status != "finished")
        return nullptr;
      const auto answer = [](const TradeoffAnswer &a) {
        return Json{{"method", a.method}, {"displacement", a.displacement}, {"error_bound", a.error_bound}};
      };
      return {{"displacement", reference.answer.displacement},
              {"bar", reference.bar},
              {"relative_bar", reference.relative_bar()},
              {"size", reference.size},
              {"answer", answer(reference.answer)},
              {"check", reference.is_checked() ? answer(reference.check) : Json(nullptr)}};
    }
  } // namespace

  std::size_t
  TradeoffResults::n_tried() const
  {
    return static_cast<std::size_t>(
      std::count_if(rows.begin(), rows.end(), [](const TradeoffRow &row) { return !row.status.empty(); }));
  }

  std::vector<bool>
  pareto_front(const std::vector<double> &costs, const std::vector<double> &errors)
  {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < costs.size(); ++i)
      if (!std::isnan(costs[i]) && !std::isnan(errors[i]))
        order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](const std::size_t i, const std::size_t j) {
      return std::pair(costs[i], errors[i]) < std::pair(costs[j], errors[j]);
    });
    std::vector<bool> front(costs.size(), false);
    double best = HUGE_VAL;
    for (const std::size_t i : order)
      if (errors[i] < best)
      {
        best     = errors[i];
        front[i] = true;
      }
    return front;
  }

  std::string
  TradeoffResults::prm(const std::size_t row) const
  {
    const TradeoffSetting &setting = rows[row].setting;
    const bool other_model         = !setting.has_no_mesh() && parameters.model != Model::nonlinear;
    return (other_model ? "set Model = nonlinear\n" : "") +
           as_prm(with_setting(parameters, setting, reference.size), setting);
  }

  TradeoffResults
  evaluate(const Parameters &parameters, const TradeoffReference &reference, std::vector<TradeoffRow> rows)
  {
    TradeoffResults results = {parameters, reference, std::move(rows), {}, {}};
    for (const bool batch : {false, true})
    {
      std::vector<double> costs, errors;
      for (const TradeoffRow &row : results.rows)
      {
        const bool counts = row.is_finished() && row.setting.is_batch() == batch;
        costs.push_back(counts ? row.seconds : TradeoffRow::unknown);
        errors.push_back(counts ? row.shown_error : TradeoffRow::unknown);
      }
      const auto front = pareto_front(costs, errors);
      for (std::size_t i = 0; i < front.size(); ++i)
        if (results.rows[i].setting.is_batch() == batch && !results.rows[i].status.empty())
          results.rows[i].pareto = front[i] ? "true" : "false";
    }
    const auto safe               = safe_errors(results);
    results.recommendations       = recommend(results, safe, /*batch=*/false);
    results.batch_recommendations = recommend(results, safe, /*batch=*/true);
    return results;
  }

  std::vector<std::string>
  recommendation_lines(const TradeoffResults &results)
  {
    std::vector<std::string> lines;
    // Accuracies with the same setting share a line.
    const auto add = [&](const std::vector<Recommendation> &list, const std::string &words) {
      std::string accuracies;
      for (std::size_t i = 0; i < list.size(); ++i)
      {
        accuracies += fmt::format("{}1e-{}", accuracies.empty() ? "" : " and ", list[i].exponent);
        if (i + 1 == list.size() || list[i + 1].row != list[i].row)
          lines.push_back(fmt::format(fmt::runtime(words), std::exchange(accuracies, "")) +
                          in_words(results.rows[list[i].row].setting) + ": " + costs(results, list[i].row));
      }
    };
    add(results.recommendations, "For {} use ");
    add(results.batch_recommendations, "Many bodies, for {}: ");
    return lines;
  }

  std::string
  recommendations_prm(const TradeoffResults &results)
  {
    std::string text =
      "# The cheapest settings that crawler tradeoff has found for this scene. Copy the block that you want into the\n"
      "# parameter file; errors are relative, costs are processor time of a run without snapshots.\n";
    for (const auto &[exponent, i] : results.recommendations)
      text += fmt::format("\n# For 1e-{}: {}\n{}", exponent, costs(results, i), results.prm(i));
    return text;
  }

  namespace
  {
    std::map<std::string, unsigned long>
    counts(const TradeoffResults &results, std::string TradeoffRow::*member)
    {
      std::map<std::string, unsigned long> counts;
      for (const TradeoffRow &row : results.rows)
        if (!(row.*member).empty())
          ++counts[row.*member];
      return counts;
    }
  } // namespace

  std::string
  in_words(const TradeoffResults &results, const TradeoffCourse &course)
  {
    std::vector<std::string> reasons;
    for (const auto &[reason, n] : counts(results, &TradeoffRow::reason))
      reasons.push_back(fmt::format("{} {}", reason, n));
    auto statuses       = counts(results, &TradeoffRow::status);
    const auto count_of = [&](const auto &is_one) {
      return std::count_if(results.rows.begin(), results.rows.end(), is_one);
    };
    return fmt::format(
      "Tradeoff: {} settings of {} tried; {} finished, {} of them below the bar, {} on the Pareto fronts; gaps: {}. "
      "{:.0f} s on {}.",
      results.n_tried(),
      results.rows.size(),
      statuses["finished"],
      count_of([](const TradeoffRow &row) { return row.below_bar == "true"; }),
      count_of([](const TradeoffRow &row) { return row.pareto == "true"; }),
      reasons.empty() ? "none" : fmt::format("{}", fmt::join(reasons, ", ")),
      course.seconds,
      counted(course.n_ranks, "rank"));
  }

  std::string
  tradeoff_json(const TradeoffResults &results, const TradeoffCourse &course)
  {
    Json front = Json::array();
    for (std::size_t i = 0; i < results.rows.size(); ++i)
      if (results.rows[i].pareto == "true")
        front.push_back(i);
    const Json json = {{"status", course.status},
                       {"reason", course.reason.empty() ? Json(nullptr) : Json(course.reason)},
                       {"message", results.reference.message.empty() ? Json(nullptr) : Json(results.reference.message)},
                       {"reference", reference_json(results.reference)},
                       {"settings", results.rows.size()},
                       {"tried", results.n_tried()},
                       {"statuses", counts(results, &TradeoffRow::status)},
                       {"reasons", counts(results, &TradeoffRow::reason)},
                       {"pareto", front},
                       {"recommendations", recommendations_json(results, results.recommendations)},
                       {"batch_recommendations", recommendations_json(results, results.batch_recommendations)},
                       {"seconds", course.seconds},
                       {"ranks", course.n_ranks},
                       {"versions", versions()},
                       {"command_line", course.command_line}};
    return json.dump(2, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace) + "\n";
  }
} // namespace crawler
