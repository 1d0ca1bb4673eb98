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

    /// Number at a JSON pointer; not a number if there is none.
    double
    number_at(const Json &json, const char *place)
    {
      const Json::json_pointer pointer(place);
      return json.contains(pointer) && json[pointer].is_number() ? json[pointer].get<double>() : NAN;
    }
  } // namespace

  OptimizeResults::OptimizeResults(const OptimizeNames &its_names, std::vector<StartResult> its_starts)
    : names(its_names)
    , starts(std::move(its_starts))
  {
    const auto value = [&](const std::size_t i) {
      return names.cases[starts[i].number_of_case].objective.turned(starts[i].best.objective);
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
  optimum_table(const OptimizeResults &results, const std::filesystem::path &folder)
  {
    const RowReader reader(MPI_COMM_SELF, folder / OptimizeMemory::file, OptimizeMemory::group);
    Table table;
    for (const Column &column : reader.read(0, reader.n_rows()))
      if (column.name != "index" && column.name != "efficiency")
      {
        const auto picked = [&](const auto &values) -> decltype(Column::values) {
          std::decay_t<decltype(values)> rows;
          for (const std::size_t i : results.best)
            rows.push_back(values[i]);
          return rows;
        };
        table.push_back({column.name, column.unit, column.description, std::visit(picked, column.values)});
      }
    for (const auto &[name, place] : {std::pair("displacement_error", "/displacement_error/total"),
                                      {"efficiency", "/gait/efficiency"},
                                      {"stride_efficiency", "/gait/stride_efficiency"}})
    {
      std::vector<double> values;
      for (const Json &run : results.runs)
        values.push_back(number_at(run, place));
      table.push_back({name, "", "", values});
    }
    return table;
  }

  std::string
  optimize_json(const OptimizeResults &results,
                const std::string &status,
                const std::string &reason,
                const std::string &message,
                const double seconds,
                const std::string &command_line)
  {
    Json all = results.runs.empty() ? Json::object() : results.runs.back();
    if (!reason.empty())
    {
      all["status"]  = status;
      all["reason"]  = reason;
      all["message"] = message;
    }
    Json own = {{"status", status},
                {"reason", reason.empty() ? Json() : Json(reason)},
                {"objective", results.names.objective.name},
                {"starts", results.starts.size()},
                {"seconds", seconds},
                {"command_line", command_line},
                {"optima", Json::array()},
                {"evaluations", results.n_evaluations()}};
    for (std::size_t i = 0; i < results.best.size(); ++i)
    {
      const StartResult &start       = results.starts[results.best[i]];
      const OptimizeNames::Case &its = results.names.cases[start.number_of_case];
      Json one                       = {{"number", start.number_of_case + 1},
                                        {"case", Json::object()},
                                        {"start", start.start},
                                        {"has_converged", start.has_converged},
                                        {"message", start.message.empty() ? Json() : Json(start.message)},
                                        {"objective", start.best.objective},
                                        {"violation", start.best.violation},
                                        {"exceeded_limit", start.is_admissible() ? Json() : Json(start.best.worst_limit)},
                                        {"is_admissible", start.is_admissible()},
                                        {"variables", Json::object()},
                                        {"limits", Json::object()}};
      for (std::size_t k = 0; k < results.names.axes.size(); ++k)
        one["case"][results.names.axes[k]] =
          to_number(its.values[k]) ? Json(*to_number(its.values[k])) : Json(its.values[k]);
      for (std::size_t k = 0; k < its.paths.size(); ++k)
        one["variables"][its.paths[k]] = start.best.x[k];
      for (const GaitLimit &limit : start.limits)
        one["limits"][limit.name] = {{"value", limit.value}, {"multiplier", limit.multiplier}};
      const Json &run = results.runs[i];
      for (const char *key : {"displacement", "displacement_error", "stress_power"})
        one[key] = run.value(key, Json());
      one["efficiency"]        = number_at(run, "/gait/efficiency");
      one["stride_efficiency"] = number_at(run, "/gait/stride_efficiency");
      own["optima"].push_back(one);
    }
    all["optimize"] = own;
    return all.dump(2) + "\n";
  }

  std::vector<std::string>
  in_words(const OptimizeResults &results, const OptimizeCases &cases)
  {
    constexpr std::size_t max_variables = 12;
    constexpr double near_inversion     = 0.02;
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < results.best.size(); ++i)
    {
      const StartResult &start       = results.starts[results.best[i]];
      const OptimizeNames::Case &its = results.names.cases[start.number_of_case];
      lines.push_back(fmt::format(
        "Best {}{}: {:.8g}{}{}{}",
        results.names.objective.name,
        cases.are_several() ? " with " + cases.in_words(start.number_of_case) : "",
        start.best.objective,
        cases.parameters().units.behind(results.names.objective.unit),
        start.is_admissible() ? ""
                              : fmt::format(" ({} is EXCEEDED, by {:.2g} %: no gait within all limits was found)",
                                            start.best.worst_limit,
                                            100. * start.best.violation),
        start.has_converged ? "" : fmt::format(" (the optimiser did not converge: {})", start.message)));
      const bool is_stride    = results.names.objective.energy == GaitNumber::dissipation;
      const double efficiency = number_at(results.runs[i], is_stride ? "/gait/stride_efficiency" : "/gait/efficiency");
      if (std::isfinite(efficiency))
        lines.push_back(fmt::format("  efficiency {:.0f} % of the upper bound for this {} and these strains{}",
                                    100. * efficiency,
                                    is_stride ? "dissipation" : "work",
                                    is_stride ? ", in the last stride" : ""));
      const double stretch = number_at(results.runs[i], "/min_stretch/value");
      const bool has_own   = std::ranges::find(start.limits, "Smallest strain", &GaitLimit::name) != start.limits.end();
      if (stretch < near_inversion && !has_own)
        lines.push_back(fmt::format("  Here the body is compressed to a stretch of {:.2g}: inversion holds the gait "
                                    "back, not a limit that was set. Optimize/Smallest strain sets one",
                                    stretch));
      for (std::size_t k = 0; k < std::min(its.paths.size(), max_variables); ++k)
        lines.push_back(fmt::format("  {} = {:.8g}", its.paths[k], start.best.x[k]));
      if (its.paths.size() > max_variables)
        lines.push_back(fmt::format("  and {} more variables", its.paths.size() - max_variables));
      for (const GaitLimit &limit : start.limits)
        if (std::isfinite(limit.multiplier) && limit.multiplier != 0.)
          lines.push_back(fmt::format(
            "  {} = {:g} holds it back: one unit more would add {:.4g}", limit.name, limit.value, limit.multiplier));
    }
    return lines;
  }
} // namespace crawler
