// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/finer_run_errors.h>
#include <crawler/run/accuracy_rule.h>
#include <crawler/run/result_table.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    using namespace accuracy_rule::number_bounds;

    double
    number(const ResultEntry &entry, const SimulationResult &result)
    {
      const ResultValue value = entry.value(result);
      const double *found     = std::get_if<double>(&value);
      return found != nullptr ? *found : std::numeric_limits<double>::quiet_NaN();
    }

    double
    scale(const ResultEntry &entry, const SimulationResult &result)
    {
      switch (entry.scale)
      {
        case ResultEntry::Scale::exchanged_work:
          return result.energy_balance ? result.energy_balance->exchanged_work : 0.;
        case ResultEntry::Scale::strain:
          return std::max(1. - result.min_stretch.value, result.max_stretch.value - 1.);
        case ResultEntry::Scale::itself:
          return std::abs(number(entry, result));
        case ResultEntry::Scale::cost:
          return result.gait && result.gait->energy_balance
                   ? result.gait->energy_balance->exchanged_work / std::abs(result.gait->displacement)
                   : 0.;
        case ResultEntry::Scale::none:
          break;
      }
      return 0.;
    }
  } // namespace

  NumberErrors
  number_errors(const SimulationResult &result, const SimulationResult &finer, const double factor, const double part)
  {
    NumberErrors errors;
    const double n_points = result.mesh ? result.mesh->n_cells * (result.mesh->degree + 1.) : 1.;
    const auto &entries   = entries_with_errors();
    for (std::size_t i = 0; i < NumberErrors::n; ++i)
    {
      const ResultEntry &entry = *entries.at(i);
      const double x = std::abs(number(entry, result) - number(entry, finer)), S = scale(entry, result);
      errors.values[i] = entry.is_sampled
                           ? more_if_sampled * factor * x + (part + sampling_error / (n_points * n_points)) * S
                           : factor * x + part * S;
    }
    return errors;
  }
} // namespace crawler
