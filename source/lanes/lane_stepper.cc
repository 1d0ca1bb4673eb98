// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/lanes/lane_stepper.h>
#include <crawler/time/radau_loops.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  TimeOutcome
  outcome_at(const LaneProgress &progress)
  {
    TimeOutcome outcome;
    outcome.time              = progress.t;
    outcome.step_size         = progress.next;
    outcome.steps             = progress.steps;
    outcome.rejected_steps    = progress.rejected;
    outcome.newton_iterations = progress.newton;
    return outcome;
  }

  LaneStepper::LaneStepper(const Scene &scene, const LaneMethod &method)
    : scene_(scene)
    , tables_(lane_tables(method))
    , setup_(tables_->setup)
    , stress_(scene.active_stress->at(tables_->points))
  {
    if (method.is_stretch)
    {
      setup_.stretch   = stretch_method(scene, method.other_rule);
      setup_.direction = scene.ground.direction;
      // Errors of the stretch are, on a stiff body, k times as large in the forces.
      setup_.method.newton_fraction *= std::min(1., 10. / scene.body.elastic_modulus);
      if (!scene.is_plain())
        cell_laws_.emplace(scene, tables_->points);
    }
    else if (!scene.is_plain())
      laws_.emplace(scene, tables_->points);
    memory_.resize(single_engine().memory(setup_));
    stage_places_.assign(setup_.method.c, setup_.method.c + setup_.n_stages);
  }

  void
  LaneStepper::begin(const ConstVector y, const Course &course)
  {
    course_ = course;
    y_.assign(y.begin(), y.end());
    if (old_z_.empty())
      progress_ = {.t = course_.start, .next = course_.initial_step};
    else if (old_z_.size() != setup_.n_stages * y_.size() || progress_.output_time >= course_.ends.size())
      throw FileError("a saved state does not match the program: its last step is from another run");
    if (cell_laws_)
      cell_laws_->bad_friction.reset();
    lane_step_ = {};
    end_.reset();
    single_engine().start(setup_, *this, memory_.data());
  }

  const Step *
  LaneStepper::next()
  {
    step_.reset();
    while (!step_ && !end_)
      single_engine().advance(setup_, memory_.data());
    return step_ ? &*step_ : nullptr;
  }

  TimeOutcome
  LaneStepper::outcome()
  {
    return end_ ? *end_ : outcome_at(progress_);
  }

  bool
  LaneStepper::take(unsigned int, LaneJob &job)
  {
    if (end_)
      return false;
    job = {.body         = lane_body(scene_, laws_ ? &*laws_ : nullptr),
           .tolerance    = course_.tolerance,
           .initial_step = course_.initial_step,
           .limits       = course_.limits.data(),
           .n_limits     = static_cast<unsigned int>(course_.limits.size()),
           .max_steps    = std::numeric_limits<unsigned int>::max(), // the caller of the next step decides
           // Empty cells are admitted where friction then holds them.
           .least_stretch  = setup_.is_stretch && scene_.friction_exponent() < 0. ? -HUGE_VAL : 0.,
           .progress       = progress_,
           .start          = y_.data(),
           .old_z          = old_z_.empty() ? nullptr : old_z_.data(),
           .output_times   = course_.ends.data(),
           .n_output_times = static_cast<unsigned int>(course_.ends.size()),
           .restarts       = nullptr}; // each piece has a course of its own
    if (cell_laws_)
      job.body.host = &*cell_laws_;
    return true;
  }

  void
  LaneStepper::stress(unsigned int, const double t, double *m)
  {
    stress_->values(t, {m, tables_->points.size()});
  }

  bool
  LaneStepper::accepted(unsigned int, const LaneStep &step)
  {
    lane_step_ = step;
    progress_  = *step.progress;
    old_z_.clear();
    step_ = Step{step.time, step.size, progress_.steps, step.is_output_time, progress_.rejected, progress_.newton};
    std::copy_n(step.y, y_.size(), y_.begin());
    if (stage_rates)
      show_rates();
    return true;
  }

  void
  LaneStepper::done(unsigned int, const LaneOutcome &outcome)
  {
    old_z_.clear();
    end_         = outcome_at(*outcome.progress);
    end_->status = outcome.status == LaneOutcome::finished ? Status::finished : Status::failed;
    end_->reason = outcome.status == LaneOutcome::gave_up ? gave_up : "";
  }

  bool
  LaneStepper::exchange(Archive &archive)
  {
    std::vector<double> z;
    if (!archive.reads())
      z.assign(lane_step_.z, lane_step_.z + setup_.n_stages * y_.size());
    archive(progress_, z);
    if (archive.reads())
      old_z_ = z;
    return true;
  }

  void
  LaneStepper::show_rates()
  {
    std::vector<double> rate(y_.size());
    const int s = static_cast<int>(setup_.n_stages), n = static_cast<int>(rate.size());
    for (int i = 0; i < s; ++i)
    {
      radau::stage_rate(s, setup_.method.inverse, i, 1. / lane_step_.size, lane_step_.z, n, rate.data());
      stage_rates(lane_step_.time - (1. - setup_.method.c[i]) * lane_step_.size, rate);
    }
  }

  void
  LaneStepper::interpolate(const double time, const Vector y)
  {
    state_within(lane_step_, setup_, time, y);
  }
} // namespace crawler
