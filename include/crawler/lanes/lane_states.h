// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/pack.h>
#include <crawler/time/radau_loops.h>

#include <cstddef>

/// States in one step of a pack of bodies (included by radau_step.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Sum, or the larger of two numbers. NaN stays NaN.
  template <bool largest, typename Pack>
  inline Pack
  added(const Pack &a, const Pack &b)
  {
    if constexpr (largest)
      return ((a > b) | (a != a)) ? a : b;
    else
      return a + b;
  }

  /// Sum of the squares of @p n numbers or the largest of them, by several sums that do not wait for each other.
  template <bool largest, typename Pack>
  inline Pack
  squared_size(const Pack *x, const int n)
  {
    constexpr int n_sums = 8;
    Pack sums[n_sums]    = {};
    int d                = 0;
    for (; d + n_sums <= n; d += n_sums)
      for (int i = 0; i < n_sums; ++i)
        sums[i] = added<largest>(sums[i], x[d + i] * x[d + i]);
    for (; d < n; ++d)
      sums[0] = added<largest>(sums[0], x[d] * x[d]);
    for (int i = 1; i < n_sums; ++i)
      sums[0] = added<largest>(sums[0], sums[i]);
    return sums[0];
  }

  template <typename Pack, int s>
  struct LaneStates
  {
    static constexpr radau::Stages<s> stages{};
    const LaneSetup &setup;
    const int n;                         ///< unknowns
    Pack *y = nullptr;                   ///< state at the start of the step
    Pack *z = nullptr, *old_z = nullptr; ///< [stage][unknown] relative to the start, of this step and the last
    Pack *u = nullptr, *v = nullptr;     ///< displacement and velocity at which the equation is evaluated

    void
    lay_out(LaneMemory &memory)
    {
      memory.pieces(n, y, u, v);
      memory.pieces(std::size_t(s) * n, z, old_z);
    }

    /// Starts a body in lane @p l; null: at rest, and without a step before.
    void
    start(const int l, const double *displacement, const double *stages_before)
    {
      for (int i = 0; i < n; ++i)
        set_lane(y[i], l, displacement != nullptr ? displacement[i] : 0.);
      for (int i = 0; i < s * n; ++i)
        set_lane(old_z[i], l, stages_before != nullptr ? stages_before[i] : 0.);
    }

    /// Guesses by the polynomial of the last step continued where @p use is 1, by rest where it is 0. @p start and @p
    /// ratio as in radau::guess_weights.
    void
    guess(const Pack &start, const Pack &ratio, const Pack &use)
    {
      for (int i = 0; i < s; ++i)
      {
        Pack weights[s];
        radau::guess_weights(stages, setup.method.c, setup.method.inverse, i, start, ratio, weights);
        for (int j = 0; j < s; ++j)
          weights[j] = use * weights[j];
        radau::combine(stages, weights, old_z, n, z + i * n);
      }
    }

    /// Sets u and v to those of stage i.
    void
    go_to_stage(const int i, const Pack &inverse_h)
    {
      for (int d = 0; d < n; ++d)
        u[d] = y[d] + z[i * n + d];
      go_to_rate(i, inverse_h);
    }

    void
    go_to_rate(const int i, const Pack &inverse_h)
    {
      radau::stage_rate(stages, setup.method.inverse, i, inverse_h, z, n, v);
    }

    /// Subtracts a correction in the basis of the eigenvectors of A^-1 from z where @p moves; returns the sum of its
    /// squares, or the largest of them. Overwrites u.
    template <bool largest>
    Pack
    correct(const Pack *real, const Complex<Pack> *complex, const typename PackTraits<Pack>::Mask &moves)
    {
      Pack square{};
      for (int i = 0; i < s; ++i)
      {
        Pack *const moved = z + i * n;
#pragma GCC ivdep
        for (int d = 0; d < n; ++d)
          u[d] = radau::from_eigenbasis(stages, setup.method.vectors, i, d, n, real, complex);
#pragma GCC ivdep
        for (int d = 0; d < n; ++d)
          moved[d] = moves ? moved[d] - u[d] : moved[d];
        square = added<largest>(square, squared_size<largest>(u, n));
      }
      return square;
    }

    /// Sets u to the start of the step, and v to that of the embedded formula.
    void
    go_to_start(const Pack &inverse_h)
    {
      radau::error_rate(stages, setup.method.error_weights, setup.method.real_eigenvalue, inverse_h, z, n, v);
      for (int d = 0; d < n; ++d)
        u[d] = y[d];
    }

    /// Keeps the failed try of these bodies as the next guess.
    void
    keep_try(const typename PackTraits<Pack>::Mask &failed)
    {
      for (int i = 0; i < s * n; ++i)
        old_z[i] = failed ? z[i] : old_z[i];
    }

    void
    go_to_end(const typename PackTraits<Pack>::Mask &accepted)
    {
      for (int d = 0; d < n; ++d)
        y[d] = accepted ? y[d] + z[(s - 1) * n + d] : y[d];
      for (int i = 0; i < s * n; ++i)
        old_z[i] = accepted ? z[i] : old_z[i];
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
