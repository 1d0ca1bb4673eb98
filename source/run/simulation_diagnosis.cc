// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Part of Simulation that names a lost stretch or a failed time step (doc/numerics.md, "Failures and inversions").
#include <crawler/base/bracketed_root.h>
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/run/simulation.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Stretch of the position form below which it is lost: numbers computed from it have no correct digit.
    constexpr double lost_in_position = 1e-12;
    /// Time, as a part of the duration, within which an end that inverts after the inside was lost is the cause.
    constexpr double end_reach = 1e-6;
    /// Counterpart for a stretch lost at the very end, where the body's own is exactly 1 - m/k.
    constexpr double end_reach_at_end = 1e-3;
    /// Time, as a part of the duration, within which a stretch must vanish at its present rate to be lost, if states
    /// are refused.
    constexpr double nearly_lost = 1e-4;

    /**
     * Floor of the stretch form: cells may be empty if they then stick, a <= -1. For -1 < a < 0 w^(1+a) goes linearly
     * to 0 near an inversion, and the floor is where 1e-6 of it is left.
     */
    double
    lost_in_stretch_form(const double a)
    {
      return a <= -1. ? -HUGE_VAL : a < 0. ? std::exp(std::clamp(-14. / (1. + a), -690., std::log(1e-3))) : 1e-9;
    }

    /// Root in [from, to] of @p function, which is positive at @p from and not at @p to.
    template <typename Function>
    double
    first_zero(const Function &function, const double from, const double to)
    {
      if (!(function(from) > 0.))
        return from;
      return function(to) < 0. ? bracketed_root(function, from, to) : to;
    }
  } // namespace

  /// Stretch at or below which it is lost.
  double
  Simulation::lost_stretch() const
  {
    return mesh_.position != nullptr ? lost_in_position : lost_in_stretch_form(scene_.friction_exponent());
  }

  /// True if the stretch of the end conditions (EndStretches) has become 0 since @p from; sets the diagnosis then.
  bool
  Simulation::end_inverts(const double from, const double to)
  {
    constexpr int parts = 4;
    EndStretches &ends  = mesh_.assembler->ends;
    const auto smallest = [&ends](const double t) { return ends.smallest(t); };
    if (!ends.are_known())
      return false;
    double begin = from;
    for (int i = from < to ? 1 : parts; i <= parts; ++i)
    {
      const double end = i == parts ? to : from + (to - from) * i / parts;
      if (!(smallest(end) <= 0.))
      {
        begin = end;
        continue;
      }
      const double t           = begin < end ? first_zero(smallest, begin, end) : end;
      const auto [left, right] = ends.at(t);
      const double s           = left <= right ? 0. : 1.;
      inverted_at_end(s,
                      t,
                      scene_.active_stress->feedback() == nullptr ? "where 1 - m/k is not positive"
                                                                  : "where no stretch balances the feedback");
      return true;
    }
    return false;
  }

  void
  Simulation::inverted_at_end(const double s, const double t, const std::string &reason)
  {
    result().inversion = Inversion{{0., s, t}};
    run_->diagnosis    = {Status::inverted,
                          "inverted_at_end",
                          fmt::format("the body inverted: its stretch reached 0 at the end s = {:.6g} at t = {:.9g}, {}; "
                                      "the model ends there",
                                   s * units_.length,
                                   t * units_.time,
                                   reason)};
  }

  /// Finds place and time, on the integrator's dense output, of the loss of a stretch inside within the step.
  void
  Simulation::locate_inversion(const Step &step)
  {
    const double threshold = lost_stretch();
    std::vector<double> y(mesh_.discretization->n_owned());
    StretchAt smallest = run_->state.stretch.min;
    const auto above   = [&](const double t) {
      integrators_.present->interpolate(t, y);
      smallest = mesh_.assembler->stretch_range(y).min;
      return smallest.value - threshold;
    };
    double t = step.time;
    if (step.size > 0.)
      t = first_zero(above, step.time - step.size, step.time);
    if (step.size > 0.)
      above(t); // finds the smallest stretch of that time
    const bool at_end  = smallest.s == 0. || smallest.s == 1.;
    const double reach = at_end ? end_reach_at_end : end_reach;
    if (at_end && !mesh_.assembler->ends.are_known())
      inverted_at_end(smallest.s, t, "where the active stress with its feedback is not below k");
    else if (!end_inverts(t, std::min(t + reach, 1.)))
    {
      inverted_inside(run_->state.stretch.min.value, smallest.s, t);
      if (result().inversion && mesh_.stretch != nullptr)
      {
        // Disturbances travel at unbounded speed there, so all these places are lost at once.
        constexpr double at_once = 1e-6;
        integrators_.present->interpolate(t, y);
        const auto [first, last]   = mesh_.stretch->lost_places(t, y, at_once);
        result().inversion->places = {std::min(first, smallest.s), std::max(last, smallest.s)};
      }
    }
  }

  /// True if the active stress has failed since the run began, on any rank (collective); sets the diagnosis then.
  bool
  Simulation::stress_failed()
  {
    const StressFailures *failures = scene_.active_stress->failures();
    if (failures == nullptr) // null on all ranks
      return false;
    const std::string message = first_text(failures->count > run_->n_failures ? failures->latest : "", communicator_);
    if (message.empty())
      return false;
    run_->diagnosis = {Status::failed, "nonfinite", message};
    return true;
  }

  /// True on all ranks if a law was not positive on one of them.
  bool
  Simulation::law_failed()
  {
    const auto bad         = mesh_.assembler->bad_law(units_);
    const std::string text = first_text(bad ? bad->entry + "\n" + bad->message : "", communicator_);
    if (text.empty())
      return false;
    const auto end  = text.find('\n');
    run_->diagnosis = {
      Status::failed,
      "law_not_positive",
      fmt::format(
        "{}: {}; at t = {:.6g}", text.substr(0, end), text.substr(end + 1), run_->accepted.time * units_.time)};
    return true;
  }

  /// Explains a failure of the time stepper.
  void
  Simulation::explain_failure()
  {
    if (stress_failed())
      return;
    TimeOutcome &outcome = result().time;
    const double t       = run_->accepted.time;
    if (outcome.domain_error && law_failed())
      return;
    // Tiny steps may mark the end of the model.
    const double reach = std::max(end_reach, 2. * outcome.step_size);
    if (outcome.reason != "petsc_error")
    {
      if (end_inverts(t, std::min(t + reach, 1.)))
        return;
      // Time left at the present rate.
      const StretchAt smallest = mesh_.assembler->stretch_range(run_->accepted.y).min;
      const Extreme before     = run_->recorder.smallest_before_last();
      const double rate        = t > before.t ? (before.value - smallest.value) / (t - before.t) : 0.;
      const double left        = rate > 0. ? std::max(smallest.value, 0.) / rate : 1.;
      // Stretch reaches 0 at a bounded rate for a >= 0, so one that is not near 0 was not lost by the body.
      const bool near = left < (outcome.domain_error ? nearly_lost : end_reach);
      if (near || (outcome.domain_error && scene_.friction_exponent() < 0.))
      {
        inverted_inside(smallest.value, smallest.s, std::min(t + (near ? left : 0.), 1.));
        return;
      }
    }
    outcome.message +=
      fmt::format(", at t = {:.9g} with step size {:.3g}", outcome.time * units_.time, outcome.step_size * units_.time);
  }

  /**
   * Names a loss of stretch inside. For a <= -1 it stays positive as long as the ends do (doc/theory.md, "When a body
   * can invert"), so the loss is called an error of the mesh. For -1 < a < 0 bodies do invert, but the position form
   * loses the stretch too early, or without need. Nor can a body invert inside as soon as
   * it starts.
   */
  void
  Simulation::inverted_inside(const double value, const double s, const double t)
  {
    const double a     = scene_.friction_exponent();
    const bool is_thin = run_->recorder.keeps_stretch_inside(t);
    if (is_thin || a <= -1. || (a < 0. && mesh_.position != nullptr))
      run_->diagnosis = {
        Status::failed,
        "under_resolved",
        fmt::format("the computed stretch reached {:.3g} at s = {:.6g}, t = {:.6g}, {}: {} cells of degree {} "
                    "are too coarse, or the steps too long; {}a larger Discretization/Number of cells or a smaller "
                    "Time/Tolerance is needed",
                    value,
                    s * units_.length,
                    t * units_.time,
                    is_thin    ? "so soon after a sudden change that the body itself stays uninverted"
                    : a <= -1. ? "where the body itself stays uninverted (a <= -1)"
                               : "for which only the stretch form is trusted at a < 0",
                    mesh_.discretization->n_cells(),
                    mesh_.discretization->element.degree,
                    mesh_.position != nullptr ? "Discretization/Formulation = stretch, or " : "")};
    else
    {
      result().inversion = Inversion{{std::min(value, 0.), s, t}};
      run_->diagnosis    = {Status::inverted,
                            "inverted_inside",
                            fmt::format("the body inverted: its stretch reached 0 at s = {:.6g}, t = {:.9g}; the model "
                                        "ends there",
                                     s * units_.length,
                                     t * units_.time)};
    }
  }
} // namespace crawler
