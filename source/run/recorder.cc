// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/gait_efficiency.h>
#include <crawler/run/recorder.h>
#include <crawler/scene/scene.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace crawler
{
  namespace
  {
    /// Difference, in units of the duration, below which two times are the same.
    constexpr double same_time = 1e-12;
    /// Margin within which extremes may be beaten between times.
    constexpr double near = 0.2;
  } // namespace

  Recorder::Recorder(
    const Scene &scene, const Units &units, const RecordOptions &options, const double tolerance, const bool may_search)
    : scene_(scene)
    , units_(units)
  {
    if (options.energy_balance)
      result.energy_balance.emplace();
    if (options.cycles)
      if (const CycleWish wish = options.cycles->in_units(units.time); CycleStop::fits(wish))
        cycle_stop_.emplace(wish, tolerance);
    if (options.gait == GaitWish::none)
      return;
    const auto period = stride_of(*scene.active_stress, units.time);
    if (period || (options.gait == GaitWish::any && may_search))
      gait_meter_.emplace(period, cycle_stop_.has_value());
  }

  void
  Recorder::set_smallest_cell(const double size)
  {
    sudden_changes_.emplace(scene_, units_, size);
  }

  bool
  Recorder::keeps_stretch_inside(const double time)
  {
    return sudden_changes_ && sudden_changes_->keeps_stretch_inside(time);
  }

  std::vector<double>
  Recorder::step_ends() const
  {
    std::vector<double> times;
    if (cycle_stop_)
      times = cycle_stop_->ends();
    const auto start = gait_meter_ ? gait_meter_->stride_start() : std::nullopt;
    if (start)
      times.insert(std::lower_bound(times.begin(), times.end(), *start), *start);
    return times;
  }

  double
  Recorder::next_sample() const
  {
    return std::min(gait_meter_ ? gait_meter_->next_time() : HUGE_VAL,
                    cycle_stop_ ? cycle_stop_->next_time() : HUGE_VAL);
  }

  /// Compares with the end of the body, where the stretch is known: beyond it one may think the cells of the body
  /// mirrored, with the opposite error.
  void
  Recorder::compare_with_end(Extreme &now, const ExtremeHistory &history)
  {
    if (!sudden_changes_ || !history.is_beyond(now.value, 1. + (1. - near) * (history.extreme().value - 1.)))
      return;
    if (const auto known = sudden_changes_->stretch_at_end(now.s, now.t))
      now.jump = std::max(now.jump, 2. * std::abs(now.value - *known));
  }

  void
  Recorder::see_stretch(Extreme smallest, Extreme largest)
  {
    if (started_)
    {
      const auto known = sudden_changes_ ? sudden_changes_->extremes_if_thin(smallest.t) : std::nullopt;
      if (known)
        std::tie(smallest, largest) = *known;
      else
      {
        compare_with_end(smallest, smallest_);
        compare_with_end(largest, largest_);
      }
      if (known || were_known_)
      {
        smallest_.add_alone(smallest);
        largest_.add_alone(largest);
      }
      else
      {
        smallest_.add(smallest);
        largest_.add(largest);
      }
      were_known_ = known.has_value();
    }
    else
    {
      smallest_.start(smallest);
      largest_.start(largest);
    }
    started_           = true;
    result.stretch.min = smallest_.extreme();
    result.stretch.max = largest_.extreme();
  }

  void
  Recorder::interrupt()
  {
    smallest_.interrupt();
    largest_.interrupt();
  }

  bool
  Recorder::see_step(
    const double time, const bool is_step_end, const double smallest, const double largest, const Sampler &sample)
  {
    if (gait_meter_)
    {
      for (double next = gait_meter_->next_time(); next <= time + same_time; next = gait_meter_->next_time())
      {
        const BodySample body = sample(next >= time - same_time ? time : next);
        gait_meter_->see(body.u, body.displacement);
      }
      gait_meter_->see_extremes(smallest, largest);
      if (gait_meter_->keeps_step(time))
        gait_meter_->see_step(time, sample(time).displacement, result.energy_balance);
    }
    return cycle_stop_ && see_cycles(time, is_step_end, sample);
  }

  /// Observes the phases of a cycle that a step has passed. The ends of cycles are ends of steps.
  bool
  Recorder::see_cycles(const double time, const bool is_step_end, const Sampler &sample)
  {
    const auto see = [&](const double t) {
      const double extremes[] = {result.stretch.min.value, result.stretch.max.value};
      std::array<double, 2> friction{};
      scene_.friction->values(extremes, friction);
      const double friction_unit = units_.force * units_.time / (units_.length * units_.length);
      const BodySample body      = sample(t);
      return cycle_stop_->observe(body.u,
                                  body.displacement,
                                  result.energy_balance,
                                  scene_.body.elastic_modulus / units_.force /
                                    (std::max(friction[0], friction[1]) / friction_unit));
    };
    while (!cycle_stop_->next_is_end() && cycle_stop_->next_time() <= time)
      see(cycle_stop_->next_time());
    return is_step_end && cycle_stop_->next_is_end() && std::abs(cycle_stop_->next_time() - time) < same_time &&
           see(time);
  }

  SimulationResult
  Recorder::finish()
  {
    if (cycles_repeat())
    {
      result.time.status = Status::finished;
      result.cycles      = cycle_stop_->extrapolate(result.displacement, result.energy_balance);
    }
    if (gait_meter_ && result.time.status == Status::finished)
      result.gait = gait_meter_->gait();
    return in_user_units(std::move(result), scene_, units_);
  }

  void
  Recorder::exchange(Archive &archive)
  {
    archive.require_same(cycle_stop_.has_value(), "the cycle stop");
    archive.require_same(gait_meter_.has_value(), "the gait meter");
    archive(result, smallest_, largest_, started_, friction_impulse_, net_impulse_, were_known_);
    if (cycle_stop_)
      archive(*cycle_stop_);
    if (gait_meter_)
      archive(*gait_meter_);
  }

  SimulationResult
  in_user_units(SimulationResult result, const Scene &scene, const Units &units)
  {
    const auto scale = [&units](Extreme &extreme) {
      extreme.s *= units.length;
      extreme.t *= units.time;
    };
    result.time.time = result.time.status == Status::finished ? scene.end_time : result.time.time * units.time;
    result.time.step_size *= units.time;
    SolutionSize &size = result.size;
    for (double *length : {&result.displacement,
                           &size.largest_u,
                           &size.last_u,
                           &size.strain,
                           &size.highest_mode,
                           &size.largest_indicator})
      *length *= units.length;
    if (result.error)
      for (double *part : {&result.error->total, &result.error->space, &result.error->time, &result.error->model})
        *part *= units.length;
    if (result.energy_balance)
      result.energy_balance = result.energy_balance->scaled(units.energy());
    scale(result.stretch.min);
    scale(result.stretch.max);
    if (result.inversion)
      scale(*result.inversion);
    if (result.inversion && result.inversion->places)
      for (double *place : {&result.inversion->places->first, &result.inversion->places->second})
        *place *= units.length;
    if (result.cycles)
    {
      result.cycles->period *= units.time;
      result.cycles->bound *= units.length;
    }
    if (result.gait)
      result.gait = result.gait->in_units(units);
    set_efficiencies(scene, result);
    return result;
  }
} // namespace crawler
