// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Part of Simulation that writes its state between two steps, and continues from one.
#include <crawler/base/archive.h>
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/run/simulation.h>

#include <algorithm>

namespace crawler
{
  /// Inputs that decide on the run; those common to all runs of an answer are omitted.
  std::string
  Simulation::identity(const RecordOptions &options, const bool has_pictures) const
  {
    Archive archive;
    Numerics numerics          = numerics_;
    TimeParameters time        = time_;
    RecordOptions what         = options;
    bool is_shown              = has_pictures;
    unsigned int n_ranks       = size_of(communicator_);
    double duration            = units_.time;
    std::optional<double> wish = options.cycles ? std::optional(options.cycles->accuracy) : std::nullopt;
    archive(numerics, time.integrator, time.engine, time.order, time.step_control, time.max_steps, time.petsc_prefix);
    archive(what.energy_balance, what.resolution, wish, what.gait, is_shown, n_ranks, duration);
    return archive.bytes();
  }

  /// State of this rank.
  void
  Simulation::exchange(Archive &archive)
  {
    Run &run = *run_;
    exchange_mesh(archive);
    archive(segments_, past_.history, *mesh_.velocity, v_);
    archive(run.recorder, run.output_times, run.limiter, run.accepted, run.quadrature);
    archive(run.before, run.state.step, run.lanes_gave_up, run.tiny_steps);
    if (archive.reads())
    {
      y_ = run.accepted.y;
      choose_stepper();
    }
    if (!integrators_.present->exchange(archive) && archive.reads())
    {
      run.before.time              = run.accepted.time;
      run.before.steps             = run.state.step.number;
      run.before.rejected_steps    = run.state.step.rejected;
      run.before.newton_iterations = run.state.step.newton_iterations;
      run.accepted.next_step       = std::min(run.state.step.size, numerics_.initial_step);
    }
    for (const auto &observer : run.observers)
      observer->exchange(archive);
  }

  /// Divides cells until they are those of the saved mesh.
  void
  Simulation::exchange_mesh(Archive &archive)
  {
    if (!is_adaptive())
      return;
    std::vector<Cell> wanted = mesh_.discretization->cells;
    archive(wanted);
    if (!archive.reads())
      return;
    std::unique_ptr<Discretization> next;
    std::vector<CellChange> changes;
    for (bool is_changed = true; is_changed;)
    {
      const std::vector<Cell> &cells = (next ? *next : *mesh_.discretization).cells;
      if (cells.size() > wanted.size()) // a damaged state, with endless levels
        break;
      changes.assign(cells.size(), CellChange::keep);
      is_changed = false;
      for (std::size_t c = 0, w = 0; c < cells.size(); ++c)
      {
        while (w < wanted.size() && wanted[w].left < cells[c].left)
          ++w;
        if (w < wanted.size() && wanted[w].level > cells[c].level)
        {
          changes[c] = CellChange::divide;
          is_changed = true;
        }
      }
      if (is_changed)
        next = (next ? *next : *mesh_.discretization).adapted(changes);
    }
    const auto is_same = [](const Cell &a, const Cell &b) { return a.left == b.left && a.size == b.size; };
    if (!std::ranges::equal((next ? *next : *mesh_.discretization).cells, wanted, is_same))
      throw FileError("a saved state does not match the program: its mesh cannot be rebuilt");
    if (next)
      build(std::move(next));
  }

  /// Continues from the state that the journal has, if there is one: those of all ranks that share the cells.
  void
  Simulation::take_up()
  {
    if (run_->journal == nullptr || run_->journal->state() == nullptr)
      return;
    std::vector<std::string> states;
    Archive all(*run_->journal->state());
    all(states);
    if (states.size() != size_of(communicator_))
      throw FileError("a saved state does not match the program: it was made by another number of ranks");
    Archive own(states[rank_of(communicator_)]);
    exchange(own);
  }

  /// Gives the journal the state, if one is due or if the run @p stops.
  void
  Simulation::keep_state(const bool stops, const Step &step)
  {
    RunJournal *const journal = run_->journal;
    if (journal == nullptr)
      return;
    int is_wanted = stops ? journal->writes() : journal->is_due();
    if (size_of(communicator_) > 1)
      MPI_Bcast(&is_wanted, 1, MPI_INT, 0, communicator_);
    const bool is_between = step.size > 0. && step.time < 1.; // not at the start of a part, nor at the end
    if (is_wanted != 0 && is_between)
    {
      Archive own;
      exchange(own);
      std::vector<std::string> states = gather(own.bytes(), communicator_); // on the first rank
      journal->keep(archived(states));
    }
    else if (stops)
      journal->write();
    if (stops)
      journal->close();
  }
} // namespace crawler
