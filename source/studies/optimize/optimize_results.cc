// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/studies/optimize/optimize_results.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    constexpr std::array<const char *, n_gait_numbers> names = {
      {"displacement", "stress_power", "positive_power", "mean_square_strain", "speed", "friction_time"}};
    constexpr std::array<const char *, n_gait_numbers> units_of_numbers = {
      {"length", "energy", "energy", "1", "length/time", "time^2/(force length)"}};

    Json
    json_number(const double value)
    {
      return std::isfinite(value) ? Json(value) : Json();
    }

    /// Columns that rows of records have in common.
    class Records
    {
    public:
      explicit Records(const OptimizeResults &results)
        : results_(results)
        , x_(results.variables.size())
      {
      }

      void
      add(const StartResult &start, const GaitRecord &record)
      {
        work_.push_back(start.work.value_or(NAN));
        start_.push_back(static_cast<double>(start.start));
        for (std::size_t i = 0; i < x_.size(); ++i)
          x_[i].push_back(record.x[i]);
        objective_.push_back(record.problem.empty() ? record.objective : NAN);
        for (std::size_t i = 0; i < n_gait_numbers; ++i)
          numbers_[i].push_back(record.problem.empty() ? record.numbers[i] : NAN);
        violation_.push_back(record.problem.empty() ? record.violation : NAN);
        problem_.push_back(record.problem);
      }

      void
      put(Table &table) const
      {
        table.push_back({"work_limit", "energy", "limit of the work", work_});
        table.push_back({"start", "1", "number of the start", start_});
        for (std::size_t i = 0; i < x_.size(); ++i)
          table.push_back({results_.variables[i].path, results_.units[i], "variable", x_[i]});
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
      std::vector<double> work_, start_, objective_, violation_;
      std::array<std::vector<double>, n_gait_numbers> numbers_;
      std::vector<std::string> problem_;
    };
  } // namespace

  OptimizeResults::OptimizeResults(const OptimizeParameters &parameters,
                                   std::vector<OptimizeVariable> its_variables,
                                   const Declarations &declarations,
                                   std::vector<StartResult> its_starts)
    : variables(std::move(its_variables))
    , objective(parameters.objective)
    , unit(objective == "displacement" ? "length"
           : objective == "speed"      ? "length/time"
           : objective == "merit"      ? "1"
                                       : "force")
    , starts(std::move(its_starts))
  {
    for (const OptimizeVariable &variable : variables)
      units.push_back(declarations.info(variable.path).unit);
    const double sign = parameters.direction == "forward" ? 1. : -1.;
    const auto value  = [&](const std::size_t i) {
      const double f = starts[i].best.objective;
      return objective == "cost of transport" ? 1. / f : sign * f;
    };
    const auto is_better = [&](const std::size_t i, const std::size_t j) {
      if (starts[i].is_admissible() != starts[j].is_admissible())
        return starts[i].is_admissible();
      return value(i) > value(j);
    };
    for (std::size_t i = 0; i < starts.size(); ++i)
    {
      if (starts[i].best.x.empty() || !starts[i].best.problem.empty())
        continue;
      if (best.empty() || starts[i].work != starts[best.back()].work)
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
      const StartResult &start = results.starts[results.best[i]];
      Json one                 = {{"work_limit", start.work ? Json(*start.work) : Json()},
                                  {"start", start.start},
                                  {"has_converged", start.has_converged},
                                  {"message", start.message.empty() ? Json() : Json(start.message)},
                                  {"objective", json_number(start.best.objective)},
                                  {"violation", json_number(start.best.violation)},
                                  {"is_admissible", start.is_admissible()},
                                  {"variables", Json::object()},
                                  {"limits", Json::object()}};
      for (std::size_t k = 0; k < results.variables.size(); ++k)
        one["variables"][results.variables[k].path] = start.best.x[k];
      for (const GaitLimit &limit : start.limits)
        one["limits"][limit.name] = {{"value", limit.value}, {"multiplier", json_number(limit.multiplier)}};
      if (i < summaries.size())
      {
        const Json run = Json::parse(summaries[i]);
        for (const char *key : {"displacement", "displacement_error", "stress_power"})
          one[key] = run.value(key, Json());
        one["efficiency"] = run.contains("gait") ? run["gait"].value("efficiency", Json()) : Json();
      }
      own["optima"].push_back(one);
    }
    all["optimize"] = own;
    return all.dump(2) + "\n";
  }

  std::vector<std::string>
  in_words(const OptimizeResults &results, const std::vector<std::string> &summaries)
  {
    constexpr std::size_t most_variables = 12;
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < results.best.size(); ++i)
    {
      const StartResult &start = results.starts[results.best[i]];
      lines.push_back(
        fmt::format("Best {}{}: {:.8g}{}{}",
                    results.objective,
                    start.work ? fmt::format(" with work up to {:g}", *start.work) : "",
                    start.best.objective,
                    start.is_admissible() ? "" : " (a limit is EXCEEDED: no gait that keeps to all limits was found)",
                    start.has_converged ? "" : fmt::format(" (the optimiser did not converge: {})", start.message)));
      if (i < summaries.size())
      {
        const Json run = Json::parse(summaries[i]);
        if (run.contains("gait") && run["gait"].value("efficiency", Json()).is_number())
          lines.push_back(fmt::format("  reaches {:.0f} % of what any gait with this work and these strains could",
                                      100. * run["gait"]["efficiency"].get<double>()));
      }
      for (std::size_t k = 0; k < std::min(results.variables.size(), most_variables); ++k)
        lines.push_back(fmt::format("  {} = {:.8g}", results.variables[k].path, start.best.x[k]));
      if (results.variables.size() > most_variables)
        lines.push_back(fmt::format("  and {} more variables", results.variables.size() - most_variables));
      for (const GaitLimit &limit : start.limits)
        if (limit.multiplier != 0.)
          lines.push_back(fmt::format(
            "  {} = {:g} holds it back: one unit more would add {:.4g}", limit.name, limit.value, limit.multiplier));
    }
    return lines;
  }
} // namespace crawler
