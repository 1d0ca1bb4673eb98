// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/equation/position_form.h>
#include <crawler/lanes/lane_adjoint.h>
#include <crawler/run/simulation.h>
#include <crawler/time/failure.h>
#include <crawler/time/integrators.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace crawler
{
  const std::string &
  integrator_of(const TimeParameters &time, const Numerics &numerics)
  {
    return time.integrator == "automatic" ? numerics.integrator : time.integrator;
  }

  Numerics
  in_units(Numerics numerics, const Units &units)
  {
    numerics.tolerance /= units.length;
    numerics.layer /= units.length;
    numerics.initial_step /= units.time;
    for (StepLimit &limit : numerics.step_limits)
      limit = {limit.from / units.time, limit.longest / units.time};
    numerics.min_event /= units.force;
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

  std::optional<LaneMethod>
  lane_method(const Scene &scene, const TimeParameters &time, const Numerics &numerics)
  {
    const Integrator &method  = integrator(integrator_of(time, numerics));
    const bool is_one_of_ours = method.petsc_type == "radau" && time.step_control == StepControl::adaptive;
    const bool is_stretch     = numerics.formulation == Formulation::stretch;
    if (time.engine != Engine::automatic || !is_one_of_ours || numerics.mesh.tolerance != 0. ||
        !(is_stretch ? reason_against_stretch_form(scene).empty() : fits_lanes(scene)))
      return std::nullopt;
    LaneMethod result = {numerics.degree,
                         numerics.n_cells,
                         method.n_stages,
                         first_cell_ends(scene, numerics),
                         is_stretch,
                         numerics.other_rule,
                         lane_laws(scene)};
    if (!result.cell_ends.empty())
      result.n_cells = static_cast<unsigned int>(result.cell_ends.size() - 1);
    return result;
  }

  Simulation::Simulation(MPI_Comm communicator,
                         const Scene &scene,
                         const TimeParameters &time,
                         const Numerics &numerics)
    : physical_scene_(scene)
    , units_(natural_units(scene))
    , segments_(*scene.active_stress, scene.end_time)
    , scene_(crawler::in_units(scene, units_, &segments_))
    , numerics_(in_units(numerics, units_))
    , time_(time)
    , breaks_(scene_.breaks_in_space())
    , communicator_(communicator)
  {
    time_.end_time = 1.;
    if (scene_.active_stress->feedback() != nullptr)
      past_.delay = scene_.active_stress->feedback()->facts.delay;
    time_.integrator = integrator_of(time, numerics);
    build_first();
  }

  Simulation::~Simulation() = default;

  /// Builds the mesh of the start.
  void
  Simulation::build_first()
  {
    std::vector<double> ends = first_cell_ends(scene_, numerics_);
    build(ends.empty() ? std::make_unique<Discretization>(communicator_, 1., numerics_.n_cells, numerics_.degree)
                       : std::make_unique<Discretization>(communicator_, std::move(ends), numerics_.degree));
    mesh_.is_first = true;
  }

  /// Builds the equation on a mesh.
  void
  Simulation::build(std::unique_ptr<Discretization> discretization)
  {
    integrators_         = {};
    mesh_                = {};
    mesh_.discretization = std::move(discretization);
    const auto n_stages  = integrator(time_.integrator).n_stages;
    if (numerics_.formulation == Formulation::stretch)
    {
      auto form       = std::make_unique<StretchForm>(scene_, *mesh_.discretization, numerics_.other_rule);
      mesh_.stretch   = form.get();
      mesh_.assembler = std::move(form);
    }
    else
    {
      auto form       = std::make_unique<PositionForm>(scene_, *mesh_.discretization);
      mesh_.position  = form.get();
      mesh_.assembler = std::move(form);
      mesh_.position->keep_stresses(n_stages);
    }
    mesh_.velocity  = std::make_unique<StateVelocity>(*mesh_.assembler, mesh_.position, is_adaptive(), n_stages);
    mesh_.end_power = std::make_unique<EndPower>(*mesh_.assembler);
    if (past_.delay > 0.)
    {
      mesh_.assembler->history = &past_.history;
      past_.cells              = std::make_shared<const std::vector<Cell>>(mesh_.discretization->cells);
    }
    y_.resize(mesh_.discretization->n_owned());
    v_.resize(mesh_.discretization->n_owned());
    choose_stepper(); // options of PETSc are read now
  }

  /// Chooses the fused engine where it fits and has not given up, else PETSc. The unused one is not built.
  void
  Simulation::choose_stepper()
  {
    const auto method = size_of(communicator_) == 1 ? lane_method(scene_, time_, numerics_) : std::nullopt;
    if (method && (!run_ || !run_->lanes_gave_up))
    {
      if (!integrators_.lanes)
        integrators_.lanes = std::make_unique<LaneStepper>(scene_, *method);
      integrators_.present = integrators_.lanes.get();
    }
    else
    {
      if (mesh_.position == nullptr)
        throw std::logic_error("the stretch form is for the fused engine");
      if (!integrators_.petsc)
        integrators_.petsc = petsc_stepper(communicator_, *mesh_.position, time_);
      integrators_.present = integrators_.petsc.get();
    }
  }

  SimulationResult
  Simulation::run(const PictureTimes &pictures,
                  const RecordOptions &options,
                  const Observers &observers,
                  const KeepGoing &keep_going)
  {
    const double start = now();
    if (options.cycles && !pictures.is_empty())
      throw std::logic_error("a run that may end when its cycles repeat has no pictures");
    RunJournal *const journal = options.steps == nullptr ? keep_going.journal() : nullptr;
    if (journal != nullptr)
      if (auto known = journal->begin(identity(options, !pictures.is_empty())))
        return *known;
    segments_.restart();
    run_.reset();
    if (!mesh_.is_first)
      build_first();
    mesh_.assembler->forget_stresses(); // those of the last segment
    past_.history.clear();
    // Searches for a period need a thousand samples of the state.
    constexpr std::size_t max_unknowns = 10000;
    const bool is_watched              = time_.step_control == StepControl::adaptive;
    Recorder recorder(
      physical_scene_, units_, options, numerics_.tolerance, mesh_.discretization->n_unknowns() <= max_unknowns);
    if (mesh_.position != nullptr)
      recorder.set_smallest_cell(std::ranges::min_element(mesh_.discretization->cells, {}, &Cell::size)->size);
    OutputTimes output_times(pictures, recorder.step_ends(), !integrators_.present->stage_places().empty());
    run_.emplace(
      Run{.options      = options,
          .observers    = observers,
          .keep_going   = keep_going,
          .journal      = journal,
          .recorder     = std::move(recorder),
          .output_times = std::move(output_times),
          .limiter      = StepLimiter(numerics_.step_limits,
                                 past_.delay > 0. ? past_.delay : HUGE_VAL,
                                 *scene_.active_stress,
                                 is_watched ? numerics_.min_event : 0.),
          .n_failures   = scene_.active_stress->failures() != nullptr ? scene_.active_stress->failures()->count : 0});
    result().process.jumps_move  = numerics_.jumps_move;
    result().process.formulation = numerics_.formulation;
    mesh_.assembler->set_initial_state(y_);
    run_->accepted = {y_, 0., numerics_.initial_step, false};
    take_up();

    try
    {
      result().time = integrate();
    }
    catch (...)
    {
      result().time = failure_while_integrating();
    }
    SimulationResult answer      = finish();
    answer.process.seconds.solve = now() - start - answer.process.seconds.output;
    if (journal != nullptr)
      journal->end(answer);
    return answer;
  }

  /// Interprets the end of the integration, and makes the result in the user's units.
  SimulationResult
  Simulation::finish()
  {
    SimulationResult &result = this->result();
    const bool ends_early    = run_->recorder.cycles_repeat();
    if (!ends_early && result.time.status == Status::finished && !run_->diagnosis && run_->accepted.time < 1.)
      throw std::logic_error("a run finished without a state at its end");
    if (!run_->diagnosis && result.time.status == Status::failed)
      explain_failure();
    if ((ends_early || result.time.status == Status::finished) && is_adaptive() &&
        result.size.largest_indicator > 4. * numerics_.mesh.tolerance)
      run_->diagnosis = {
        Status::failed,
        "under_resolved",
        fmt::format("the sum of the error indicators reached {:.2g}, above the mesh tolerance of {:.2g}, and "
                    "no cell may be divided further; a smaller Discretization/Smallest cell is needed",
                    result.size.largest_indicator * units_.length,
                    numerics_.mesh.tolerance * units_.length)};
    if (run_->diagnosis && run_->diagnosis->reason == "nonfinite")
      stress_failed(); // its diagnosis is more precise
    if (run_->diagnosis)
    {
      result.time.status  = run_->diagnosis->status;
      result.time.reason  = run_->diagnosis->reason;
      result.time.message = run_->diagnosis->message;
      if (run_->accepted.is_there)
        result.time.time = run_->accepted.time; // not that of the state that was lost
    }
    else if (!run_->options.energy_balance && run_->observers.empty())
      result.displacement = mesh_.assembler->integrals(run_->accepted.time, y_, v_).displacement;
    // Steps in which the lanes have evaluated the integrals did not set the displacement.
    if (integrators_.lanes && run_->options.energy_balance && run_->observers.empty() && run_->accepted.is_there)
      result.displacement = mesh_.assembler->integrals(run_->accepted.time, run_->accepted.y, v_).displacement;
    const double before = now();
    for (const auto &observer : run_->observers)
      observer->end();
    result.process.seconds.output += now() - before;
    if (mesh_.assembler) // not if the next mesh could not be built
      result.process.mesh = {discretization().n_cells(),
                             discretization().element.degree,
                             discretization().n_unknowns(),
                             discretization().n_ranks > 1,
                             result.process.mesh.changes,
                             result.process.mesh.most_cells};
    result.process.integrator = time_.integrator;
    result.process.engine     = !integrators_.lanes                         ? "petsc"
                                : run_->lanes_gave_up || integrators_.petsc ? "fused, petsc"
                                                                            : "fused";
    return run_->recorder.finish();
  }

  /// Integrates from the first state to the end, with changes of mesh on the way.
  TimeOutcome
  Simulation::integrate()
  {
    for (;;)
    {
      choose_stepper();
      if (!segments_.is_last() && run_->accepted.time >= segments_.end())
      {
        begin_segment();
        if (!run_->diagnosis)
          show_row_after_jump();
      }
      if (run_->diagnosis)
        return run_->before;
      const Ending ending = integrate_part();
      TimeOutcome outcome = integrators_.present->outcome();
      if (outcome.status == Status::none)
        outcome.status = Status::stopped;
      outcome.steps += run_->before.steps;
      outcome.rejected_steps += run_->before.rejected_steps;
      outcome.newton_iterations += run_->before.newton_iterations;
      unsigned int &most_cells = result().process.mesh.most_cells;
      most_cells               = std::max(most_cells, mesh_.discretization->n_cells());
      if (!goes_on_after(ending, outcome))
        return outcome;
    }
  }

  /// Integrates to the end, or to where something has to be changed.
  Simulation::Ending
  Simulation::integrate_part()
  {
    // Numbers of the lanes are used, but not where round-off of the state counts, in very stiff or small cells.
    if (integrators_.lanes)
      integrators_.lanes->look_inside =
        run_->options.energy_balance && mesh_.position != nullptr && integrators_.present == integrators_.lanes.get() &&
        mesh_.velocity->is_known_to_lanes() && run_->options.resolution != ResolutionWish::all;
    Stepper &stepper    = *integrators_.present;
    stepper.stage_rates = nullptr;
    if (mesh_.velocity->keeps_rates() || run_->output_times.next() < HUGE_VAL)
      stepper.stage_rates = [this](const double t, const std::span<const double> y_dot) {
        mesh_.velocity->see_rate(t, y_dot);
      };
    Course course = {run_->before.time,
                     run_->output_times.of_segment(segments_, run_->before.time),
                     numerics_.tolerance,
                     run_->accepted.next_step,
                     run_->limiter.limits()};
    if (course.ends.empty() || course.ends.back() < 1.)
      course.ends.push_back(1.);
    stepper.begin(y_, course);

    Ending ending = Ending::none;
    if (!run_->accepted.is_there)
    {
      const Step start = {run_->before.time, 0., 0, false, 0, 0};
      ending           = look_at(start, start);
    }
    while (ending == Ending::none)
      if (const Step *const part = stepper.next())
      {
        run_->state.step = *part;
        run_->state.step.number += run_->before.steps;
        run_->state.step.rejected += run_->before.rejected_steps;
        run_->state.step.newton_iterations += run_->before.newton_iterations;
        ending = look_at(*part, run_->state.step);
      }
      else
        ending = Ending::stepper;
    y_.assign(stepper.state().begin(), stepper.state().end());
    return ending;
  }

  /// Examines a step of the present part, which is @p step of the whole run, or the start of both.
  Simulation::Ending
  Simulation::look_at(const Step &part, const Step &step)
  {
    const std::span<const double> y = integrators_.present->state();
    if (const Ending ending = see(step, y); ending != Ending::none)
      return ending;
    std::vector<double> u;
    const auto sample = [&](const double t) -> Recorder::BodySample {
      const auto state = t < step.time && step.size > 0. ? state_within(t) : y;
      u                = mesh_.assembler->displacement_at(Recorder::n_pieces, state);
      return {u, mesh_.assembler->integrals(step.time, state, v_).displacement};
    };
    if (run_->recorder.see_step(
          step.time, step.is_output_time, run_->state.stretch.min.value, run_->state.stretch.max.value, sample))
      return Ending::cycles;
    if (step.number >= time_.max_steps && step.time < 1.)
    {
      run_->diagnosis = {Status::stopped, "step_limit", "the maximum number of steps was reached"};
      return Ending::lost;
    }
    if (run_->options.steps != nullptr && step.size > 0. && integrators_.present == integrators_.lanes.get())
      run_->options.steps->add(
        integrators_.lanes->lane_step(), integrators_.lanes->tables().setup.n_stages, y.size(), part.number == 1);
    if (wants_coarser_mesh(step))
      return Ending::mesh;
    if (!segments_.is_last() && part.time == segments_.end())
      return Ending::jump;
    const bool stops = !run_->keep_going();
    keep_state(stops, step);
    return stops ? Ending::stopped : Ending::none;
  }

  /// Decides whether another part follows one that has ended.
  bool
  Simulation::goes_on_after(const Ending ending, TimeOutcome &outcome)
  {
    constexpr double smallest_step_of_petsc = 1e-9;

    const bool gave_up = ending == Ending::stepper && outcome.reason == LaneStepper::gave_up;
    if (gave_up && mesh_.position == nullptr)
    {
      outcome.reason       = "newton_diverged";
      outcome.message      = "the equations of a step cannot be solved";
      outcome.domain_error = scene_.friction_exponent() >= 0.;
      if (const auto &bad = integrators_.lanes->bad_friction())
      {
        mesh_.assembler->look_at_friction({&bad->first, 1}, {&bad->second, 1});
        outcome.domain_error = true;
      }
    }
    const bool goes_to_petsc = gave_up && mesh_.position != nullptr;
    const bool wants_change  = ending == Ending::mesh || ending == Ending::retry || ending == Ending::jump;
    // Steps to the end are repeated like any other if their state was discarded.
    if (!goes_to_petsc && (!wants_change || run_->accepted.time >= 1.))
      return false;
    run_->before = outcome;
    // States that were not accepted are repeated, and their step does not count.
    if (outcome.time > run_->accepted.time)
    {
      run_->before.steps -= std::min(run_->before.steps, 1u);
      ++run_->before.rejected_steps;
    }
    double &next_step = run_->accepted.next_step;
    next_step         = outcome.step_size;
    if (goes_to_petsc || ending == Ending::retry)
      y_ = run_->accepted.y;
    if (goes_to_petsc)
    {
      run_->lanes_gave_up = true;
      next_step           = std::max(std::min(next_step, numerics_.initial_step), smallest_step_of_petsc);
    }
    else if (ending != Ending::retry && time_.integrator == "bdf") // starts anew with order 1
      next_step = std::min(next_step, numerics_.initial_step);
    if (ending == Ending::mesh)
      change();
    run_->before.time = run_->accepted.time;
    return true;
  }

  /// Outcome, in a catch block, of a run that has thrown. Its results so far stay. Where ranks share the cells one may
  /// have failed alone, and the others wait for it; only a stress that is not finite is found by all together.
  TimeOutcome
  Simulation::failure_while_integrating()
  {
    TimeOutcome outcome = failure_of(std::current_exception());
    if (outcome.reason != "nonfinite" && size_of(communicator_) > 1)
      throw;
    outcome.time              = run_->state.step.time;
    outcome.step_size         = run_->state.step.size;
    outcome.steps             = run_->state.step.number;
    outcome.rejected_steps    = run_->state.step.rejected;
    outcome.newton_iterations = run_->state.step.newton_iterations;
    run_->diagnosis           = {outcome.status, outcome.reason, outcome.message};
    if (outcome.reason != "nonfinite")
      run_->diagnosis->message += fmt::format(", after t = {:.9g}", run_->accepted.time * units_.time);
    return outcome;
  }

  /// Starts anew from the last accepted state: the active stress has jumped, and so have velocities and derivatives.
  void
  Simulation::begin_segment()
  {
    segments_.go_on();
    run_->limiter.restart();
    mesh_.assembler->forget_stresses();
    mesh_.velocity->forget_rates();
    run_->quadrature = {};
    run_->recorder.interrupt();
    const double t           = run_->accepted.time;
    run_->accepted.next_step = numerics_.initial_step;
    if (end_inverts(t, t))
      return;
    y_ = run_->accepted.y;
    if (!run_->options.energy_balance || !integrators_.present->stage_places().empty())
      return;
    if (mesh_.velocity->compute(t, 0., y_, v_))
      run_->quadrature.advance(t, rates_of(mesh_.assembler->integrals(t, y_, v_), (*mesh_.end_power)(t, y_, v_)));
  }
} // namespace crawler
