// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/versions.h>
#include <crawler/studies/tradeoff/tradeoff_results.h>

#include <fmt/format.h>
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

    /// 0 stands for what has no meaning.
    double
    count(const unsigned int n)
    {
      return n > 0 ? n : TradeoffRow::unknown;
    }

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
    const auto &rows = results.rows;
    Table table;
    const auto add =
      [&](const std::string &name, const std::string &unit, const std::string &description, const auto &value) {
        std::vector<std::decay_t<decltype(value(std::size_t()))>> values;
        for (std::size_t i = 0; i < rows.size(); ++i)
          values.push_back(value(i));
        table.push_back({name, unit, description, std::move(values)});
      };
    const auto add_text =
      [&](const std::string &name, const std::string &description, std::string TradeoffRow::*member) {
        add(name, "", description, [&, member](const std::size_t i) { return rows[i].*member; });
      };
    const auto add_word =
      [&](const std::string &name, const std::string &description, std::string TradeoffSetting::*member) {
        add(name, "", description, [&, member](const std::size_t i) { return rows[i].setting.*member; });
      };
    const auto add_number = [&](const std::string &name,
                                const std::string &unit,
                                const std::string &description,
                                double TradeoffRow::*member) {
      add(name, unit, description, [&, member](const std::size_t i) { return rows[i].*member; });
    };
    add("index", "1", "number of the setting", [&](const std::size_t i) { return static_cast<double>(rows[i].index); });
    add_word("model", "level of the model", &TradeoffSetting::model);
    add_word("formulation", "position or stretch", &TradeoffSetting::formulation);
    add_word("mesh", "uniform or adaptive", &TradeoffSetting::mesh);
    add_word("engine", "fused, petsc, or batch: 8 bodies side by side by the fused engine", &TradeoffSetting::engine);
    add_word("integrator", "time integrator", &TradeoffSetting::integrator);
    add("degree", "1", "polynomial degree", [&](const std::size_t i) { return count(rows[i].setting.degree); });
    add("cells", "1", "cells of a uniform mesh", [&](const std::size_t i) { return count(rows[i].setting.cells); });
    add("mesh tolerance", "1", "of an adaptive mesh, relative to the square of the strain", [&](const std::size_t i) {
      return rows[i].setting.mesh_tolerance;
    });
    add("tolerance",
        "1",
        "time tolerance over the size of the displacement; of a level without a mesh: Accuracy",
        [&](const std::size_t i) { return rows[i].setting.tolerance; });
    add_text("status", "finished, inverted, failed, stopped, refused, or not offered", &TradeoffRow::status);
    add_text("reason", "name of what went wrong", &TradeoffRow::reason);
    add_text("message", "what went wrong, or what the level says about its error, in words", &TradeoffRow::message);
    add_number("displacement", "length", "of the centre of mass at the end time", &TradeoffRow::displacement);
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
    add_number("seconds",
               "s",
               "processor time to build the simulation and run it, median; of a body, in a batch",
               &TradeoffRow::seconds);
    add_number("spread", "1", "largest minus smallest measurement over the median", &TradeoffRow::spread);
    add_number("repetitions", "1", "runs that were timed", &TradeoffRow::repetitions);
    add_number("choice seconds",
               "s",
               "processor time of the pilot runs of an adaptive mesh, which is not in seconds",
               &TradeoffRow::choice_seconds);
    add_number("memory",
               "byte",
               "largest heap in use by the simulation at the ends of steps; of a batch: by all bodies",
               &TradeoffRow::memory);
    add_number("steps", "1", "accepted time steps", &TradeoffRow::steps);
    add_number("rejected steps", "1", "time steps that were done again", &TradeoffRow::rejected_steps);
    add_number("newton iterations", "1", "of all steps", &TradeoffRow::newton_iterations);
    add_number("most cells", "1", "of an adaptive mesh, largest over time", &TradeoffRow::most_cells);
    return table;
  }

  std::vector<std::string>
  recommendation_lines(const TradeoffResults &results)
  {
    std::vector<std::string> lines;
    const auto &single = results.recommendations;
    // Accuracies with the same setting share a line.
    std::string accuracies;
    for (std::size_t i = 0; i < single.size(); ++i)
    {
      accuracies += fmt::format("{}1e-{}", accuracies.empty() ? "" : " and ", single[i].exponent);
      if (i + 1 == single.size() || single[i + 1].row != single[i].row)
        lines.push_back(fmt::format("For {} use {}: {}",
                                    std::exchange(accuracies, ""),
                                    in_words(results.rows[single[i].row].setting),
                                    costs(results, single[i].row)));
    }
    const auto &batch = results.batch_recommendations;
    for (std::size_t i = 0; i < batch.size(); ++i)
    {
      accuracies += fmt::format("{}1e-{}", accuracies.empty() ? "" : " and ", batch[i].exponent);
      if (i + 1 == batch.size() || batch[i + 1].row != batch[i].row)
        lines.push_back(fmt::format("Many bodies, for {}: {}: {}",
                                    std::exchange(accuracies, ""),
                                    in_words(results.rows[batch[i].row].setting),
                                    costs(results, batch[i].row)));
    }
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
    return fmt::format(
      "Tradeoff: {} settings tried of {}{}; {} finished, {} of them below the bar, {} on the Pareto "
      "fronts; gaps: {}. The same short run took {} to {}, over ranks and time. {:.0f} s on {} rank{}.",
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
      course.n_ranks,
      course.n_ranks == 1 ? "" : "s");
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
