// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/gait_efficiency.h>
#include <crawler/run/result_table.h>
#include <crawler/run/self_check.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace crawler
{
  namespace
  {
    // Constants measured by tests/verification/identities_test.cc; doc/numerics.md, "Energy balance and self-checks".
    /// Energy residual, relative: in units of Accuracy for each form, and at least.
    constexpr double of_accuracy = 10., of_accuracy_in_stretch_form = 300., min_residual = 1e-8;
    /// Energy residuals with the user's numerics; for moving jumps; above which stretch-form works are unknown.
    constexpr double residual_of_users = 0.1, residual_of_moving_jumps = 0.2, residual_of_known_works = 0.1;
    /// Net friction, relative to the absolute one: at least; in units of Accuracy; with the user's own steps.
    constexpr double min_net_friction = 1e-6, net_friction_of_accuracy = 0.1, net_friction_of_users = 1e-3;

    /// True if the integration in time is the user's own, whose errors do not follow Accuracy.
    bool
    has_own_steps(const RunParameters &parameters)
    {
      return parameters.time.tolerance ||
             (parameters.time.integrator != "automatic" && parameters.time.integrator != "bdf") ||
             parameters.time.order < 4 || parameters.time.step_control == StepControl::fixed;
    }
  } // namespace

  double
  energy_balance_tolerance(const SimulationResult &result, const RunParameters &parameters)
  {
    return parameters.output.energy_balance_tolerance.value_or(
      result.process.jumps_move ? residual_of_moving_jumps
      : has_own_steps(parameters)
        ? residual_of_users
        : std::max(min_residual,
                   (result.process.formulation == Formulation::stretch ? of_accuracy_in_stretch_form : of_accuracy) *
                     parameters.accuracy));
  }

  namespace
  {
    /// Covers the energy residual |W - Q - (elastic energy) ...|: any one of the energies may account for all of it,
    /// and has an error besides that a finer run shows.
    void
    cover_residual(SimulationResult &result)
    {
      const auto &entries = entries_with_errors();
      for (std::size_t i = 0; i < result.errors.size(); ++i)
        if (entries[i]->scale == ResultEntry::Scale::exchanged_work || entries[i]->scale == ResultEntry::Scale::cost)
          result.errors[i] += result.energy_balance->residual() * entries[i]->scale_in(result);
    }

    /// Complaint about a gait better than the bound by more than the error of its efficiency and the energy residual.
    std::string
    complaint_about_efficiency(const SimulationResult &result)
    {
      const auto complaint = [&result](const std::string &words,
                                       const std::string &key,
                                       const std::optional<double> &efficiency,
                                       const double energy) -> std::string {
        const auto error = error_bound(result, key);
        if (!efficiency || !error)
          return "";
        const EnergyBalance &balance = *result.energy_balance;
        const double lacking         = 0.5 * balance.residual() * balance.exchanged_work / energy * *efficiency;
        if (!(*efficiency > 1. + *error + lacking))
          return "";
        return fmt::format("the gait efficiency {}is {:.6g} +- {:.2g}, but no gait can exceed 1; a smaller Accuracy or "
                           "a finer mesh is needed",
                           words,
                           *efficiency,
                           *error + lacking);
      };
      std::string whole =
        complaint("", "gait.efficiency", result.gait_efficiency, energy_of_bound(*result.energy_balance));
      if (!whole.empty() || !result.gait || !result.gait->energy_balance)
        return whole;
      return complaint("of the last stride ",
                       "gait.stride_efficiency",
                       result.gait->efficiency,
                       result.gait->energy_balance->dissipation);
    }

    /// True if other meshes confirm the displacement of the stretch form. Where friction is steep its works need far
    /// shorter steps.
    bool
    stands_without_works(const SimulationResult &result)
    {
      return result.process.formulation == Formulation::stretch && result.error && std::isfinite(result.error->total);
    }

    /// Makes energies, costs and efficiencies unknown.
    void
    forget_works(SimulationResult &result)
    {
      result.residuals.unknown_works = result.energy_balance->residual();
      result.energy_balance.reset();
      result.gait_efficiency.reset();
      if (result.gait)
      {
        result.gait->energy_balance.reset();
        result.gait->efficiency.reset();
      }
      const auto &entries = entries_with_errors();
      for (std::size_t i = 0; i < result.errors.size(); ++i)
        if (std::holds_alternative<std::monostate>(entries[i]->value(result)))
          result.errors[i] = std::numeric_limits<double>::quiet_NaN();
    }
  } // namespace

  void
  check_identities(SimulationResult &result, const RunParameters &parameters)
  {
    // Series have no balance to check.
    if (result.time.status != Status::finished || !result.energy_balance || result.process.model == Model::perturbation)
      return;
    // Works may be less accurate than the displacement: a sudden start of a stiff body makes layers that take work, but
    // do not move it.
    double tolerance     = energy_balance_tolerance(result, parameters);
    const bool is_wanted = parameters.output.energy_balance_tolerance.has_value();
    if (!is_wanted && stands_without_works(result) &&
        !(result.energy_balance->residual() <= std::max(tolerance, residual_of_known_works)))
    {
      forget_works(result);
      return;
    }
    if (const auto error = error_bound(result, "stress_power"); error && !is_wanted)
      tolerance = std::max(tolerance, *error / result.energy_balance->exchanged_work);
    if (!(result.energy_balance->residual() <= tolerance))
    {
      result.time.reason = "ledger_residual";
      result.time.message =
        fmt::format("the energy balance does not close: its residual is {:.3g}, above {:.3g}; a smaller "
                    "Time/Tolerance (or Accuracy) is needed",
                    result.energy_balance->residual(),
                    tolerance);
    }
    else if (const double most = has_own_steps(parameters)
                                   ? net_friction_of_users
                                   : std::max(min_net_friction, net_friction_of_accuracy * parameters.accuracy);
             result.residuals.net_friction > most)
    {
      result.time.reason = "net_friction";
      result.time.message =
        fmt::format("the friction forces do not balance: {:.3g} of their sum is left over, above {:.3g}",
                    result.residuals.net_friction,
                    most);
    }
    else
    {
      cover_residual(result);
      result.time.message = complaint_about_efficiency(result);
      if (result.time.message.empty())
        return;
      result.time.reason = "gait_efficiency";
    }
    result.time.status = Status::failed;
  }
} // namespace crawler
