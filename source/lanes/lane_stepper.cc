// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/lanes/lane_stepper.h>
#include <crawler/time/radau_loops.h>
#include <crawler/time/radau_tableau.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  LaneStepper::LaneStepper(const Scene &scene, const LaneMethod &method)
    : scene_(scene)
    , tables_owner_(lane_tables(method))
    , tables_(*tables_owner_)
    , setup_(tables_.setup)
    , tableau_(radau_tableau(method.n_stages))
    , stress_(scene.active_stress->at(tables_.points))
  {
    if (method.is_stretch)
    {
      const StretchMethod stretch = stretch_method(scene, method.other_rule);
      setup_.node_rule            = stretch.node_rule;
      setup_.is_power             = stretch.is_power;
      setup_.backward_ratio       = scene.ground.direction.ratio;
      setup_.switching_velocity   = scene.ground.direction.switching_velocity;
      if (!scene.is_plain())
        cell_laws_.emplace(scene, tables_.points);
    }
    else if (!scene.is_plain())
      laws_.emplace(scene, tables_.points);
    memory_ = lane_storage(single_engine().memory(setup_));
    for (unsigned int i = 0; i < tableau_.n; ++i)
      stage_places_.push_back(tableau_.c[i]);
  }

  TimeOutcome
  LaneStepper::solve(std::vector<double> &y,
                     const std::vector<double> &output_times,
                     const double tolerance,
                     const double initial_step,
                     const std::span<const StepLimit> limits,
                     const double start_time)
  {
    constexpr double end_time = 1.;
    output_times_             = output_times;
    if (output_times_.empty() || output_times_.back() < end_time)
      output_times_.push_back(end_time);
    job_                = {.k         = scene_.body.elastic_modulus,
                           .a         = scene_.body.friction_exponent(),
                           .tolerance = tolerance,
                           // On a stiff body an error of the stretch is one of the forces, k times as large.
                           .newton_factor = setup_.is_stretch ? std::min(1., 10. / scene_.body.elastic_modulus) : 1.,
                           .initial_step  = initial_step,
                           .limits        = limits.data(),
                           .n_limits      = static_cast<unsigned int>(limits.size()),
                           .most_steps    = std::numeric_limits<unsigned int>::max(), // the monitor's business
                           // Cells may be empty where friction then holds them.
                           .least_stretch  = setup_.is_stretch && scene_.friction_exponent() < 0. ? -HUGE_VAL : 0.,
                           .is_last_resort = setup_.is_stretch,
                           .start_time     = start_time,
                           .start          = y.data(),
                           .output_times   = output_times_.data(),
                           .n_output_times = static_cast<unsigned int>(output_times_.size()),
                           .restarts       = nullptr, // a solve for each piece
                           .progress       = goes_on_ ? &progress_ : nullptr,
                           .old_z          = goes_on_ ? old_z_.data() : nullptr};
    const bool is_first = !goes_on_;
    goes_on_            = false;
    if (laws_)
      laws_->set(job_);
    started_ = false;
    bad_friction_.reset();
    y_       = &y;
    outcome_ = {};
    if (is_first && monitor && !monitor({start_time, 0., 0, false, 0, 0}, y))
    {
      outcome_.status    = Status::stopped;
      outcome_.time      = start_time;
      outcome_.step_size = initial_step;
      return outcome_;
    }
    const LaneHost host = {this, next, stress, accepted, done, looks_inside_, laws, cell_laws_ ? cell_laws : nullptr};
    single_engine().run(setup_, host, memory_.get());
    return outcome_;
  }

  bool
  LaneStepper::next(void *context, unsigned int, LaneJob &job)
  {
    auto &self         = *static_cast<LaneStepper *>(context);
    const bool is_next = !self.started_;
    self.started_      = true;
    job                = self.job_;
    return is_next;
  }

  void
  LaneStepper::stress(void *context, unsigned int, const double t, double *m)
  {
    auto &self = *static_cast<LaneStepper *>(context);
    self.stress_->values(t, {m, self.tables_.points.size()});
  }

  bool
  LaneStepper::laws(void *context, unsigned int, const LanePoints &points)
  {
    return static_cast<LaneStepper *>(context)->laws_->evaluate(points);
  }

  LaneCellLaws
  LaneStepper::cell_laws(void *context, const double t, const double *m, const double *w, const double *rate)
  {
    auto &self          = *static_cast<LaneStepper *>(context);
    StretchLaws &laws   = *self.cell_laws_;
    const std::size_t n = self.tables_.points.size();
    const long bad      = laws.evaluate(t, {w, n}, {rate, n}, m);
    // A power law fails only where the stretch is lost.
    if (bad >= 0 && w[bad] > 0. && !self.scene_.has_power_law())
      self.bad_friction_ = {w[bad], laws.friction[static_cast<std::size_t>(bad)]};
    const bool may_be_empty        = self.scene_.friction_exponent() < 0.;
    const BodyForceAtPoints &force = laws.force();
    return {laws.mobility.data(),
            laws.mobility_by_w.data(),
            force.N.data(),
            force.by_w.data(),
            force.by_rate.data(),
            bad >= 0       ? -1.
            : may_be_empty ? 1.
                           : *std::min_element(w, w + n)};
  }

  bool
  LaneStepper::accepted(void *context, unsigned int, const LaneStep &step)
  {
    auto &self = *static_cast<LaneStepper *>(context);
    self.step_ = step;
    std::copy_n(step.y, self.y_->size(), self.y_->begin());
    if (self.stage_rates)
      self.show_rates();
    return !self.monitor ||
           self.monitor({step.time, step.size, step.number, step.is_output_time, step.rejected, step.newton_iterations},
                        *self.y_);
  }

  void
  LaneStepper::done(void *context, unsigned int, const LaneOutcome &outcome)
  {
    auto &self                      = *static_cast<LaneStepper *>(context);
    self.outcome_.status            = outcome.status == LaneOutcome::finished  ? Status::finished
                                      : outcome.status == LaneOutcome::stopped ? Status::stopped
                                                                               : Status::failed;
    self.outcome_.reason            = outcome.status == LaneOutcome::gave_up ? gave_up : "";
    self.outcome_.time              = outcome.time;
    self.outcome_.step_size         = outcome.step_size;
    self.outcome_.steps             = outcome.steps;
    self.outcome_.rejected_steps    = outcome.rejected;
    self.outcome_.newton_iterations = outcome.newton_iterations;
  }

  bool
  LaneStepper::exchange(Archive &archive)
  {
    if (!archive.reads())
    {
      progress_ = *step_.progress;
      old_z_.assign(step_.z, step_.z + tableau_.n * y_->size());
    }
    archive(progress_, old_z_);
    goes_on_ = archive.reads();
    return true;
  }

  void
  LaneStepper::show_rates()
  {
    rate_.resize(y_->size());
    for (unsigned int i = 0; i < tableau_.n; ++i)
    {
      radau::stage_rate(static_cast<int>(tableau_.n),
                        tableau_.inverse.data(),
                        static_cast<int>(i),
                        1. / step_.size,
                        step_.z,
                        static_cast<int>(rate_.size()),
                        rate_.data());
      stage_rates(step_.time - (1. - tableau_.c[i]) * step_.size, rate_);
    }
  }

  void
  LaneStepper::interpolate(const double time, const Vector y)
  {
    state_within(step_, setup_, time, y);
  }
} // namespace crawler
