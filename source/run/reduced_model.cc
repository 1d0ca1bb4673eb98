// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/clock.h>
#include <crawler/base/grid_samples.h>
#include <crawler/reduced_models/perturbation.h>
#include <crawler/run/gait_efficiency.h>
#include <crawler/run/recorder.h>
#include <crawler/run/reduced_model.h>
#include <crawler/run/result_table.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    Extreme
    stretch_of(const StrainExtreme &e)
    {
      return {1. + e.strain, e.s, e.t};
    }

    /// Sets the error, by quadrature alone, for the kinematic level; the motion of a series is not one of a body.
    void
    set_error_of_efficiency(const std::string &key, const std::optional<double> &efficiency, SimulationResult &result)
    {
      if (efficiency && result.process.model == Model::kinematic && result.displacement != 0.)
        set_error_bound(
          result, key, 2. * (result.error->space + result.error->time) / std::abs(result.displacement) * *efficiency);
    }
  } // namespace

  ReducedModel::ReducedModel(const Scene &scene, const Model model)
    : reduced_scene(scene)
    , scene_(scene)
    , model_(model)
  {
  }

  void
  ReducedModel::compute_perturbation(SimulationResult &result) const
  {
    const NaturalWave &wave       = *reduced_scene.wave;
    const ModelErrors errors      = reduced_scene.model_errors();
    const StrainExtremes extremes = perturbation::extremes(wave);
    result.displacement           = perturbation::displacement(wave, 1.);
    result.error = {.space = 0., .time = 0., .model = errors.known ? errors.perturbation : DisplacementError::unknown};
    result.energy_balance         = perturbation::energies(wave, 1.);
    result.residuals.net_friction = DisplacementError::unknown;
    result.stretch.min            = stretch_of(extremes.smallest);
    result.stretch.max            = stretch_of(extremes.largest);
  }

  void
  ReducedModel::compute_kinematic(SimulationResult &result,
                                  const double accuracy,
                                  const std::function<bool()> &keep_going)
  {
    const KinematicResult motion = kinematic(reduced_scene.scene, *reduced_scene.strain, 0.5 * accuracy, keep_going);
    space_panels_                = motion.space_panels;
    time_panels_                 = motion.time_panels;
    if (motion.stopped)
    {
      result.time.status = Status::stopped;
      return;
    }
    result.stretch.min = stretch_of(motion.extremes.smallest);
    result.stretch.max = stretch_of(motion.extremes.largest);
    if (motion.inversion)
    {
      result.time.status = Status::inverted;
      result.inversion   = Inversion{stretch_of(*motion.inversion)};
      result.energy_balance.reset();
      return;
    }
    const ModelErrors errors      = reduced_scene.model_errors();
    result.displacement           = motion.displacement;
    result.error                  = {.space = motion.space_error,
                                     .time  = motion.time_error,
                                     .model = errors.known ? errors.kinematic : DisplacementError::unknown};
    result.energy_balance         = motion.energies;
    result.residuals.net_friction = motion.net_friction;
  }

  /// Fails the result unless its error is as small as requested.
  void
  ReducedModel::judge(SimulationResult &result, const double accuracy) const
  {
    constexpr double floor   = 1e-12;
    DisplacementError &error = *result.error;
    error.total              = error.space + error.time + error.model;
    if (error.total <= std::max(accuracy * std::abs(result.displacement), floor))
      return;
    result.time.status = Status::failed;
    result.time.reason = "accuracy_not_met";
    const std::string relative =
      result.displacement == 0. ? "" : fmt::format(" ({:.2g} of it)", error.total / std::abs(result.displacement));
    result.time.message =
      std::isfinite(error.total)
        ? fmt::format(
            "the estimated error of the displacement is {:.3g}{}, but Accuracy is {:g}; a larger one, or Model "
            "= auto, is needed",
            error.total * reduced_scene.units.length,
            relative,
            accuracy)
        : fmt::format("the error of the {} model cannot be estimated for this scene, since its corrections do not "
                      "decrease, or its strain is not 0 at t = 0; Model = auto is needed",
                      word_of(model_));
  }

  SimulationResult
  ReducedModel::compute(const double accuracy,
                        const bool energy_balance,
                        const std::function<bool()> &keep_going,
                        const bool gait)
  {
    const Stopwatch watch;
    SimulationResult result;
    result.process.model = model_;
    result.time.status   = Status::finished;
    if (model_ == Model::perturbation)
      compute_perturbation(result);
    else
      compute_kinematic(result, accuracy, keep_going);
    if (result.error)
      judge(result, accuracy);

    const bool is_complete = result.time.status != Status::stopped && !result.inversion;
    result.time.time       = is_complete ? 1. : result.inversion ? result.inversion->t : 0.;
    if (!energy_balance)
      result.energy_balance.reset();
    result = in_user_units(std::move(result), scene_, reduced_scene.units);
    set_error_of_efficiency("gait.efficiency", result.gait_efficiency, result);
    if (result.inversion)
    {
      const double s      = result.inversion->s;
      result.time.reason  = s == 0. || s == scene_.body.length ? "inverted_at_end" : "inverted_inside";
      result.time.message = fmt::format("the strain that the kinematic model assumes gives the stretch {:.3g} at s = "
                                        "{:.6g}, t = {:.6g}; Model = nonlinear is needed",
                                        result.inversion->value,
                                        s,
                                        result.inversion->t);
    }
    result.process.seconds.solve = watch.seconds();
    if (gait)
      describe_gait(result);
    return result;
  }

  void
  ReducedModel::replay(const std::vector<double> &times,
                       const std::vector<double> &points,
                       const std::function<bool(double time, const State &state)> &see) const
  {
    const bool is_series = model_ == Model::perturbation; // of the body only the extremes count
    KinematicBody body(
      reduced_scene.scene, *reduced_scene.strain, is_series ? std::vector<double>{0., 0.5, 1.} : space_panels_, points);
    State state;
    state.energy_balance.initial_energy = body.evaluate(0.).sums.elastic_energy;
    double before                       = times.empty() ? 0. : times.front();
    for (const double t : times)
    {
      if (!is_series)
        for (auto end = std::ranges::upper_bound(time_panels_, before); before < t; ++end)
        {
          const double next = end == time_panels_.end() ? t : std::min(*end, t);
          state.displacement += advance(body, before, next, state.energy_balance);
          before = next;
        }
      const auto &now = body.evaluate(t);
      state.stretch   = {{1. + now.smallest.strain, now.smallest.s}, {1. + now.largest.strain, now.largest.s}};
      if (is_series)
      {
        const NaturalWave &wave = *reduced_scene.wave;
        state.displacement      = perturbation::displacement(wave, t);
        state.velocity          = perturbation::velocity(wave, t);
        state.energy_balance    = perturbation::energies(wave, t);
        state.fields            = perturbation::fields(wave, t, points);
      }
      else
      {
        state.energy_balance.elastic_energy = now.sums.elastic_energy;
        state.velocity                      = now.sums.velocity;
        state.net_friction                  = now.sums.net_friction;
        state.fields                        = body.fields(state.displacement);
      }
      if (!see(t, state))
        return;
    }
  }

  void
  ReducedModel::describe_gait(SimulationResult &result) const
  {
    const auto period = stride_of(*reduced_scene.scene.active_stress, 1.);
    if (result.time.status != Status::finished || !period)
      return;
    GaitMeter meter(*period, false);
    replay(meter.times(), equal_parts(0., 1., GaitMeter::n_pieces), [&](const double t, const State &state) {
      meter.see(state.fields.displacement, state.displacement);
      meter.see_extremes(result.stretch.min.value, result.stretch.max.value); // extremes of the whole motion
      meter.see_extremes(state.stretch.min.value, state.stretch.max.value);
      meter.see_step(t, state.displacement, state.energy_balance);
      return true;
    });
    if (const auto gait = meter.gait())
    {
      result.gait = gait->in_units(reduced_scene.units);
      set_efficiencies(scene_, result);
      set_error_of_efficiency("gait.stride_efficiency", result.gait->efficiency, result);
    }
  }

  std::string
  ReducedModel::description() const
  {
    if (model_ == Model::perturbation)
      return "No mesh and no time steps: the series is a closed form.";
    return fmt::format("No mesh and no time steps: quadrature on {} panels in s and {} in t, of {} points each.",
                       space_panels_.size() - 1,
                       time_panels_.size() - 1,
                       GaussPanels::n_points);
  }
} // namespace crawler
