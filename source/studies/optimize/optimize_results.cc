// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/plain_numbers.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/optimize/optimize_results.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    constexpr std::array<const char *, n_gait_numbers> names            = {{"displacement",
                                                                            "stress_power",
                                                                            "positive_power",
                                                                            "mean_square_strain",
                                                                            "speed",
                                                                            "friction_time",
                                                                            "dissipation",
                                                                            "efficiency"}};
    constexpr std::array<const char *, n_gait_numbers> units_of_numbers = {
      {"length", "energy", "energy", "1", "length/time", "time^2/(force length)", "energy", "1"}};

    Json
    json_number(const double value)
    {
      return std::isfinite(value) ? Json(value) : Json();
    }

    /// The number at a JSON pointer; not a number if there is none.
    double
    number_at(const Json &json, const char *place)
    {
      const Json::json_pointer pointer(place);
      return json.contains(pointer) && json[pointer].is_number() ? json[pointer].get<double>() : NAN;
    }

    /// Columns that rows of records have in common.
    class Records
    {
    public:
      explicit Records(const OptimizeResults &results)
        : results_(results)
        , x_(results.paths.size())
        , axes_(results.axes.size())
      {
      }

      void
      add(const StartResult &start, const GaitRecord &record)
      {
        const OptimizeResults::Case &its = results_.cases[start.number_of_case];
        case_.push_back(static_cast<double>(start.number_of_case + 1));
        start_.push_back(static_cast<double>(start.start));
        for (std::size_t i = 0; i < axes_.size(); ++i)
          axes_[i].push_back(its.values[i]);
        for (std::size_t i = 0; i < x_.size(); ++i)
        {
          const auto place = std::ranges::find(its.paths, results_.paths[i]);
          x_[i].push_back(place == its.paths.end() ? NAN
                                                   : record.x[static_cast<std::size_t>(place - its.paths.begin())]);
        }
        objective_.push_back(record.problem.empty() ? record.objective : NAN);
        for (std::size_t i = 0; i < n_gait_numbers; ++i)
          numbers_[i].push_back(record.problem.empty() ? record.numbers[i] : NAN);
        violation_.push_back(record.problem.empty() ? record.violation : NAN);
        problem_.push_back(record.problem);
      }

      void
      put(Table &table) const
      {
        table.push_back({"case", "1", "number of the case", case_});
        for (std::size_t i = 0; i < axes_.size(); ++i)
          if (std::ranges::find(results_.paths, results_.axes[i]) == results_.paths.end()) // else it is only a start
            table.push_back({results_.axes[i], "", "of the case", axes_[i]});
        table.push_back({"start", "1", "number of the start", start_});
        for (std::size_t i = 0; i < x_.size(); ++i)
          table.push_back({results_.paths[i], results_.units[i], "variable", x_[i]});
        table.push_back({"objective", results_.unit, results_.objective, objective_});
        for (std::size_t i = 0; i < n_gait_numbers; ++i)
          if (std::ranges::any_of(numbers_[i], [](const double one) { return std::isfinite(one) && one != 0.; }))
            table.push_back({names[i], units_of_numbers[i], "", numbers_[i]});
        table.push_back({"violation", "1", "of the limit that is exceeded most, relative to it", violation_});
        table.push_back({"problem", "", "why there is no gait", problem_});
      }

    private:
      const OptimizeResults &results_;
      std::vector<std::vector<double>> x_;
      std::vector<std::vector<std::string>> axes_;
      std::vector<double> case_, start_, objective_, violation_;
      std::array<std::vector<double>, n_gait_numbers> numbers_;
      std::vector<std::string> problem_;
    };
  } // namespace

  OptimizeResults::OptimizeResults(OptimizeCases &its_cases, std::vector<StartResult> its_starts)
    : axes(its_cases.axes())
    , objective(its_cases.parameters().optimize.objective)
    , unit(objective == "displacement"    ? "length"
           : objective == "speed"         ? "length/time"
           : objective.ends_with("merit") ? "1"
                                          : "force")
    , starts(std::move(its_starts))
  {
    for (unsigned long number = 0; number < its_cases.size(); ++number)
    {
      const auto family    = its_cases.family(number);
      const bool is_onward = family->form().parameters.optimize.direction == "forward";
      cases.push_back({its_cases.values(number), {}, its_cases.in_words(number), is_onward ? 1. : -1.});
      for (const Variable &variable : family->variables())
      {
        cases.back().paths.push_back(variable.path);
        if (std::ranges::find(paths, variable.path) != paths.end())
          continue;
        paths.push_back(variable.path);
        units.push_back(family->form().declarations.info(variable.path).unit);
      }
    }
    const auto value = [&](const std::size_t i) {
      const double f = starts[i].best.objective;
      return objective == "cost of transport" ? 1. / f : cases[starts[i].number_of_case].sign * f;
    };
    const auto is_better = [&](const std::size_t i, const std::size_t j) {
      if (starts[i].is_admissible() != starts[j].is_admissible())
        return starts[i].is_admissible();
      return value(i) > value(j);
    };
    for (std::size_t i = 0; i < starts.size(); ++i)
    {
      if (starts[i].best.x.empty() || !starts[i].best.problem.empty() || !std::isfinite(starts[i].best.objective))
        continue;
      if (best.empty() || starts[i].number_of_case != starts[best.back()].number_of_case)
        best.push_back(i);
      else if (is_better(i, best.back()))
        best.back() = i;
    }
  }

  Table
  evaluation_table(const OptimizeResults &results)
  {
    Records records(results);
    std::vector<double> index, evaluation;
    for (const StartResult &start : results.starts)
      for (std::size_t i = 0; i < start.records.size(); ++i)
      {
        index.push_back(static_cast<double>(index.size()));
        evaluation.push_back(static_cast<double>(i));
        records.add(start, start.records[i]);
      }
    Table table = {{"index", "1", "number of the row", index},
                   {"evaluation", "1", "number of the evaluation in its start", evaluation}};
    records.put(table);
    return table;
  }

  Table
  start_table(const OptimizeResults &results)
  {
    Records records(results);
    std::vector<double> index, iterations, evaluations, seconds;
    std::vector<std::string> status;
    for (const StartResult &start : results.starts)
    {
      if (start.best.x.empty())
        continue;
      index.push_back(static_cast<double>(index.size()));
      records.add(start, start.best);
      iterations.push_back(start.iterations);
      evaluations.push_back(static_cast<double>(start.records.size()));
      seconds.push_back(start.seconds);
      status.push_back(start.has_converged ? "converged" : start.message);
    }
    Table table = {{"index", "1", "number of the row", index}};
    records.put(table);
    table.push_back({"iterations", "1", "of the optimiser", iterations});
    table.push_back({"evaluations", "1", "of gaits", evaluations});
    table.push_back({"seconds", "s", "wall time", seconds});
    table.push_back({"optimiser", "", "how it ended", status});
    return table;
  }

  Table
  optimum_table(const OptimizeResults &results, const std::vector<std::string> &summaries)
  {
    Records records(results);
    std::vector<double> error, efficiency, of_stride;
    std::map<std::string, std::vector<double>> multipliers;
    for (std::size_t i = 0; i < results.best.size(); ++i)
    {
      const StartResult &start = results.starts[results.best[i]];
      const Json run           = Json::parse(summaries[i]);
      records.add(start, start.best);
      error.push_back(number_at(run, "/displacement_error/total"));
      efficiency.push_back(number_at(run, "/gait/efficiency"));
      of_stride.push_back(number_at(run, "/gait/stride_efficiency"));
      for (const GaitLimit &limit : start.limits)
        multipliers.try_emplace(limit.name, results.best.size(), NAN).first->second[i] = limit.multiplier;
    }
    Table table;
    records.put(table);
    std::erase_if(table, [](const auto &column) { return column.name == "efficiency"; }); // that of the run is better
    table.push_back({"displacement_error", "length", "bound of its error, by the run of the optimum", error});
    table.push_back({"efficiency", "1", "part of what any gait with this work and these strains could", efficiency});
    table.push_back({"stride_efficiency", "1", "the same of the last stride, with its dissipation", of_stride});
    for (const auto &[name, values] : multipliers)
      table.push_back({"multiplier of " + name, "", "objective for one unit more", values});
    return table;
  }

  std::string
  optimize_json(const OptimizeResults &results,
                const std::vector<std::string> &summaries,
                const std::string &status,
                const std::string &reason,
                const double seconds,
                const std::string &command_line)
  {
    Json all                = summaries.empty() ? Json::object() : Json::parse(summaries.back());
    Json own                = {{"status", status},
                               {"reason", reason.empty() ? Json() : Json(reason)},
                               {"objective", results.objective},
                               {"starts", results.starts.size()},
                               {"seconds", seconds},
                               {"command_line", command_line},
                               {"optima", Json::array()}};
    std::size_t evaluations = 0;
    for (const StartResult &start : results.starts)
      evaluations += start.records.size();
    own["evaluations"] = evaluations;
    for (std::size_t i = 0; i < results.best.size(); ++i)
    {
      const StartResult &start         = results.starts[results.best[i]];
      const OptimizeResults::Case &its = results.cases[start.number_of_case];
      Json one                         = {{"number", start.number_of_case + 1},
                                          {"case", Json::object()},
                                          {"start", start.start},
                                          {"has_converged", start.has_converged},
                                          {"message", start.message.empty() ? Json() : Json(start.message)},
                                          {"objective", json_number(start.best.objective)},
                                          {"violation", json_number(start.best.violation)},
                                          {"exceeded_limit", start.is_admissible() ? Json() : Json(start.best.worst_limit)},
                                          {"is_admissible", start.is_admissible()},
                                          {"variables", Json::object()},
                                          {"limits", Json::object()}};
      for (std::size_t k = 0; k < results.axes.size(); ++k)
        one["case"][results.axes[k]] = to_number(its.values[k]) ? Json(*to_number(its.values[k])) : Json(its.values[k]);
      for (std::size_t k = 0; k < its.paths.size(); ++k)
        one["variables"][its.paths[k]] = start.best.x[k];
      for (const GaitLimit &limit : start.limits)
        one["limits"][limit.name] = {{"value", limit.value}, {"multiplier", json_number(limit.multiplier)}};
      if (i < summaries.size())
      {
        const Json run = Json::parse(summaries[i]);
        for (const char *key : {"displacement", "displacement_error", "stress_power"})
          one[key] = run.value(key, Json());
        one["efficiency"]        = json_number(number_at(run, "/gait/efficiency"));
        one["stride_efficiency"] = json_number(number_at(run, "/gait/stride_efficiency"));
      }
      own["optima"].push_back(one);
    }
    all["optimize"] = own;
    return all.dump(2) + "\n";
  }

  std::vector<std::string>
  in_words(const OptimizeResults &results, const std::vector<std::string> &summaries, const UnitNames &units)
  {
    constexpr std::size_t most_variables = 12;
    constexpr double near_inversion      = 0.02;
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < results.best.size(); ++i)
    {
      const StartResult &start         = results.starts[results.best[i]];
      const OptimizeResults::Case &its = results.cases[start.number_of_case];
      lines.push_back(fmt::format(
        "Best {}{}: {:.8g}{}{}{}",
        results.objective,
        its.words.empty() ? "" : fmt::format(" with {}", its.words),
        start.best.objective,
        units.behind(results.unit),
        start.is_admissible() ? ""
                              : fmt::format(" ({} is EXCEEDED, by {:.2g} %: no gait that keeps to all limits "
                                            "was found)",
                                            start.best.worst_limit,
                                            100. * start.best.violation),
        start.has_converged ? "" : fmt::format(" (the optimiser did not converge: {})", start.message)));
      if (i < summaries.size())
      {
        const bool is_stride = results.objective == "periodic merit";
        const double efficiency =
          number_at(Json::parse(summaries[i]), is_stride ? "/gait/stride_efficiency" : "/gait/efficiency");
        if (std::isfinite(efficiency))
          lines.push_back(fmt::format("  reaches {:.0f} % of what any gait with this {} and these strains could{}",
                                      100. * efficiency,
                                      is_stride ? "dissipation" : "work",
                                      is_stride ? ", in the last stride" : ""));
        const double stretch = number_at(Json::parse(summaries[i]), "/min_stretch/value");
        const bool has_own = std::ranges::find(start.limits, "Smallest strain", &GaitLimit::name) != start.limits.end();
        if (stretch < near_inversion && !has_own)
          lines.push_back(
            fmt::format("  Here the body is pressed together to a stretch of {:.2g}: inversion holds the gait "
                        "back, not a limit that was set. Optimize/Smallest strain sets one",
                        stretch));
      }
      for (std::size_t k = 0; k < std::min(its.paths.size(), most_variables); ++k)
        lines.push_back(fmt::format("  {} = {:.8g}", its.paths[k], start.best.x[k]));
      if (its.paths.size() > most_variables)
        lines.push_back(fmt::format("  and {} more variables", its.paths.size() - most_variables));
      for (const GaitLimit &limit : start.limits)
        if (std::isfinite(limit.multiplier) && limit.multiplier != 0.)
          lines.push_back(fmt::format(
            "  {} = {:g} holds it back: one unit more would add {:.4g}", limit.name, limit.value, limit.multiplier));
    }
    return lines;
  }
} // namespace crawler
