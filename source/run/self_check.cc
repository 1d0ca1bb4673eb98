// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/self_check.h>

#include <fmt/format.h>

#include <algorithm>

namespace crawler
{
  double
  energy_balance_tolerance(const SimulationResult &result, const RunParameters &parameters)
  {
    const bool own_numerics = parameters.time.tolerance ||
                              (parameters.time.integrator != "automatic" && parameters.time.integrator != "bdf") ||
                              parameters.time.order < 4 || parameters.time.step_control == "fixed";
    return parameters.output.energy_balance_tolerance.value_or(
      result.jumps_move ? 0.2
      : own_numerics    ? 0.1
                     : std::max(1e-8, (result.formulation == Formulation::stretch ? 300. : 10.) * parameters.accuracy));
  }

  void
  check_identities(SimulationResult &result, const RunParameters &parameters)
  {
    if (result.time.status != "finished" || !result.energy_balance)
      return;
    const double tolerance              = energy_balance_tolerance(result, parameters);
    constexpr double friction_tolerance = 1e-6;
    std::string problem;
    if (!(result.energy_balance->residual() <= tolerance))
    {
      result.time.reason = "ledger_residual";
      result.time.message =
        fmt::format("the energy balance does not close: its residual is {:.3g}, above {:.3g}; a smaller "
                    "Time/Tolerance (or Accuracy) is needed",
                    result.energy_balance->residual(),
                    tolerance);
    }
    else if (result.net_friction > friction_tolerance) // it is not known for a series
    {
      result.time.reason = "net_friction";
      result.time.message =
        fmt::format("the friction forces do not balance: {:.3g} of their sum is left over, above {:.3g}",
                    result.net_friction,
                    friction_tolerance);
    }
    else
      return;
    result.time.status = "failed";
  }
} // namespace crawler
