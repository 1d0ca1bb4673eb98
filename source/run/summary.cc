// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/petsc_object.h>
#include <crawler/base/versions.h>
#include <crawler/run/summary.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    Json
    extreme(const SimulationResult::Extreme &e)
    {
      return {{"value", e.value}, {"s", e.s}, {"t", e.t}};
    }

    Json
    inversion(const SimulationResult &result)
    {
      if (!result.inversion)
        return nullptr;
      Json json       = extreme(*result.inversion);
      json["error"]   = result.inversion_error ? Json(*result.inversion_error) : Json(nullptr);
      json["s_first"] = result.inverted_places ? result.inverted_places->first : result.inversion->s;
      json["s_last"]  = result.inverted_places ? result.inverted_places->second : result.inversion->s;
      return json;
    }

    Json
    number(const std::optional<double> value)
    {
      return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
    }

    /// The last stride; every key is there, and null where it is not known.
    Json
    gait_numbers(const SimulationResult &result)
    {
      const auto of_gait = [&](auto value) -> std::optional<double> {
        return result.gait ? std::optional<double>(value(*result.gait)) : std::nullopt;
      };
      const auto cost = [&](auto energy) -> Json {
        if (!result.gait || !result.gait->energy_balance)
          return nullptr;
        return number(result.gait->cost_of_transport(energy(*result.gait->energy_balance)));
      };
      const bool has_wave = result.gait && result.gait->wave;
      Json json;
      json["period"]       = number(of_gait([](const Gait &g) { return g.period; }));
      json["frequency"]    = number(of_gait([](const Gait &g) { return 1. / g.period; }));
      json["period_from"]  = result.gait ? Json(result.gait->is_declared ? "active stress" : "stretch") : Json(nullptr);
      json["strides"]      = number(of_gait([](const Gait &g) { return g.n_strides; }));
      json["displacement"] = number(of_gait([](const Gait &g) { return g.displacement; }));
      json["body_lengths"] = number(of_gait([](const Gait &g) { return g.body_lengths(); }));
      json["speed"]        = number(of_gait([](const Gait &g) { return g.speed(); }));
      json["cost_of_transport"] = {{"stress_power", cost([](const EnergyBalance &l) { return l.stress_power; })},
                                   {"positive_power", cost([](const EnergyBalance &l) { return l.positive_power; })},
                                   {"paper_energy", cost([](const EnergyBalance &l) { return l.paper_energy(); })},
                                   {"dissipation", cost([](const EnergyBalance &l) { return l.dissipation; })}};
      json["slip"]              = result.gait ? number(result.gait->slip()) : Json(nullptr);
      json["wave"]              = {{"direction", result.gait ? Json(result.gait->direction()) : Json(nullptr)},
                                   {"speed", result.gait ? number(result.gait->wave_speed()) : Json(nullptr)},
                                   {"coherence", has_wave ? Json(result.gait->wave->coherence) : Json(nullptr)}};
      json["efficiency"]        = number(result.gait_efficiency);
      return json;
    }

    /// Error bars of other numbers than the displacement, under their keys.
    Json
    error_bars(const NumberErrors &errors)
    {
      Json json;
      for (std::size_t i = 0; i < NumberErrors::n; ++i)
      {
        const std::string key = NumberErrors::keys()[i];
        Json *place           = &json;
        std::size_t from = 0, dot = 0;
        for (; (dot = key.find('.', from)) != std::string::npos; from = dot + 1)
          place = &(*place)[key.substr(from, dot - from)];
        (*place)[key.substr(from)] = number(errors.values[i]);
      }
      return json;
    }

    /// " +- 1e-6", if the error of the number under this key is known.
    std::string
    bar(const SimulationResult &result, const std::string &key)
    {
      for (std::size_t i = 0; result.errors && i < NumberErrors::n; ++i)
        if (NumberErrors::keys()[i] == key && std::isfinite(result.errors->values[i]))
          return fmt::format(" +- {:.2g}", result.errors->values[i]);
      return "";
    }

    void
    add_gait_lines(const SimulationResult &result, std::vector<std::string> &lines)
    {
      if (!result.gait)
        return;
      const Gait &gait = *result.gait;
      lines.push_back(
        fmt::format("  stride            period {:.6g}{}, displacement {:.6g} ({:.4g} body lengths), speed {:.4g}",
                    gait.period,
                    gait.is_declared ? "" : " (found in the stretch)",
                    gait.displacement,
                    gait.body_lengths(),
                    gait.speed()));
      if (gait.wave)
        lines.push_back(fmt::format("  wave              {}{}, coherence {:.3g}{}",
                                    gait.direction(),
                                    gait.wave_speed() ? fmt::format(", speed {:.4g}", *gait.wave_speed()) : "",
                                    gait.wave->coherence,
                                    gait.slip() ? fmt::format(", slip {:.4g}", *gait.slip()) : ""));
      if (!gait.energy_balance)
        return;
      const auto cost = gait.cost_of_transport(gait.energy_balance->stress_power);
      if (!cost)
        return;
      const auto positive = gait.cost_of_transport(gait.energy_balance->positive_power);
      lines.push_back(fmt::format("  cost of transport {:.4g}{} (work per distance{})",
                                  *cost,
                                  bar(result, "gait.cost_of_transport.stress_power"),
                                  positive ? fmt::format("; {:.4g} if it cannot be recovered", *positive) : ""));
    }
  } // namespace

  nlohmann::ordered_json
  summary_of(const SimulationResult &result, const RunParameters &parameters)
  {
    const auto &mesh          = result.mesh;
    const auto energy_balance = [&](auto value) {
      return result.energy_balance ? Json(value(*result.energy_balance)) : Json(nullptr);
    };
    Json json;
    json["status"]                = result.time.status;
    json["reason"]                = result.time.status == "finished" ? Json(nullptr) : Json(result.time.reason);
    json["message"]               = result.time.status == "finished" ? Json(nullptr) : Json(result.time.message);
    json["displacement"]          = result.displacement;
    const DisplacementError error = result.error.value_or(DisplacementError());
    json["displacement_error"]    = {
         {"total", error.total}, {"space", error.space}, {"time", error.time}, {"model", error.model}};
    json["end_time"]           = result.time.time;
    json["cycles"]             = result.cycles ? Json{{"period", result.cycles->period},
                                          {"computed", result.cycles->computed},
                                          {"extrapolated", result.cycles->extrapolated},
                                          {"error", result.cycles->bound}}
                                               : Json(nullptr);
    json["model"]              = parameters.model;
    json["stress_power"]       = energy_balance([](const EnergyBalance &l) { return l.stress_power; });
    json["dissipation"]        = energy_balance([](const EnergyBalance &l) { return l.dissipation; });
    json["elastic_energy"]     = energy_balance([](const EnergyBalance &l) { return l.elastic_energy; });
    json["ledger_residual"]    = energy_balance([](const EnergyBalance &l) { return l.residual(); });
    json["paper_energy"]       = energy_balance([](const EnergyBalance &l) { return l.paper_energy(); });
    json["positive_power"]     = energy_balance([](const EnergyBalance &l) { return l.positive_power; });
    json["net_friction"]       = result.energy_balance ? Json(result.net_friction) : Json(nullptr);
    json["min_stretch"]        = extreme(result.min_stretch);
    json["max_stretch"]        = extreme(result.max_stretch);
    json["gait"]               = gait_numbers(result);
    json["errors"]             = error_bars(result.errors.value_or(NumberErrors()));
    json["formulation"]        = result.formulation == Formulation::stretch ? "stretch" : "position";
    json["mesh_changes"]       = result.mesh_changes;
    json["most_cells"]         = std::max(result.most_cells, mesh ? mesh->n_cells : 0);
    json["inversion"]          = inversion(result);
    json["cells"]              = mesh ? mesh->n_cells : 0;
    json["degree"]             = mesh ? Json(mesh->degree) : Json(nullptr);
    json["degrees_of_freedom"] = mesh ? mesh->n_unknowns : 0;
    json["steps"]              = result.time.steps;
    json["rejected_steps"]     = result.time.rejected_steps;
    json["newton_iterations"]  = result.time.newton_iterations;
    json["cells_shared"]       = mesh && mesh->is_shared;
    json["refinements"]        = result.refinements;
    json["integrator"]         = result.integrator.empty() ? Json(nullptr) : Json(result.integrator);
    json["engine"]             = result.engine.empty() ? Json(nullptr) : Json(result.engine);
    json["seconds"]            = {{"setup", result.setup_seconds},
                                  {"solve", result.solve_seconds},
                                  {"output", result.output_seconds},
                                  {"error", result.estimate_seconds}};
    return json;
  }

  std::string
  summary_json(const SimulationResult &result,
               const RunParameters &parameters,
               const unsigned int n_ranks,
               const std::string &command_line)
  {
    Json json = summary_of(result, parameters);
    if (result.engine == "petsc")
      json["integrator"] = integrator_of_petsc(result.integrator);
    json["ranks"]        = n_ranks;
    json["versions"]     = versions();
    json["command_line"] = command_line;
    return json.dump(2, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace) + "\n";
  }

  std::vector<std::string>
  summary_lines(const SimulationResult &result, const RunParameters &)
  {
    std::vector<std::string> lines;
    const auto &time = result.time;
    const std::string steps =
      time.steps > 0 ? fmt::format(" after {} steps ({} rejected)", time.steps, time.rejected_steps) : "";
    lines.push_back(fmt::format("{} at t = {:g}{}, {:.3g} s",
                                time.status == "finished"   ? "Finished"
                                : time.status == "inverted" ? "Inverted"
                                : time.status == "stopped"  ? "Stopped"
                                                            : "FAILED (" + time.reason + ")",
                                time.time,
                                steps,
                                result.solve_seconds + result.output_seconds));
    std::string displacement =
      std::isfinite(result.displacement) ? fmt::format("{:.10g}", result.displacement) : "unknown";
    if (result.error && std::isfinite(result.error->total) && !std::isfinite(result.error->space))
      displacement += fmt::format(" +- {:.2g} (space and time together)", result.error->total);
    else if (result.error && std::isfinite(result.error->total))
      displacement += fmt::format(" +- {:.2g} (space {:.2g}, time {:.2g}, model {:.2g})",
                                  result.error->total,
                                  result.error->space,
                                  result.error->time,
                                  result.error->model);
    lines.push_back("  displacement      " + displacement);
    if (result.cycles)
      lines.push_back(
        fmt::format("  cycles            {} of period {:.6g} computed, {} extrapolated with an error of at "
                    "most {:.2g} in the displacement",
                    result.cycles->computed,
                    result.cycles->period,
                    result.cycles->extrapolated,
                    result.cycles->bound));
    if (result.energy_balance)
    {
      lines.push_back(
        fmt::format("  stress power      {:.10g}{}", result.energy_balance->stress_power, bar(result, "stress_power")));
      lines.push_back(fmt::format("  dissipation       {:.10g}", result.energy_balance->dissipation));
      lines.push_back(fmt::format(
        "  ledger residual   {:.2e} (relative), net friction {}",
        result.energy_balance->residual(),
        std::isfinite(result.net_friction) ? fmt::format("{:.2e} (relative)", result.net_friction) : "unknown"));
    }
    lines.push_back(
      fmt::format("  stretch           {:.4g} (s = {:.4g}, t = {:.4g}) to {:.4g} (s = {:.4g}, t = {:.4g})",
                  result.min_stretch.value,
                  result.min_stretch.s,
                  result.min_stretch.t,
                  result.max_stretch.value,
                  result.max_stretch.s,
                  result.max_stretch.t));
    add_gait_lines(result, lines);
    return lines;
  }
} // namespace crawler
