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

    const char *
    yes_no(const bool value)
    {
      return value ? "true" : "false";
    }

    /// Do two rows differ by the time tolerance alone?
    bool
    same_mesh(const TradeoffSetting &a, const TradeoffSetting &b)
    {
      const auto same = [](const double x, const double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
      return a.model == b.model && a.formulation == b.formulation && a.mesh == b.mesh && a.engine == b.engine &&
             a.integrator == b.integrator && a.degree == b.degree && a.cells == b.cells &&
             same(a.mesh_tolerance, b.mesh_tolerance);
    }

    /// For each row the largest error of it and of all tighter tolerances on its mesh; infinite if one of them failed.
    std::vector<double>
    safe_errors(const TradeoffResults &results)
    {
      const auto &rows = results.rows;
      std::vector<double> safe(rows.size());
      for (std::size_t i = rows.size(); i-- > 0;)
      {
        // A tighter tolerance for which there was no time says nothing against the looser ones.
        safe[i] = !std::isnan(results.shown[i]) ? results.shown[i] : rows[i].reason == "time_limit" ? 0. : HUGE_VAL;
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
          if (results.rows[i].status == "finished" && results.rows[i].setting.is_batch() == batch &&
              (batch || !results.rows[i].prm.empty()) && safe[i] <= wanted &&
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
      const std::string error = results.errors[i] < results.shown[i]
                                  ? fmt::format("error below the bar of {:.1e}", results.shown[i])
                                  : fmt::format("error {:.1e}", results.errors[i]);
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
                         {"index", row.index},
                         {"setting", in_words(row.setting)},
                         {"error", results.errors[i]},
                         {"seconds", row.seconds},
                         {"memory", row.memory},
                         {"prm", row.prm.empty() ? Json(nullptr) : Json(row.prm)}});
      }
      return array;
    }

    Json
    reference_json(const TradeoffReference &reference)
    {
      const auto refined = [](const RefinedDisplacement &d) {
        return d.method.empty()
                 ? Json(nullptr)
                 : Json{{"method", d.method}, {"displacement", d.displacement}, {"last_change", d.change}};
      };
      return {{"displacement", reference.displacement()},
              {"bar", reference.bar},
              {"relative_bar", reference.relative_bar()},
              {"size", reference.size},
              {"first", refined(reference.first)},
              {"second", refined(reference.second)}};
    }
  } // namespace

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

  TradeoffResults
  evaluate(const TradeoffReference &reference, std::vector<TradeoffRow> rows)
  {
    TradeoffResults results;
    results.reference = reference;
    std::sort(rows.begin(), rows.end(), [](const TradeoffRow &a, const TradeoffRow &b) { return a.index < b.index; });
    results.rows = std::move(rows);
    std::vector<double> single, batch;
    for (const TradeoffRow &row : results.rows)
    {
      const double error = std::abs(row.displacement - reference.displacement()) / reference.size;
      results.errors.push_back(error);
      results.shown.push_back(std::isnan(error) ? error : std::max(error, reference.relative_bar()));
      const bool is_batch = row.setting.is_batch();
      single.push_back(is_batch ? TradeoffRow::unknown : row.seconds);
      batch.push_back(is_batch ? row.seconds : TradeoffRow::unknown);
    }
    const auto single_front = pareto_front(single, results.shown), batch_front = pareto_front(batch, results.shown);
    for (std::size_t i = 0; i < results.rows.size(); ++i)
      results.on_front.push_back(single_front[i] || batch_front[i]);
    const auto safe               = safe_errors(results);
    results.recommendations       = recommend(results, safe, /*batch=*/false);
    results.batch_recommendations = recommend(results, safe, /*batch=*/true);
    return results;
  }

  Table
  tradeoff_table(const TradeoffResults &results)
  {
    Table table;
    const auto add =
      [&](const std::string &name, const std::string &unit, const std::string &description, const auto &value) {
        std::vector<std::decay_t<decltype(value(std::size_t()))>> values;
        for (std::size_t i = 0; i < results.rows.size(); ++i)
          values.push_back(value(i));
        table.push_back({name, unit, description, std::move(values)});
      };
    const auto add_errors = [&]() {
      add("error",
          "1",
          "distance of the displacement to the reference, over the size of the displacement",
          [&](const std::size_t i) { return results.errors[i]; });
      add("shown error", "1", "the same, but no smaller than the reference's bar", [&](const std::size_t i) {
        return results.shown[i];
      });
      add("below bar",
          "",
          "true if the error cannot be told from 0: it is below the reference's bar",
          [&](const std::size_t i) { return std::string(yes_no(results.errors[i] < results.shown[i])); });
      add("pareto",
          "",
          "true if no other single run (for a batch: no other batch) is as cheap and as accurate, and better in one",
          [&](const std::size_t i) { return std::string(yes_no(results.on_front[i])); });
    };
    add("index", "1", "number of the setting", [&](const std::size_t i) {
      return static_cast<double>(results.rows[i].index);
    });
    for (const TradeoffColumn &column : tradeoff_columns())
    {
      const auto add_column = [&](const auto &kind) {
        add(column.name, column.unit, column.description, [&](const std::size_t i) {
          return std::get<std::decay_t<decltype(kind)>>(column.value_in(results.rows[i]));
        });
      };
      std::visit(add_column, column.value_in(TradeoffRow()));
      if (column.name == "displacement")
        add_errors();
    }
    return table;
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
      text += fmt::format("\n# For 1e-{}: {}\n{}", exponent, costs(results, i), results.rows[i].prm);
    return text;
  }

  std::pair<double, double>
  Calibration::range() const
  {
    double least = TradeoffRow::unknown, most = least;
    for (const auto *list : {&at_start, &at_end})
      for (const double seconds : *list)
      {
        least = std::fmin(least, seconds);
        most  = std::fmax(most, seconds);
      }
    return {least, most};
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
    const auto [shortest, longest] = course.calibration.range();
    auto statuses                  = counts(results, &TradeoffRow::status);
    const auto on_front            = std::count(results.on_front.begin(), results.on_front.end(), true);
    const auto below_bar = std::count_if(results.errors.begin(), results.errors.end(), [&](const double error) {
      return error < results.reference.relative_bar();
    });
    return fmt::format("Tradeoff: {} settings tried of {}{}; {} finished, {} of them below the bar, {} on the Pareto "
                       "fronts; gaps: {}. The same short run took {} to {}, over ranks and time. {:.0f} s on {}.",
                       results.rows.size(),
                       course.n_settings,
                       course.status == "finished" && results.rows.size() < course.n_settings
                         ? " (the others cannot be better than those on their mesh)"
                         : "",
                       statuses["finished"],
                       below_bar,
                       on_front,
                       reasons.empty() ? "none" : fmt::format("{}", fmt::join(reasons, ", ")),
                       duration(shortest),
                       duration(longest),
                       course.seconds,
                       counted(course.n_ranks, "rank"));
  }

  std::string
  tradeoff_json(const TradeoffResults &results, const TradeoffCourse &course)
  {
    Json front = Json::array();
    for (std::size_t i = 0; i < results.rows.size(); ++i)
      if (results.on_front[i])
        front.push_back(results.rows[i].index);
    const Json json = {
      {"status", course.status},
      {"reason", course.reason.empty() ? Json(nullptr) : Json(course.reason)},
      {"reference", reference_json(results.reference)},
      {"settings", course.n_settings},
      {"tried", results.rows.size()},
      {"statuses", counts(results, &TradeoffRow::status)},
      {"reasons", counts(results, &TradeoffRow::reason)},
      {"pareto", front},
      {"recommendations", recommendations_json(results, results.recommendations)},
      {"batch_recommendations", recommendations_json(results, results.batch_recommendations)},
      {"calibration_seconds", {{"at_start", course.calibration.at_start}, {"at_end", course.calibration.at_end}}},
      {"seconds", course.seconds},
      {"ranks", course.n_ranks},
      {"versions", versions()},
      {"command_line", course.command_line}};
    return json.dump(2, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace) + "\n";
  }
} // namespace crawler
