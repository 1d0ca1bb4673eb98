// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/newton_velocity.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace crawler
{
  namespace
  {
    constexpr unsigned int max_corrections = 50, max_halvings = 20;
    /// Correction, as a part of the velocity, below which it is the last one: more change nothing.
    constexpr double small = 1e-10;
    /// Corrections below this part, or below tiny in natural units, are round-off; and below tiny as a part.
    constexpr double acceptable = 1e-7, tiny = 1e-13;

    double
    largest(const std::span<const double> x, const Discretization &discretization)
    {
      double result = 0.;
      for (const double value : x)
        result = std::isfinite(value) ? std::max(result, std::abs(value)) : HUGE_VAL;
      if (discretization.n_ranks > 1)
        MPI_Allreduce(MPI_IN_PLACE, &result, 1, MPI_DOUBLE, MPI_MAX, discretization.communicator);
      return result;
    }
  } // namespace

  bool
  newton_velocity(const Discretization &discretization,
                  const std::span<double> v,
                  const std::function<bool(std::span<const double>, std::span<double>)> &residual,
                  const std::function<bool(std::span<const double>, std::span<double>)> &solve)
  {
    std::vector<double> F(v.size()), trial(v.size()), change(v.size());
    if (!residual(v, F))
      return false;
    double norm = largest(F, discretization);
    for (unsigned int i = 0; norm > 0. && i < max_corrections; ++i)
    {
      change = F;
      if (!solve(v, change))
        return false;
      const double correction = largest(change, discretization);
      if (!std::isfinite(correction))
        return false;
      double part = 1., new_norm = HUGE_VAL;
      for (unsigned int j = 0; j < max_halvings; ++j, part *= 0.5)
      {
        for (std::size_t k = 0; k < v.size(); ++k)
          trial[k] = v[k] - part * change[k];
        if (!residual(trial, F))
          return false;
        new_norm = largest(F, discretization);
        if (new_norm < norm || i == 0) // the first one solves the linear case
          break;
      }
      if (!(new_norm < norm) && i > 0) // round-off, or no descent
        return correction <= std::max(acceptable * largest(v, discretization), tiny);
      // Linear friction leaves round-off alone: the next correction would be smaller by as much as the residual is.
      const double next = correction * new_norm / norm;
      std::copy(trial.begin(), trial.end(), v.begin());
      norm              = new_norm;
      const double size = largest(v, discretization);
      if (part == 1. && (correction <= small * size || next <= tiny * size))
        return true;
    }
    return norm == 0.;
  }
} // namespace crawler
