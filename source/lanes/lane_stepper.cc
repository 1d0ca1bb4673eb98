// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/lanes/lane_stepper.h>
#include <crawler/time/radau_loops.h>
#include <crawler/time/radau_tableau.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace crawler
{
  namespace
  {
    /// Outcome, without a status, of a body that has come so far.
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
  } // namespace

  LaneStepper::LaneStepper(const Scene &scene, const LaneMethod &method)
    : scene_(scene)
    , tables_(lane_tables(method))
    , setup_(tables_->setup)
    , tableau_(radau_tableau(method.n_stages))
    , stress_(scene.active_stress->at(tables_->points))
  {
    if (method.is_stretch)
    {
      setup_.stretch   = stretch_method(scene, method.other_rule);
      setup_.direction = scene.ground.direction;
      if (!scene.is_plain())
        cell_laws_.emplace(scene, tables_->points);
    }
    else if (!scene.is_plain())
      laws_.emplace(scene, tables_->points);
    memory_.resize(single_engine().memory(setup_));
    for (unsigned int i = 0; i < tableau_.n; ++i)
      stage_places_.push_back(tableau_.c[i]);
  }

  void
  LaneStepper::begin(const ConstVector y, const Course &course)
  {
    course_ = course;
    y_.assign(y.begin(), y.end());
    if (goes_on_ && (old_z_.size() != tableau_.n * y_.size() || progress_.output_time >= course_.ends.size()))
      throw FileError("a saved state does not match the program: its last step is from another run");
    job_ = {.k         = scene_.body.elastic_modulus,
            .a         = scene_.body.friction_exponent(),
            .tolerance = course_.tolerance,
            // Errors of the stretch are, on a stiff body, k times as large in the forces.
            .newton_factor = setup_.is_stretch ? std::min(1., 10. / scene_.body.elastic_modulus) : 1.,
            .initial_step  = course_.initial_step,
            .limits        = course_.limits.data(),
            .n_limits      = static_cast<unsigned int>(course_.limits.size()),
            .max_steps     = std::numeric_limits<unsigned int>::max(), // the caller of the next step decides
            // Empty cells are admitted where friction then holds them.
            .least_stretch  = setup_.is_stretch && scene_.friction_exponent() < 0. ? -HUGE_VAL : 0.,
            .is_last_resort = setup_.is_stretch,
            .start_time     = course_.start,
            .start          = y_.data(),
            .output_times   = course_.ends.data(),
            .n_output_times = static_cast<unsigned int>(course_.ends.size()),
            .restarts       = nullptr, // each piece has a course of its own
            .progress       = goes_on_ ? &progress_ : nullptr,
            .old_z          = goes_on_ ? old_z_.data() : nullptr};
    if (laws_)
      laws_->set(job_);
    if (!goes_on_)
      progress_ = {.t = course_.start, .next = course_.initial_step};
    started_ = goes_on_ = false;
    bad_friction_.reset();
    lane_step_ = {};
    end_.reset();
    single_engine().start(setup_, *this, memory_.data());
  }

  const Step *
  LaneStepper::next()
  {
    has_step_ = false;
    while (!has_step_ && !end_)
      single_engine().advance(setup_, memory_.data());
    return has_step_ ? &step_ : nullptr;
  }

  TimeOutcome
  LaneStepper::outcome()
  {
    return end_ ? *end_ : outcome_at(progress_);
  }

  bool
  LaneStepper::take(unsigned int, LaneJob &job)
  {
    job = job_;
    return !std::exchange(started_, true);
  }

  void
  LaneStepper::stress(unsigned int, const double t, double *m)
  {
    stress_->values(t, {m, tables_->points.size()});
  }

  bool
  LaneStepper::laws(unsigned int, const LanePoints &points)
  {
    return laws_->evaluate(points);
  }

  double
  LaneStepper::cell_laws(
    const double t, const double *m, const double *w, const double *rate, CellLaws<double> &at_cells)
  {
    const std::size_t n = tables_->points.size();
    const long bad      = cell_laws_->evaluate(t, {w, n}, {rate, n}, m);
    // Power laws fail only where the stretch is lost.
    if (bad >= 0 && w[bad] > 0. && !scene_.friction->is_power_law)
      bad_friction_ = {w[bad], cell_laws_->friction[static_cast<std::size_t>(bad)]};
    at_cells                = cell_laws_->at_cells();
    const bool may_be_empty = scene_.friction_exponent() < 0.;
    return bad >= 0 ? -1. : may_be_empty ? 1. : *std::min_element(w, w + n);
  }

  bool
  LaneStepper::accepted(unsigned int, const LaneStep &step)
  {
    lane_step_ = step;
    progress_  = *step.progress;
    step_      = {step.time, step.size, progress_.steps, step.is_output_time, progress_.rejected, progress_.newton};
    has_step_  = true;
    std::copy_n(step.y, y_.size(), y_.begin());
    if (stage_rates)
      show_rates();
    return true;
  }

  void
  LaneStepper::done(unsigned int, const LaneOutcome &outcome)
  {
    end_         = outcome_at(*outcome.progress);
    end_->status = outcome.status == LaneOutcome::finished ? Status::finished : Status::failed;
    end_->reason = outcome.status == LaneOutcome::gave_up ? gave_up : "";
  }

  bool
  LaneStepper::exchange(Archive &archive)
  {
    if (!archive.reads())
      old_z_.assign(lane_step_.z, lane_step_.z + tableau_.n * y_.size());
    archive(progress_, old_z_);
    goes_on_ = archive.reads();
    return true;
  }

  void
  LaneStepper::show_rates()
  {
    rate_.resize(y_.size());
    for (unsigned int i = 0; i < tableau_.n; ++i)
    {
      radau::stage_rate(static_cast<int>(tableau_.n),
                        tableau_.inverse.data(),
                        static_cast<int>(i),
                        1. / lane_step_.size,
                        lane_step_.z,
                        static_cast<int>(rate_.size()),
                        rate_.data());
      stage_rates(lane_step_.time - (1. - tableau_.c[i]) * lane_step_.size, rate_);
    }
  }

  void
  LaneStepper::interpolate(const double time, const Vector y)
  {
    state_within(lane_step_, setup_, time, y);
  }
} // namespace crawler
