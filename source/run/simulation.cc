// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/equation/general_position_form.h>
#include <crawler/equation/mesh_transfer.h>
#include <crawler/run/gait_efficiency.h>
#include <crawler/run/simulation.h>
#include <crawler/time/failure.h>
#include <crawler/time/integrators.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace crawler
{
  namespace
  {
    /// So many steps in succession smaller than this part of the duration are a failure.
    constexpr double tiny_step             = 1e-9;
    constexpr unsigned int most_tiny_steps = 2000;
    /// So many of them at a stretch below this mean that it is lost: what is left of it is the error of Newton's
    /// method.
    constexpr unsigned int most_steps_at_zero = 20;
    constexpr double nearly_zero              = 1e-6;
    /// The step after a change of mesh that settle() makes is this times the root of the tolerance.
    constexpr double settling_factor = 0.01;
    /// Cells that come to rest faster than this, relative to the duration, turn round-off of the state into a velocity.
    constexpr double fast_relaxation = 1e-9;

    double
    now()
    {
      return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    }
  } // namespace

  Numerics
  in_units(Numerics numerics, const Units &units)
  {
    numerics.tolerance /= units.length;
    numerics.layer /= units.length;
    numerics.initial_step /= units.time;
    for (StepLimit &limit : numerics.step_limits)
      limit = {limit.from / units.time, limit.longest / units.time};
    numerics.least_event /= units.force;
    numerics.mesh.tolerance /= units.length;
    numerics.mesh.smallest_cell /= units.length;
    return numerics;
  }

  std::vector<double>
  first_cell_ends(const Scene &scene, const Numerics &numerics)
  {
    const double L             = scene.body.length;
    std::vector<double> breaks = scene.breaks_in_space();
    for (double &s : breaks)
      s /= L;
    if (numerics.layer > 0.)
      return layered_cell_ends(numerics.n_cells, numerics.parts, breaks, numerics.layer / L);
    return cell_ends(numerics.n_cells, breaks, numerics.grading);
  }

  Simulation::Simulation(MPI_Comm communicator,
                         const Scene &scene,
                         const TimeParameters &time,
                         const Numerics &numerics)
    : physical_scene_(scene)
    , units_(natural_units(scene))
    , pieces_(*scene.active_stress, scene.end_time)
    , scene_(crawler::in_units(scene, units_, &pieces_))
    , numerics_(in_units(numerics, units_))
    , time_(time)
    , communicator_(communicator)
  {
    time_.end_time = 1.;
    if (scene_.active_stress->feedback() != nullptr)
      delay_ = scene_.active_stress->feedback()->delay();
    if (time_.integrator == "automatic")
      time_.integrator = !numerics_.integrator.empty() ? numerics_.integrator : numerics_.linear ? "radau 5" : "bdf";
    build_first();
  }

  Simulation::~Simulation() = default;

  /// The mesh of the start.
  void
  Simulation::build_first()
  {
    std::vector<double> ends = first_cell_ends(scene_, numerics_);
    build(ends.empty() ? std::make_unique<Discretization>(communicator_, 1., numerics_.n_cells, numerics_.degree)
                       : std::make_unique<Discretization>(communicator_, std::move(ends), numerics_.degree));
    as_at_start_ = true;
  }

  /// The equation on a mesh.
  void
  Simulation::build(std::unique_ptr<Discretization> discretization)
  {
    as_at_start_ = false;
    stepper_     = nullptr;
    petsc_stepper_.reset();
    lane_stepper_.reset();
    linear_stepper_.reset();
    end_power_.reset();
    assembler_.reset();
    discretization_ = std::move(discretization);
    position_       = nullptr;
    stretch_form_   = nullptr;
    if (numerics_.formulation == Formulation::stretch)
    {
      auto form     = std::make_unique<StretchForm>(scene_, *discretization_, numerics_.other_rule);
      stretch_form_ = form.get();
      assembler_    = std::move(form);
    }
    else
    {
      auto form  = create_position_form(scene_, *discretization_);
      position_  = form.get();
      assembler_ = std::move(form);
      position_->keep_stresses(integrator(time_.integrator).n_stages);
    }
    if (delay_ > 0.)
    {
      assembler_->set_history(&history_);
      history_cells_ = std::make_shared<const std::vector<Cell>>(discretization_->cells());
    }
    rates_.assign(integrator(time_.integrator).n_stages + 1, {});
    // Of the highest mode of the smallest cell. Adaptive meshes have small cells where friction is large and slows them
    // down; there the largest one tells whether the body is stiff.
    const bool adaptive = numerics_.mesh.tolerance > 0.;
    double h            = adaptive ? 0. : 1.;
    for (const Cell &cell : discretization_->cells())
      h = adaptive ? std::max(h, cell.size) : std::min(h, cell.size);
    relaxation_time_ = h * h / (scene_.body.elastic_modulus * std::pow(discretization_->element().degree, 4.));
    y_.resize(assembler_->n_owned());
    v_.resize(discretization_->n_owned());
    ++mesh_number_;
    choose_stepper(); // options of PETSc are read now
  }

  SimulationResult
  Simulation::run(const std::vector<double> &output_times,
                  const Options &options,
                  const std::vector<std::unique_ptr<Observer>> &observers,
                  const std::function<bool()> &keep_going)
  {
    const double start = now();
    pieces_.restart();
    if (!as_at_start_)
      build_first();
    assembler_->forget_stresses(); // of the last piece
    options_              = options;
    has_observers_        = !observers.empty();
    result_               = {};
    result_.model         = numerics_.linear ? "linear" : "nonlinear";
    quadrature_           = {};
    diagnosis_            = {};
    largest_              = {};
    before_               = {};
    latest_               = {};
    output_times_         = output_times;
    next_output_time_     = 0;
    tiny_steps_           = 0;
    started_              = false;
    n_failures_           = scene_.active_stress->failures() != nullptr ? scene_.active_stress->failures()->count : 0;
    lanes_gave_up_        = false;
    integrals_            = {};
    largest_friction_     = 0.;
    largest_net_friction_ = 0.;
    result_.jumps_move    = numerics_.jumps_move;
    if (options.energy_balance)
      result_.energy_balance.emplace();
    result_.formulation = numerics_.formulation;
    history_.clear();
    assembler_->set_initial_state(y_);
    accepted_      = y_;
    accepted_time_ = 0.;
    next_step_     = numerics_.initial_step;
    step_limits_   = numerics_.step_limits;
    if (step_limits_.empty())
      step_limits_.push_back({0., std::numeric_limits<double>::infinity()});
    for (StepLimit &limit : step_limits_)
      if (delay_ > 0.)
        limit.longest = std::min(limit.longest, delay_);
    watch_.reset();
    if (numerics_.least_event > 0. && time_.step_control == "adaptive")
      watch_.emplace(*scene_.active_stress, 1., numerics_.least_event);

    cycle_stop_.reset();
    if (options.cycles && CycleStop::fits(options.cycles->period / units_.time))
    {
      if (!output_times.empty())
        throw std::logic_error("a run that may end when its cycles repeat has no frames");
      cycle_stop_.emplace(CycleWish{options.cycles->period / units_.time, options.cycles->accuracy},
                          numerics_.tolerance);
      for (const double time : cycle_stop_->ends())
        output_times_.push_back(time * units_.time);
    }

    gait_meter_.reset();
    hidden_output_time_.reset();
    if (options.gait != GaitWish::none)
      prepare_gait();

    try
    {
      result_.time = integrate(observers, keep_going);
    }
    catch (...)
    {
      result_.time = failure_while_integrating();
    }
    const bool ended_early = cycle_stop_ && cycle_stop_->repeats();
    if (ended_early)
    {
      result_.time.status = "finished";
      result_.time.time   = 1.;
    }
    else if (result_.time.status == "finished" && !diagnosis_ && accepted_time_ < 1.)
      throw std::logic_error("a run finished without a state at its end");
    if (!diagnosis_ && result_.time.status == "failed")
      explain_failure();
    if (result_.time.status == "finished" && numerics_.mesh.tolerance > 0. &&
        result_.largest_indicator > 4. * numerics_.mesh.tolerance)
      diagnosis_ = {
        "failed",
        "under_resolved",
        fmt::format("the sum of the error indicators reached {:.2g}, above the mesh tolerance of {:.2g}, and "
                    "no cell may be divided further; a smaller Discretization/Smallest cell is needed",
                    result_.largest_indicator * units_.length,
                    numerics_.mesh.tolerance * units_.length)};
    if (diagnosis_ && diagnosis_->reason == "nonfinite")
      stress_failed(); // knows better why
    if (diagnosis_)
    {
      result_.time.status  = diagnosis_->status;
      result_.time.reason  = diagnosis_->reason;
      result_.time.message = diagnosis_->message;
    }
    else if (!options.energy_balance && observers.empty())
      result_.displacement = assembler_->integrals(accepted_time_, y_, v_).displacement;
    if (ended_early)
      result_.cycles =
        cycle_stop_->extrapolate(result_.displacement, result_.energy_balance ? &*result_.energy_balance : nullptr);

    if (gait_meter_ && result_.time.status == "finished")
      result_.gait = gait_meter_->gait();

    for (const auto &observer : observers)
      observer->end();
    if (assembler_) // not if the next mesh could not be built
      result_.mesh = {discretization().n_cells(),
                      discretization().element().degree,
                      discretization().n_unknowns(),
                      discretization().n_ranks() > 1};
    result_.integrator    = time_.integrator;
    result_.engine        = !lane_stepper_ ? "petsc" : lanes_gave_up_ || petsc_stepper_ ? "fused, petsc" : "fused";
    result_.solve_seconds = now() - start - result_.output_seconds;
    return in_physical_units();
  }

  /// From the first state to the end, with changes of mesh on the way.
  TimeOutcome
  Simulation::integrate(const std::vector<std::unique_ptr<Observer>> &observers,
                        const std::function<bool()> &keep_going)
  {
    for (;;)
    {
      request_     = Request::none;
      bool resumed = started_;
      choose_stepper();
      if (!pieces_.is_last() && accepted_time_ >= pieces_.end())
        begin_segment();
      if (diagnosis_)
        return before_;
      const std::vector<double> ends = output_times_of_segment();
      const bool ends_at_output_time = ends_at_output_time_;
      stepper_->monitor              = [&](const Step &part, const std::span<const double> y) {
        if (resumed) // the state from which this part starts has been seen already
        {
          resumed = false;
          return true;
        }
        Step step = part;
        step.number += before_.steps;
        step.rejected += before_.rejected_steps;
        step.newton_iterations += before_.newton_iterations;
        latest_             = step;
        const bool at_break = !pieces_.is_last() && part.time == pieces_.end();
        step.is_output_time = part.is_output_time && (!at_break || ends_at_output_time);
        if (!examine(step, y))
          return false; // an inverted state is not shown to anybody
        const double before = now();
        show(step, y, observers);
        result_.output_seconds += now() - before;
        if (step.is_output_time && next_output_time_ < output_times_.size())
          ++next_output_time_;
        if (keep_going && !keep_going())
          return false;
        if (gait_meter_)
          watch_gait(step, y);
        if (cycle_stop_ && cycle_repeats(step, y))
          return false;
        if (step.number >= time_.max_steps && step.time < 1.)
        {
          diagnosis_ = {"stopped", "step_limit", "the maximum number of steps is reached"};
          return false;
        }
        look_for_coarser_mesh(step);
        if (at_break && request_ == Request::none)
          request_ = Request::restart;
        return request_ == Request::none;
      };
      TimeOutcome outcome = stepper_->solve(y_, ends, numerics_.tolerance, next_step_, step_limits_, accepted_time_);
      stepper_->monitor   = nullptr;
      outcome.steps += before_.steps;
      outcome.rejected_steps += before_.rejected_steps;
      outcome.newton_iterations += before_.newton_iterations;
      outcome.linear_iterations += before_.linear_iterations;
      result_.most_cells = std::max(result_.most_cells, discretization_->n_cells());
      if (!diagnosis_ && request_ == Request::none && outcome.reason == LaneStepper::gave_up)
      {
        if (position_ != nullptr)
        {
          go_on_with_petsc(outcome);
          continue;
        }
        outcome.reason       = "newton_diverged";
        outcome.message      = "the equations of a step cannot be solved";
        outcome.domain_error = scene_.friction_exponent() >= 0.;
        if (const auto &bad = lane_stepper_->bad_friction())
        {
          assembler_->look_at_friction({&bad->first, 1}, {&bad->second, 1});
          outcome.domain_error = true;
        }
      }
      // The step to the end is done again like any other if its state was thrown away.
      if (request_ == Request::none || diagnosis_ || accepted_time_ >= 1. || (cycle_stop_ && cycle_stop_->repeats()))
        return outcome;
      count_part(outcome);
      next_step_ = outcome.step_size;
      if (request_ == Request::retry)
      {
        y_ = accepted_;
        continue;
      }
      if (time_.integrator == "bdf") // starts anew with order 1
        next_step_ = std::min(next_step_, numerics_.initial_step);
      if (request_ != Request::restart)
        change();
    }
  }

  /// In a catch block: the end of a run that has thrown. What it has computed so far stays. Where ranks share the cells
  /// one may have failed alone, and the others wait for it; only a stress that is not finite is found by all together.
  TimeOutcome
  Simulation::failure_while_integrating()
  {
    TimeOutcome outcome = failure_of(std::current_exception());
    if (outcome.reason != "nonfinite" && size_of(communicator_) > 1)
      throw;
    if (stepper_ != nullptr)
      stepper_->monitor = nullptr;
    outcome.time              = latest_.time;
    outcome.step_size         = latest_.size;
    outcome.steps             = latest_.number;
    outcome.rejected_steps    = latest_.rejected;
    outcome.newton_iterations = latest_.newton_iterations;
    diagnosis_                = {outcome.status, outcome.reason, outcome.message};
    if (outcome.reason != "nonfinite")
      diagnosis_->message += fmt::format(", after t = {:.9g}", accepted_time_ * units_.time);
    return outcome;
  }

  /// The output times from now to the end of the present piece, which is the last of them if another piece follows.
  std::vector<double>
  Simulation::output_times_of_segment()
  {
    const double reach = pieces_.is_last() ? HUGE_VAL : pieces_.end() - least_time_between_breaks;
    std::vector<double> result;
    std::size_t i          = next_output_time_;
    const auto output_time = [&]() {
      return i + 1 == output_times_.size() && output_times_[i] == physical_scene_.end_time
               ? 1.
               : output_times_[i] / units_.time;
    };
    for (; i < output_times_.size() && output_time() < reach; ++i)
      result.push_back(output_time());
    ends_at_output_time_ = i < output_times_.size() && output_time() <= pieces_.end() + least_time_between_breaks;
    if (!pieces_.is_last())
      result.push_back(pieces_.end());
    return result;
  }

  /// The active stress has jumped, so velocities and all derivatives jump: from the last accepted state starts a run of
  /// its own.
  void
  Simulation::begin_segment()
  {
    pieces_.go_on();
    if (watch_)
      watch_->restart();
    assembler_->forget_stresses();
    rates_.assign(rates_.size(), {});
    quadrature_ = {};
    min_history_.interrupt();
    max_history_.interrupt();
    next_step_ = numerics_.initial_step;
    if (end_inverts(accepted_time_, accepted_time_))
      return;
    y_ = accepted_;
    if (!options_.energy_balance || !stepper_->quadrature().empty())
      return;
    if (velocity(accepted_time_, 0., y_, v_))
      quadrature_.advance(accepted_time_, rates(accepted_time_, assembler_->integrals(accepted_time_, y_, v_), y_, v_));
  }

  /// Keeps the counts of a part of the run that has ended.
  void
  Simulation::count_part(const TimeOutcome &outcome)
  {
    before_ = outcome;
    // A state that was not accepted is done again, and its step does not count.
    if (outcome.time > accepted_time_)
    {
      before_.steps -= std::min(before_.steps, 1u);
      ++before_.rejected_steps;
    }
  }

  /// Changes the mesh, of the position form, and carries the last accepted state over.
  void
  Simulation::change()
  {
    const auto old_assembler      = std::move(assembler_);
    PositionForm &old_form        = *position_;
    const auto old_discretization = std::move(discretization_);
    build(old_discretization->adapted(changes_));
    y_ = mesh_transfer(numerics_.degree).transfer(old_form, accepted_, *position_);
    if (accepted_time_ == 0. && !scene_.is_plain())
      assembler_->set_initial_state(y_);
    const double old_time = accepted_time_;
    if (keeps_rate())
      settle();
    if (options_.energy_balance)
    {
      const std::vector<double> old_v(old_discretization->n_owned(), 0.), new_v(v_.size(), 0.);
      result_.energy_balance->transfer_loss += old_assembler->integrals(old_time, accepted_, old_v).elastic_energy -
                                               assembler_->integrals(accepted_time_, y_, new_v).elastic_energy;
    }
    accepted_ = y_;
    ++result_.mesh_changes;
    result_.most_cells = std::max(result_.most_cells, discretization_->n_cells());
  }

  /**
   * A state that was carried to another mesh is out of balance by the error of the mesh. Where friction is small it
   * returns to balance at once, at the rate k/(gamma w^a h^2), and a time stepper that watched this would need steps as
   * short. A backward Euler step is stable for any rate; this one is so short that its own error, size^2 u''/2, is a
   * small part of the tolerance. If it cannot be made the state is left as it is.
   */
  void
  Simulation::settle()
  {
    constexpr unsigned int most_corrections = 10;
    const double size                       = settling_factor * std::sqrt(std::min(numerics_.tolerance, 1e-8));
    const double t                          = accepted_time_ + size;
    // Nobody sees this step, so it must not pass a time at which somebody wants to see a state.
    const double next_output_time =
      next_output_time_ < output_times_.size() ? output_times_[next_output_time_] / units_.time : 1.;
    const double next_stride = gait_meter_ ? gait_meter_->next_time() : HUGE_VAL,
                 next_cycle  = cycle_stop_ ? cycle_stop_->next_time() : HUGE_VAL;
    if (t > std::min({next_output_time, pieces_.end(), next_stride, next_cycle}) - size)
      return;
    std::vector<double> y = y_, rate(y.size(), 0.), F(y.size()), change(y.size());
    for (unsigned int i = 0; i < most_corrections; ++i)
    {
      if (!position_->residual(t, y, rate, F) || !position_->setup_jacobian(t, y, rate, 1. / size))
        return;
      position_->solve_with_jacobian(F, change);
      double largest = 0.;
      for (std::size_t j = 0; j < y.size(); ++j)
      {
        y[j] -= change[j];
        rate[j] = (y[j] - y_[j]) / size;
        largest = std::isfinite(change[j]) ? std::max(largest, std::abs(change[j])) : HUGE_VAL;
      }
      MPI_Allreduce(MPI_IN_PLACE, &largest, 1, MPI_DOUBLE, MPI_MAX, communicator_);
      if (!std::isfinite(largest))
        return;
      if (largest <= 0.01 * numerics_.tolerance + 1e-15)
      {
        y_             = y;
        accepted_time_ = t;
        return;
      }
    }
  }

  /// Looks at a state that the time stepper has accepted; returns false if it must not be used.
  bool
  Simulation::examine(const Step &step, const std::span<const double> y)
  {
    if (stress_failed())
      return false;
    stretch_            = assembler_->stretch_range(y);
    const double before = step.time - step.size;
    const bool finite   = std::isfinite(stretch_.min.value) && std::isfinite(stretch_.max.value);
    if (!finite)
    {
      diagnosis_ = {"failed",
                    "nonfinite",
                    fmt::format("the stretch at s = {:.6g}, t = {:.6g} is not a finite number",
                                stretch_.min.s * units_.length,
                                step.time * units_.time)};
      return false;
    }
    if (end_inverts(before, step.time) || passed_over_event(step))
      return false;
    const bool adaptive = numerics_.mesh.tolerance > 0.;
    if (stretch_.min.value <= lost_stretch())
    {
      // A mesh that is too coarse can lose it, too, so that is mended first.
      if (!adaptive || !velocity(step.time, step.size, y, v_) || mesh_is_good(step, y))
        locate_inversion(step);
      return false;
    }
    // Pictures need the velocity at output times only, the energy balance and adaptive meshes always.
    if (options_.energy_balance || adaptive || (has_observers_ && (step.is_output_time || step.number == 0)))
      if (!velocity(step.time, step.size, y, v_))
      {
        if (law_failed() || stress_failed())
          return false;
        diagnosis_ = {"failed",
                      "linear_failed",
                      fmt::format("the velocity at t = {:.6g} cannot be computed: the friction matrix is singular",
                                  step.time * units_.time)};
        return false;
      }
    if (adaptive && !mesh_is_good(step, y))
      return false;
    if (!compute_integrals(step, y))
      return false;
    look_at_extremes(step.time, stretch_, step.number == 0);
    if (options_.resolution && stretch_form_ != nullptr)
    {
      const auto u  = assembler_->displacement(y);
      double square = 0.;
      for (const double value : u)
        square += value * value;
      result_.largest_u = std::max(result_.largest_u, std::sqrt(square / static_cast<double>(u.size())));
    }
    if (options_.resolution && position_ != nullptr)
    {
      if (!adaptive && velocity(step.time, step.size, y, v_))
      {
        const auto indicators = all_indicators(position_->error_indicators(step.time, y, v_), *discretization_);
        result_.largest_indicator =
          std::max(result_.largest_indicator, std::accumulate(indicators.begin(), indicators.end(), 0.));
      }
      const Resolution resolution = position_->resolution(y);
      largest_.highest_mode       = std::max(largest_.highest_mode, resolution.highest_mode);
      largest_.strain             = std::max(largest_.strain, resolution.strain);
      result_.unresolved          = largest_.strain > 0. ? largest_.highest_mode / largest_.strain : 0.;
      result_.strain              = largest_.strain;
      result_.largest_u           = std::max(result_.largest_u, position_->root_mean_square(y));
    }
    // Many steps that lead nowhere.
    const double tiny = tiny_step * std::min(1., 10. * longest_step(step.time));
    tiny_steps_       = step.size > 0. && step.size < tiny ? tiny_steps_ + 1 : 0;
    if (tiny_steps_ > most_steps_at_zero && scene_.friction_exponent() >= 0. && stretch_.min.value < nearly_zero)
    {
      inverted_inside(stretch_.min.value, stretch_.min.s, step.time);
      return false;
    }
    if (tiny_steps_ > most_tiny_steps)
    {
      diagnosis_ = {"failed",
                    "step_underflow",
                    fmt::format("{} steps in succession were smaller than {:g} of the duration, at t = {:.9g}; the "
                                "smallest stretch is {:.3g} at s = {:.6g}",
                                most_tiny_steps,
                                tiny,
                                step.time * units_.time,
                                stretch_.min.value,
                                stretch_.min.s * units_.length)};
      return false;
    }
    keep_history(step, y);
    accepted_.assign(y.begin(), y.end());
    accepted_time_ = step.time;
    started_       = true;
    return true;
  }

  /// Where friction vanishes (w -> 0 for a > 0) a state alone does not tell the velocity: the error of Newton's method
  /// would be divided by the friction; and cells that are small or stiff turn its round-off into velocities, by 1e-16
  /// over their time of relaxation. The rate of the time stepper has no such error, so it is kept. That of the linear
  /// level is the velocity, exactly.
  bool
  Simulation::keeps_rate() const
  {
    if (numerics_.linear)
      return true;
    const bool amplifies = relaxation_time_ < fast_relaxation || (scene_.friction_exponent() > 0. && scene_.is_plain());
    return amplifies && position_ != nullptr;
  }

  /// Keeps the rate of the latest residual at each of the latest times: those of the stages of a step, and its start.
  void
  Simulation::keep_rate(const double t, const std::span<const double> y_dot)
  {
    auto found = std::find_if(rates_.begin(), rates_.end(), [t](const Rate &rate) { return rate.time == t; });
    if (found == rates_.end())
    {
      std::rotate(rates_.begin(), rates_.begin() + 1, rates_.end());
      found = rates_.end() - 1;
    }
    found->time = t;
    found->y_dot.assign(y_dot.begin(), y_dot.end());
  }

  /**
   * The velocity @p v of a state @p y that the time stepper has reached with a step of this size. From the rate r with
   * which it did so, if that is kept: v is the solution of M v + f + h K (v - r) = 0, h the step. Friction balances
   * exactly, since K does not act on rigid motions, and where M vanishes v is r.
   */
  bool
  Simulation::velocity(const double t, const double size, const std::span<const double> y, std::vector<double> &v)
  {
    const auto known = std::find_if(rates_.begin(), rates_.end(), [&](const Rate &rate) {
      return size > 0. && std::abs(rate.time - t) <= 1e-9 * size;
    });
    if (!keeps_rate() || known == rates_.end())
      return assembler_->velocity(t, y, v);
    if (numerics_.linear)
    {
      v = known->y_dot;
      return true;
    }
    std::vector<double> F(y.size()), correction(y.size());
    // Without a velocity the Jacobian is M/h + K; but friction that is not linear in it has to be that of the rate.
    const std::vector<double> at = scene_.is_plain() ? std::vector<double>(y.size(), 0.) : known->y_dot;
    if (!position_->residual(t, y, known->y_dot, F) || !position_->setup_jacobian(t, y, at, 1. / size))
      return false;
    position_->solve_with_jacobian(F, correction);
    for (std::size_t i = 0; i < v.size(); ++i)
      v[i] = known->y_dot[i] - correction[i] / size;
    if (scene_.is_plain())
    {
      // K does not act on rigid motions, so round-off of the solution, 1e-16 h K/M of it, can hide in one; friction
      // that is linear in the velocity says how large that is.
      const std::vector<double> rigid(v.size(), 1.);
      const double motion =
        assembler_->integrals(t, y, v).net_friction / assembler_->integrals(t, y, rigid).net_friction;
      if (std::isfinite(motion))
        for (double &value : v)
          value -= motion;
    }
    return true;
  }

  /// Is the sum of the error indicators admissible? If not, and if cells can be divided, asks for that.
  bool
  Simulation::mesh_is_good(const Step &step, const std::span<const double> y)
  {
    indicators_      = all_indicators(position_->error_indicators(step.time, y, v_), *discretization_);
    const double sum = std::accumulate(indicators_.begin(), indicators_.end(), 0.);
    changes_.clear();
    if (sum > numerics_.mesh.tolerance)
      changes_ = mark_for_division(indicators_, *discretization_, numerics_.mesh);
    if (changes_.empty())
    {
      result_.largest_indicator = std::max(result_.largest_indicator, sum);
      return true;
    }
    request_ = Request::mesh;
    return false;
  }

  void
  Simulation::look_for_coarser_mesh(const Step &step)
  {
    constexpr unsigned int most_joins_every = 10;
    if (numerics_.mesh.tolerance <= 0. || request_ != Request::none || step.number == 0 ||
        step.number % most_joins_every != 0 || step.time >= 1.)
      return;
    changes_ = mark_for_joining(indicators_, *discretization_, numerics_.mesh);
    if (!changes_.empty())
      request_ = Request::mesh;
  }

  /// Output times have the times that were asked for, exactly.
  double
  Simulation::physical_time(const Step &step) const
  {
    if (step.is_output_time && next_output_time_ < output_times_.size())
      return output_times_[next_output_time_];
    return step.time * units_.time;
  }

  void
  Simulation::show(const Step &step,
                   const std::span<const double> y,
                   const std::vector<std::unique_ptr<Observer>> &observers)
  {
    if (observers.empty())
      return;
    Step physical = step;
    physical.time = physical_time(step);
    physical.size *= units_.time;
    const double energy = units_.energy(), power = units_.power();
    CellIntegrals sums = integrals_;
    sums.displacement *= units_.length * units_.length;
    sums.velocity *= units_.length * units_.velocity();
    sums.elastic_energy *= energy;
    for (double *rate : {&sums.stress_power, &sums.positive_power, &sums.absolute_power, &sums.dissipation})
      *rate *= power;
    sums.net_friction *= units_.force;
    sums.abs_friction *= units_.force;
    const StretchRange range{{stretch_.min.value, stretch_.min.s * units_.length},
                             {stretch_.max.value, stretch_.max.s * units_.length}};
    const EnergyBalance energy_balance =
      result_.energy_balance ? result_.energy_balance->scaled(energy) : EnergyBalance();
    for (const auto &observer : observers)
      observer->observe({physical,
                         step.number == 0 || (step.is_output_time && physical.time != hidden_output_time_),
                         *assembler_,
                         mesh_number_,
                         units_,
                         step.time,
                         y,
                         v_,
                         sums,
                         range,
                         energy_balance});
  }

  SimulationResult
  Simulation::in_physical_units() const
  {
    SimulationResult result = result_;
    result.time.time = result.time.status == "finished" ? physical_scene_.end_time : result.time.time * units_.time;
    result.time.step_size *= units_.time;
    result.displacement *= units_.length;
    result.largest_u *= units_.length;
    result.strain *= units_.length;
    result.largest_indicator *= units_.length;
    if (result.energy_balance)
      result.energy_balance = result.energy_balance->scaled(units_.energy());
    const auto scale = [this](SimulationResult::Extreme &extreme) {
      extreme.s *= units_.length;
      extreme.t *= units_.time;
    };
    scale(result.min_stretch);
    scale(result.max_stretch);
    if (result.inversion)
      scale(*result.inversion);
    if (result.cycles)
    {
      result.cycles->period *= units_.time;
      result.cycles->bound *= units_.length;
    }
    if (result.time.status == "finished" && result.energy_balance)
      result.gait_efficiency = gait_efficiency(physical_scene_, result);
    if (result.gait)
      result.gait = result.gait->in_units(units_);
    if (result.inverted_places)
      result.inverted_places = {result.inverted_places->first * units_.length,
                                result.inverted_places->second * units_.length};
    return result;
  }
} // namespace crawler
