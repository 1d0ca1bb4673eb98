// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/finer_run_errors.h>
#include <crawler/run/accuracy_rule.h>
#include <crawler/run/result_table.h>

#include <algorithm>
#include <cmath>
#include <utility>

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
      const double x = std::abs(number(entry, result) - number(entry, finer)), S = entry.scale_in(result);
      errors.values[i] = entry.is_sampled
                           ? more_if_sampled * factor * x + (part + sampling_error / (n_points * n_points)) * S
                           : factor * x + part * S;
      // Two meshes may have the same error at the ends of their cells.
      for (const auto &[key, extreme] :
           {std::pair("min_stretch.value", &result.min_stretch), {"max_stretch.value", &result.max_stretch}})
        if (entry.key == key)
          errors.values[i] = std::max(errors.values[i], extreme->jump);
    }
    return errors;
  }

  NumberErrors
  errors_of_extrapolation(const SimulationResult &extrapolated,
                          const std::span<const SimulationResult *const> meshes,
                          const double part)
  {
    const SimulationResult &finest = *meshes.back();
    NumberErrors errors            = number_errors(extrapolated, finest, 1., part);
    const auto &entries            = entries_with_errors();
    for (std::size_t before = 1; before <= 2 && before < meshes.size(); ++before)
    {
      const double factor        = if_not_extrapolated / static_cast<double>(before);
      const NumberErrors changes = number_errors(finest, *meshes[meshes.size() - 1 - before], factor, part);
      for (std::size_t i = 0; i < NumberErrors::n; ++i)
        if (number(*entries.at(i), extrapolated) == number(*entries.at(i), finest))
          errors.values[i] = std::max(errors.values[i], changes.values[i]);
    }
    return errors;
  }
} // namespace crawler
