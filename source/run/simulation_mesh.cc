// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Part of Simulation that changes the mesh on the way (doc/numerics.md, "Adaptive meshes").
#include <crawler/equation/mesh_transfer.h>
#include <crawler/run/simulation.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace crawler
{
  /// Changes the mesh, of the position form, and transfers the last accepted state.
  void
  Simulation::change()
  {
    const auto old_assembler      = std::move(mesh_.assembler);
    PositionForm &old_form        = *mesh_.position;
    const auto old_discretization = std::move(mesh_.discretization);
    build(old_discretization->adapted(mesh_.changes));
    y_ = transferred(old_form, run_->accepted.y, *mesh_.position);
    if (run_->accepted.time == 0. && !scene_.is_plain())
      mesh_.assembler->set_initial_state(y_);
    const double old_time = run_->accepted.time;
    if (mesh_.velocity->keeps_rates())
      balance_state();
    if (run_->options.energy_balance)
    {
      const std::vector<double> old_v(old_discretization->n_owned(), 0.), new_v(v_.size(), 0.);
      result().energy_balance->transfer_loss +=
        old_assembler->integrals(old_time, run_->accepted.y, old_v).elastic_energy -
        mesh_.assembler->integrals(run_->accepted.time, y_, new_v).elastic_energy;
    }
    run_->accepted.y = y_;
    ++result().process.mesh.changes;
  }

  /**
   * Settles a state that was transferred to another mesh and is out of balance by the error of the mesh. Where friction
   * is small it returns to balance at once, at the rate k/(gamma w^a h^2), and a time stepper that followed this would
   * need steps as short. A backward Euler step is stable for any rate; this one is so short that its own error, size^2
   * u''/2, is a small part of the tolerance. If it cannot be made the state is left as it is.
   */
  void
  Simulation::balance_state()
  {
    constexpr double settling_factor       = 0.01; // step over the root of the tolerance
    constexpr unsigned int max_corrections = 10;
    const double size                      = settling_factor * std::sqrt(std::min(numerics_.tolerance, 1e-8));
    const double t                         = run_->accepted.time + size;
    // Settling steps are not shown, so they must not pass a time at which a state is wanted.
    if (t > std::min({run_->output_times.next(), segments_.end(), run_->recorder.next_sample()}) - size)
      return;
    std::vector<double> y = y_, rate(y.size(), 0.), F(y.size()), change(y.size());
    for (unsigned int i = 0; i < max_corrections; ++i)
    {
      if (!mesh_.position->residual(t, y, rate, F) || !mesh_.position->setup_jacobian(t, y, rate, 1. / size))
        return;
      mesh_.position->solve_with_jacobian(F, change);
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
        y_                  = y;
        run_->accepted.time = t;
        return;
      }
    }
  }

  /// True if the sum of the error indicators is admissible, or no cell may be divided.
  bool
  Simulation::mesh_is_good(const Step &step, const std::span<const double> y)
  {
    mesh_.indicators = mesh_.discretization->gather(mesh_.position->error_indicators(step.time, y, v_));
    const double sum = std::accumulate(mesh_.indicators.begin(), mesh_.indicators.end(), 0.);
    mesh_.changes.clear();
    if (sum > numerics_.mesh.tolerance)
      mesh_.changes = mark_for_division(mesh_.indicators, *mesh_.discretization, numerics_.mesh);
    double &largest = result().size.largest_indicator;
    if (mesh_.changes.empty())
      largest = std::max(largest, sum);
    return mesh_.changes.empty();
  }

  bool
  Simulation::wants_coarser_mesh(const Step &step)
  {
    constexpr unsigned int max_joins_every = 10;
    if (!is_adaptive() || step.number == 0 || step.number % max_joins_every != 0 || step.time >= 1.)
      return false;
    mesh_.changes = mark_for_joining(mesh_.indicators, *mesh_.discretization, numerics_.mesh);
    return !mesh_.changes.empty();
  }
} // namespace crawler
