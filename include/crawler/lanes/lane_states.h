// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/pack.h>

#include <cstddef>

/// The states in one step of a pack of bodies (included by radau_lanes.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// The polynomial of the last step is a good guess up to this multiple of the step.
  constexpr double longest_extrapolation = 3.;

  /// A sum, or the larger one. What is not a number stays one.
  template <bool largest, typename Pack>
  inline Pack
  added(const Pack &a, const Pack &b)
  {
    if constexpr (largest)
      return (a > b) | (a != a) ? a : b;
    else
      return a + b;
  }

  template <typename Pack, int s>
  struct LaneStates
  {
    const LaneSetup &setup;
    const int n;                         ///< unknowns
    Pack *y = nullptr;                   ///< at the start of the step
    Pack *z = nullptr, *old_z = nullptr; ///< [stage][unknown] relative to the start, of this step and the last
    Pack *u = nullptr, *v = nullptr;     ///< displacement and velocity where the equation is looked at

    void
    lay_out(LaneMemory &memory)
    {
      memory.piece(y, n);
      memory.piece(z, std::size_t(s) * n);
      memory.piece(old_z, std::size_t(s) * n);
      memory.piece(u, n);
      memory.piece(v, n);
    }

    /// A new body in lane @p l; null: at rest.
    void
    start(const int l, const double *displacement)
    {
      for (int i = 0; i < n; ++i)
        set_lane(y[i], l, displacement != nullptr ? displacement[i] : 0.);
      for (int i = 0; i < s * n; ++i)
        set_lane(old_z[i], l, 0.);
    }

    /// The polynomial of the last step continued where @p use is 1, or rest where it is 0. @p ratio: of the step to the
    /// last one.
    void
    guess(const Pack &ratio, const Pack &use)
    {
      const double *c    = setup.c;
      const auto is_near = ratio <= broadcast<Pack>(longest_extrapolation);
      for (int i = 0; i < s; ++i)
      {
        Pack weights[s];
        const Pack x = 1. + c[i] * ratio;
        for (int j = 0; j < s; ++j)
        {
          Pack weight = x * (1. / c[j]); // of the polynomial through (0, 0) and (c_k, z_k), less its value at 1
          for (int k = 0; k < s; ++k)
            if (k != j)
              weight *= (x - c[k]) * (1. / (c[j] - c[k]));
          if (j == s - 1)
            weight -= 1.;
          const Pack tangent = c[i] * ratio * setup.inverse[(s - 1) * s + j];
          weights[j]         = use * (is_near ? weight : tangent);
        }
        Pack *result = z + i * n;
        for (int d = 0; d < n; ++d)
        {
          Pack sum = weights[0] * old_z[d];
          for (int j = 1; j < s; ++j)
            sum += weights[j] * old_z[j * n + d];
          result[d] = sum;
        }
      }
    }

    /// u and v of stage i.
    void
    go_to_stage(const int i, const Pack &inverse_h)
    {
      Pack weights[s];
      for (int j = 0; j < s; ++j)
        weights[j] = inverse_h * setup.inverse[i * s + j];
      for (int d = 0; d < n; ++d)
      {
        u[d]     = y[d] + z[i * n + d];
        Pack sum = weights[0] * z[d];
        for (int j = 1; j < s; ++j)
          sum += weights[j] * z[j * n + d];
        v[d] = sum;
      }
    }

    /// Takes a correction in the basis of the eigenvectors of A^-1 from z where @p moves; returns the sum of its
    /// squares, or the largest of them.
    template <bool largest>
    Pack
    correct(const Pack *real, const Complex<Pack> *complex, const typename PackTraits<Pack>::Mask &moves)
    {
      constexpr int pairs = (s - 1) / 2, columns = 1 + pairs;
      Pack square{};
      for (int d = 0; d < n; ++d)
        for (int i = 0; i < s; ++i)
        {
          Pack change = setup.vectors[2 * i * columns] * real[d];
          for (int p = 0; p < pairs; ++p)
          {
            const double *vector   = setup.vectors + 2 * (i * columns + p + 1);
            const Complex<Pack> &x = complex[p * n + d];
            change += 2. * vector[0] * x.re - 2. * vector[1] * x.im;
          }
          square      = added<largest>(square, change * change);
          Pack &moved = z[i * n + d];
          moved       = moves ? moved - change : moved;
        }
      return square;
    }

    /// u at the start of the step, and v of the embedded formula.
    void
    go_to_start(const Pack &inverse_h)
    {
      const Pack sigma = -setup.real_eigenvalue * inverse_h;
      for (int d = 0; d < n; ++d)
      {
        Pack sum = setup.error_weights[0] * z[d];
        for (int j = 1; j < s; ++j)
          sum += setup.error_weights[j] * z[j * n + d];
        v[d] = sigma * sum;
        u[d] = y[d];
      }
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
