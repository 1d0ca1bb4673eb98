// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The part of Simulation that adds up: works and energies, extremes, the past (doc/numerics.md, "Energy balance and
// self-checks").
#include <crawler/run/simulation.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  RateQuadrature::Rates
  Simulation::rates(const double t,
                    const CellIntegrals &sums,
                    const std::span<const double> y,
                    const std::span<const double> v)
  {
    if (!end_power_)
      end_power_ = std::make_unique<EndPower>(*assembler_);
    return {{sums.stress_power, sums.dissipation, sums.positive_power, sums.absolute_power, (*end_power_)(t, y, v)}};
  }

  /// The rates integrated over the step by the formula of the integrator itself. The states within the step are looked
  /// at for extremes of the stretch, too.
  RateQuadrature::Rates
  Simulation::integrate_step(const Step &step, const RateQuadrature::Rates &at_end)
  {
    RateQuadrature::Rates sum{};
    if (step.size == 0.)
      return sum;
    y_inside_.resize(y_.size());
    v_inside_.resize(v_.size());
    for (const auto &point : stepper_->quadrature())
    {
      RateQuadrature::Rates inside = at_end;
      if (point.place < 1.)
      {
        const double t = step.time - (1. - point.place) * step.size;
        stepper_->interpolate(t, y_inside_);
        velocity(t, step.size, y_inside_, v_inside_);
        inside = rates(t, assembler_->integrals(t, y_inside_, v_inside_), y_inside_, v_inside_);
        look_at_extremes(t, assembler_->stretch_range(y_inside_), /*is_first=*/false);
      }
      for (std::size_t i = 0; i < sum.size(); ++i)
        sum[i] += step.size * point.weight * inside[i];
    }
    return sum;
  }

  /// Where the feedback sees the past: the stretch within the step, from the integrator's dense output.
  void
  Simulation::keep_history(const Step &step, const std::span<const double> y)
  {
    if (delay_ == 0. || step.size == 0.)
      return;
    // The step starts from the last accepted state, of which the integrator may know less than of what is inside.
    StretchHistory::Step record{accepted_time_, step.time, history_cells_, &discretization_->element(), {}};
    std::vector<double> inside(y.size());
    for (std::size_t i = 0; i < record.coefficients.size(); ++i)
    {
      const double place            = StretchHistory::places()[i];
      std::span<const double> state = place == 0. ? std::span<const double>(accepted_) : y;
      if (place > 0. && place < 1.)
      {
        stepper_->interpolate(record.from + place * (record.to - record.from), inside);
        state = inside;
      }
      record.coefficients[i] = discretization_->gather(assembler_->stretch_coefficients(state));
    }
    history_.add(std::move(record), step.time - 2. * delay_);
  }

  void
  Simulation::look_at_extremes(const double t, const StretchRange &range, const bool is_first)
  {
    const Extreme least{range.min.value, range.min.s, t}, most{range.max.value, range.max.s, t};
    if (is_first)
    {
      min_history_.start(least);
      max_history_.start(most);
    }
    else
    {
      min_history_.add(least);
      max_history_.add(most);
    }
    result_.min_stretch = min_history_.extreme();
    result_.max_stretch = max_history_.extreme();
  }

  /// Displacement, and if wanted the energy balance, at an accepted state.
  bool
  Simulation::compute_integrals(const Step &step, const std::span<const double> y)
  {
    if (!options_.energy_balance && !has_observers_)
      return true;
    integrals_           = assembler_->integrals(step.time, y, v_);
    result_.displacement = integrals_.displacement;
    if (!options_.energy_balance && !step.is_output_time && step.number != 0)
      return true;
    if (!std::isfinite(integrals_.dissipation))
    {
      diagnosis_ = {"failed",
                    "nonfinite",
                    fmt::format("the velocity at t = {:.6g} is not a finite number; the smallest stretch is {:.3g} at "
                                "s = {:.6g}",
                                step.time * units_.time,
                                stretch_.min.value,
                                stretch_.min.s * units_.length)};
      return false;
    }
    if (!options_.energy_balance)
      return true;
    EnergyBalance &energy_balance   = *result_.energy_balance;
    const RateQuadrature::Rates now = rates(step.time, integrals_, y, v_);
    const RateQuadrature::Rates increment =
      stepper_->quadrature().empty() ? quadrature_.advance(step.time, now) : integrate_step(step, now);
    energy_balance.stress_power += increment[0];
    energy_balance.dissipation += increment[1];
    energy_balance.positive_power += increment[2];
    energy_balance.exchanged += increment[3];
    energy_balance.end_work += increment[4];
    energy_balance.elastic_energy = integrals_.elastic_energy;
    if (step.number == 0)
      energy_balance.initial_energy = integrals_.elastic_energy;
    largest_friction_     = std::max(largest_friction_, integrals_.abs_friction);
    largest_net_friction_ = std::max(largest_net_friction_, std::abs(integrals_.net_friction));
    if (largest_friction_ > 0.)
      result_.net_friction = largest_net_friction_ / largest_friction_;
    return true;
  }
} // namespace crawler
