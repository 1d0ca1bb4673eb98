// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/finer_run_errors.h>
#include <crawler/run/result_table.h>
#include <crawler/run/sudden_changes.h>
#include <crawler/scene/breaks.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace crawler
{
  namespace
  {
    // Constants measured by tests/verification/number_errors.py.
    constexpr double more_if_sampled = 1.5, sampling_error = 2., if_not_extrapolated = 2.;
  } // namespace

  std::vector<double>
  number_errors(const SimulationResult &result, const SimulationResult &finer, const double factor, const double part)
  {
    const double n_points = result.process.mesh.n_cells * (result.process.mesh.degree + 1.);
    const auto &entries   = entries_with_errors();
    std::vector<double> errors(entries.size());
    for (std::size_t i = 0; i < errors.size(); ++i)
    {
      const ResultEntry &entry = *entries[i];
      const double x = std::abs(entry.number_in(result) - entry.number_in(finer)), S = entry.scale_in(result);
      errors[i] = entry.is_sampled ? more_if_sampled * factor * x + (part + sampling_error / (n_points * n_points)) * S
                                   : factor * x + part * S;
      // Two meshes may have the same error at the ends of their cells.
      for (const auto &[key, extreme] :
           {std::pair("min_stretch.value", &result.stretch.min), {"max_stretch.value", &result.stretch.max}})
        if (entry.key == key)
          errors[i] = std::max(errors[i], extreme->jump);
    }
    return errors;
  }

  std::vector<double>
  errors_of_extrapolation(const SimulationResult &extrapolated,
                          const std::span<const SimulationResult *const> meshes,
                          const double part)
  {
    const SimulationResult &finest = *meshes.back();
    std::vector<double> errors     = number_errors(extrapolated, finest, 1., part);
    const auto &entries            = entries_with_errors();
    for (std::size_t before = 1; before <= 2 && before < meshes.size(); ++before)
    {
      const double factor = if_not_extrapolated / static_cast<double>(before);
      const auto changes  = number_errors(finest, *meshes[meshes.size() - 1 - before], factor, part);
      for (std::size_t i = 0; i < errors.size(); ++i)
        if (entries[i]->number_in(extrapolated) == entries[i]->number_in(finest))
          errors[i] = std::max(errors[i], changes[i]);
    }
    return errors;
  }

  void
  add_errors_of_cycles(SimulationResult &result, const double size)
  {
    if (!result.cycles || !(size > 0.))
      return;
    const auto &entries   = entries_with_errors();
    const double relative = result.cycles->bound / size;
    const double of_works = std::max(relative, result.cycles->work_bound);
    for (std::size_t i = 0; i < result.errors.size(); ++i)
      result.errors[i] +=
        (entries[i]->scale == ResultEntry::Scale::exchanged_work || entries[i]->scale == ResultEntry::Scale::cost
           ? of_works
           : relative) *
        entries[i]->scale_in(result);
    if (!result.gait || result.cycles->extrapolated == 0)
      return;
    const Gait &gait    = *result.gait;
    const double change = result.cycles->bound / result.cycles->extrapolated; // of the displacement in a stride
    const double part   = change / std::abs(gait.displacement);
    const auto add      = [&](const std::string &key, const double more) {
      if (const auto known = error_bound(result, key))
        set_error_bound(result, key, *known + more);
    };
    add("gait.displacement", change);
    add("gait.speed", change / gait.period);
    if (const auto speed = gait.wave_speed())
      add("gait.slip", change / (gait.period * std::abs(*speed)));
    for (std::size_t i = 0; i < result.errors.size(); ++i)
      if (entries[i]->scale == ResultEntry::Scale::cost) // inversely proportional to the displacement
        result.errors[i] = part < 1. ? result.errors[i] + part / (1. - part) * std::abs(entries[i]->number_in(result))
                                     : std::numeric_limits<double>::quiet_NaN();
  }

  void
  extend_errors(const Scene &scene, SimulationResult &result)
  {
    const auto extend = [&result](const char *key, const double least) {
      if (const auto known = error_bound(result, key))
        set_error_bound(result, key, std::max(*known, least));
    };
    if (result.gait)
    {
      const double round_off =
        scene.keeps_its_centre() ? result.error->total : displacement_round_off * scene.body.length;
      extend("gait.displacement", round_off);
      extend("gait.speed", round_off / result.gait->period);
    }
    if (result.errors.empty())
      return;
    // Polynomials overshoot in thin layers, on both meshes alike; with most feedback no other stretch is known there.
    if (!SuddenChanges::are_known(scene))
    {
      std::vector<double> starts = TimeSegments(*scene.active_stress, scene.end_time).breaks();
      starts.push_back(0.);
      const auto is_in_layer = [&](const Extreme &extreme) {
        return std::ranges::any_of(starts, [&](const double start) {
          const double since = extreme.t / scene.end_time - start;
          return since > 0. && since <= SuddenChanges::longest;
        });
      };
      if (is_in_layer(result.stretch.min))
        set_error_bound(result, "min_stretch.value", HUGE_VAL);
      if (is_in_layer(result.stretch.max))
        set_error_bound(result, "max_stretch.value", HUGE_VAL);
    }
    if (!result.gait_efficiency)
      return;
    const Extreme &low = result.stretch.min, &high = result.stretch.max;
    const auto bound_of   = [&](const char *key) { return error_bound(result, key).value_or(HUGE_VAL); };
    const double from     = low.value + std::max(low.jump, bound_of("min_stretch.value")),
                 to       = high.value - std::max(high.jump, bound_of("max_stretch.value")),
                 of_limit = from < to ? largest_merit(*scene.friction, low.value, high.value) /
                                            largest_merit(*scene.friction, from, to) -
                                          1.
                                      : HUGE_VAL;
    const auto error_of   = [=](const double efficiency, const double D, const double error) {
      return D != 0. ? (of_limit + error / std::abs(D)) * efficiency : 0.;
    };
    extend("gait.efficiency",
           error_of(*result.gait_efficiency,
                    result.displacement,
                    std::isfinite(result.error->total) ? result.error->total : HUGE_VAL));
    if (result.gait && result.gait->efficiency)
      extend("gait.stride_efficiency",
             error_of(*result.gait->efficiency, result.gait->displacement, bound_of("gait.displacement")));
  }
} // namespace crawler
