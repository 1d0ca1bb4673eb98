// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/versions.h>
#include <crawler/run/gait_efficiency.h>
#include <crawler/run/result_table.h>
#include <crawler/run/summary.h>
#include <crawler/time/petsc_stepper.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    /// Place in the JSON of a key with dots for nesting.
    Json &
    place_of(const std::string &key, Json &json)
    {
      std::string path = "/" + key;
      std::replace(path.begin(), path.end(), '.', '/');
      return json[Json::json_pointer(path)];
    }

    Json
    as_json(const ResultValue &value)
    {
      if (const auto *text = std::get_if<std::string>(&value); text != nullptr && text->empty())
        return nullptr;
      return std::visit(
        [](const auto &one) -> Json {
          if constexpr (std::is_same_v<std::decay_t<decltype(one)>, std::monostate>)
            return nullptr;
          else if constexpr (std::is_same_v<std::decay_t<decltype(one)>, double>)
            return one + 0.; // no -0
          else
            return one;
        },
        value);
    }

    std::string
    displacement_in_words(const SimulationResult &result, const UnitNames &units)
    {
      const std::string number =
        std::isfinite(result.displacement) ? fmt::format("{:.10g}", result.displacement) : "unknown";
      const std::string unit = units.behind("length");
      if (!result.error || !std::isfinite(result.error->total))
        return number + unit;
      const DisplacementError &error = *result.error;
      if (!std::isfinite(error.space))
        return fmt::format("{} +- {:.2g}{} (space and time together)", number, error.total, unit);
      return fmt::format("{} +- {:.2g}{} (space {:.2g}, time {:.2g}, model {:.2g})",
                         number,
                         error.total,
                         unit,
                         error.space,
                         error.time,
                         error.model);
    }

    void
    add_gait_lines(const SimulationResult &result, const UnitNames &units, std::vector<std::string> &lines)
    {
      if (!result.gait)
        return;
      const Gait &gait = *result.gait;
      lines.push_back(fmt::format(
        "  stride            period {:.6g}{}{}, displacement {:.6g}{} ({:.4g} body lengths), speed {:.4g}{}",
        gait.period,
        units.behind("time"),
        gait.is_declared ? "" : " (found in the stretch)",
        gait.displacement,
        units.behind("length"),
        gait.body_lengths(),
        gait.speed(),
        units.behind("length/time")));
      if (gait.wave)
        lines.push_back(fmt::format(
          "  wave              {}{}, coherence {:.3g}{}",
          gait.direction(),
          gait.wave_speed() ? fmt::format(", speed {:.4g}{}", *gait.wave_speed(), units.behind("length/time")) : "",
          gait.wave->coherence,
          gait.slip() ? fmt::format(", slip {:.4g}", *gait.slip()) : ""));
      if (!gait.energy_balance)
        return;
      const auto cost = gait.cost_of_transport(gait.energy_balance->stress_work);
      if (!cost)
        return;
      const auto positive = gait.cost_of_transport(gait.energy_balance->positive_work);
      lines.push_back(fmt::format("  cost of transport {:.4g}{}{} (work per distance of the last stride{})",
                                  *cost,
                                  error_bound_in_words(result, "gait.cost_of_transport.stress_power"),
                                  units.behind("force"),
                                  positive ? fmt::format("; {:.4g} if it cannot be recovered", *positive) : ""));
    }
    void
    add_sensitivity_lines(const SimulationResult &result, std::vector<std::string> &lines)
    {
      if (!result.sensitivities.empty())
        lines.emplace_back("  sensitivities     d(displacement)/d(entry), and % of displacement for 1 % of the entry");
      std::size_t width = 0;
      for (const EntrySensitivity &one : result.sensitivities)
        width = std::max(width, one.entry.size());
      for (const EntrySensitivity &one : result.sensitivities)
        lines.push_back(one.value
                          ? fmt::format("    {:<{}}  {:12.6g} +- {:.2g}{}",
                                        one.entry,
                                        width,
                                        *one.value,
                                        one.error.value_or(std::numeric_limits<double>::quiet_NaN()),
                                        result.displacement != 0. && one.at != 0. && std::abs(*one.value) > one.error
                                          ? fmt::format("  {:8.3g} %", one.elasticity(result.displacement))
                                          : "")
                          : fmt::format("    {:<{}}  not known: {}", one.entry, width, one.reason));
      if (const auto deviation = result.standard_deviation("displacement"))
        lines.push_back(fmt::format(
          "  uncertain entries make the displacement uncertain by {:.2g} (standard deviation)", *deviation));
      else if (std::ranges::any_of(result.sensitivities, [](const auto &one) { return one.standard_deviation > 0.; }))
        lines.emplace_back(
          "  the effect of uncertain entries on the displacement is not known, since a derivative is not");
    }
  } // namespace

  nlohmann::ordered_json
  summary_of(const SimulationResult &result)
  {
    Json json;
    for (const ResultEntry &entry : result_table())
      place_of(entry.key, json) = as_json(entry.value_in(result));
    // Parts missing from the run.
    if (!result.cycles)
      json["cycles"] = nullptr;
    if (!result.inversion)
      json["inversion"] = nullptr;
    return json;
  }

  nlohmann::ordered_json
  result_entries()
  {
    Json entries = Json::array();
    for (const ResultEntry &entry : result_table())
      entries.push_back({{"key", entry.key}, {"unit", entry.unit}, {"meaning", entry.meaning}});
    return entries;
  }

  std::string
  summary_json(const SimulationResult &result, const unsigned int n_ranks, const std::string &command_line)
  {
    Json json = summary_of(result);
    if (result.process.engine == "petsc")
      json["integrator"] = integrator_of_petsc(result.process.integrator);
    json["displacement_corrected"] = nullptr;
    if (result.corrected)
      json["displacement_corrected"] = {{"value", result.corrected->value}, {"error", result.corrected->error}};
    json["sensitivities"] = nullptr;
    for (const EntrySensitivity &one : result.sensitivities)
    {
      Json &entry    = json["sensitivities"][one.entry];
      entry["value"] = one.value ? Json(*one.value) : Json(nullptr);
      entry["error"] = one.error ? Json(*one.error) : Json(nullptr);
      entry["elasticity"] =
        one.value && result.displacement != 0. ? Json(one.elasticity(result.displacement)) : Json(nullptr);
      for (const EntrySensitivity::OfNumber &other : one.others)
        entry[other.key] = {{"value", other.value}, {"error", other.error}};
      if (one.standard_deviation > 0.)
        entry["standard_deviation"] = one.standard_deviation;
      if (!one.reason.empty())
        entry["reason"] = one.reason;
    }
    json["uncertainty"] = nullptr;
    for (const ResultEntry &entry : result_table())
      if (const auto deviation = result.standard_deviation(entry.key))
        json["uncertainty"][entry.key] = *deviation;
    json["ranks"]        = n_ranks;
    json["versions"]     = versions();
    json["command_line"] = command_line;
    return json.dump(2, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace) + "\n";
  }

  std::vector<std::string>
  summary_lines(const SimulationResult &result, const UnitNames &units)
  {
    const auto &time               = result.time;
    std::vector<std::string> lines = {
      fmt::format("{} at t = {:g}{}{}, {:.3g} s",
                  time.status == Status::finished   ? "Finished"
                  : time.status == Status::inverted ? "Inverted"
                  : time.status == Status::stopped  ? "Stopped"
                                                    : "FAILED (" + time.reason + ")",
                  time.time,
                  units.behind("time"),
                  time.steps > 0 ? fmt::format(" after {} steps ({} rejected)", time.steps, time.rejected_steps) : "",
                  result.process.seconds.solve + result.process.seconds.output),
      "  displacement      " + displacement_in_words(result, units)};
    if (const auto &answer = result.corrected)
      lines.push_back(fmt::format("  corrected         {:.12g} +- {:.2g}{} (by the adjoint)",
                                  answer->value,
                                  answer->error,
                                  units.behind("length")));
    if (const auto &cycles = result.cycles)
      lines.push_back(
        fmt::format("  cycles            {} of period {:.6g} computed, {} extrapolated with an error of at "
                    "most {:.2g} in the displacement",
                    cycles->computed,
                    cycles->period,
                    cycles->extrapolated,
                    cycles->bound));
    if (const auto &energies = result.energy_balance)
    {
      const std::string unit = units.behind("force length"), bound = error_bound_in_words(result, "stress_power");
      const double net = result.residuals.net_friction;
      lines.push_back(fmt::format("  stress work       {:.10g}{}{}", energies->stress_work, bound, unit));
      lines.push_back(fmt::format("  dissipation       {:.10g}{}", energies->dissipation, unit));
      lines.push_back(fmt::format("  energy residual   {:.2e} (relative), net friction {}",
                                  energies->residual(),
                                  std::isfinite(net) ? fmt::format("{:.2e} (relative)", net) : "unknown"));
    }
    if (result.residuals.unknown_works)
      lines.push_back(fmt::format("  works             unknown: the energy balance lacks {:.2g} of the exchanged work",
                                  *result.residuals.unknown_works));
    const auto extreme = [](const Extreme &at) {
      return fmt::format("{:.4g} (s = {:.4g}, t = {:.4g})", at.value, at.s, at.t);
    };
    lines.push_back("  stretch           " + extreme(result.stretch.min) + " to " + extreme(result.stretch.max));
    add_gait_lines(result, units, lines);
    if (result.gait_efficiency)
      lines.push_back(
        fmt::format("  efficiency        {:.3g} % of the upper bound for this {} and these strains{}",
                    100. * *result.gait_efficiency,
                    starts_from_rest(*result.energy_balance) ? "work" : "dissipation",
                    result.gait && result.gait->efficiency && result.gait->n_strides > 1.
                      ? fmt::format("; the last stride {:.3g} % with its dissipation", 100. * *result.gait->efficiency)
                      : ""));
    add_sensitivity_lines(result, lines);
    return lines;
  }
} // namespace crawler
