// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/instruction_set.h>

/**
 * The Radau IIA methods \cite HairerWanner1996 independently of the equation: stages, first guess, transformation to
 * the eigenbasis of A^-1, embedded error and dense output, as loops over the unknowns of one body (double) or of
 * several side by side (lanes/pack.h). Used by the PETSc type (time/radau.cc), the linear stepper and the lanes.
 *
 * Arrays of stages are [stage][unknown], increments z_i relative to the start of the step. The number of stages @p s is
 * an int, or `Stages<s>` where it is a compile-time constant. The C++ library must not be used here (base/
 * instruction_set.h).
 */
namespace crawler::radau::inline CRAWLER_INSTRUCTION_SET
{
  template <int s>
  struct Stages
  {
    constexpr operator int() const
    {
      return s;
    }
  };
  constexpr int max_stages = 7;

  /// Largest multiple of the last step up to which its polynomial is a good first guess.
  constexpr double longest_extrapolation = 3.;
  /// Constants of the step control: the next step is safety * (1/error)^(1/(s+1)) of the present one, within these
  /// factors.
  constexpr double safety = 0.9, min_change = 0.1, max_change = 5.;
  /// Number of steps after which the disturbance of stiff components by a start, or by a change of mesh, has faded to
  /// traces.
  constexpr unsigned int settling_steps = 3;

  /// Error of a step from which on the next step does not grow.
  template <typename Count>
  inline double
  error_without_growth(const Count s)
  {
    double error = safety;
    for (int i = 0; i < s; ++i)
      error *= safety;
    return error;
  }

  /// Weights of the polynomial through (0, 0) and (c_j, z_j): its value at @p x is sum_j weights_j z_j.
  template <typename Count, typename Number>
  inline void
  collocation_weights(const Count s, const double *c, const Number &x, Number *weights)
  {
    for (int j = 0; j < s; ++j)
    {
      weights[j] = x * (1. / c[j]);
      for (int k = 0; k < s; ++k)
        if (k != j)
          weights[j] *= (x - c[k]) * (1. / (c[j] - c[k]));
    }
  }

  /// Computes result = sum_j weights_j z_j for @p n unknowns.
  template <typename Count, typename Number, typename Weight>
  inline void
  combine(const Count s, const Weight *weights, const Number *z, const int n, Number *result)
  {
    for (int d = 0; d < n; ++d)
    {
      // NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): there is at least one stage
      Number sum = weights[0] * z[d];
      for (int j = 1; j < s; ++j)
        sum += weights[j] * z[j * n + d];
      result[d] = sum;
    }
  }

  /// The rate y' of stage @p i, (1/h) sum_j (A^-1)_ij z_j.
  template <typename Count, typename Number>
  inline void
  stage_rate(const Count s,
             const double *inverse,
             const int i,
             const Number &inverse_h,
             const Number *z,
             const int n,
             Number *rate)
  {
    Number weights[max_stages];
    for (int j = 0; j < s; ++j)
      weights[j] = inverse_h * inverse[i * s + j];
    combine(s, weights, z, n, rate);
  }

  /// The rate with which the residual at the start of the step is that of the embedded formula, -(lambda/h) e.z.
  template <typename Count, typename Number>
  inline void
  error_rate(const Count s,
             const double *error_weights,
             const double real_eigenvalue,
             const Number &inverse_h,
             const Number *z,
             const int n,
             Number *rate)
  {
    combine(s, error_weights, z, n, rate);
    const Number sigma = -real_eigenvalue * inverse_h;
    for (int d = 0; d < n; ++d)
      rate[d] = sigma * rate[d];
  }

  /// Weights that give the increments of stage @p i of a step @p ratio times as long as the last one from those of the
  /// last one: its polynomial continued, and far from it its tangent. @p start: place of the step's start on it, 1 at
  /// the end of the last one, or 0 if that was an attempt at the same step.
  template <typename Count, typename Number>
  inline void
  guess_weights(const Count s,
                const double *c,
                const double *inverse,
                const int i,
                const Number &start,
                const Number &ratio,
                Number *weights)
  {
    const auto is_near = ratio <= Number{} + longest_extrapolation;
    collocation_weights(s, c, Number(start + c[i] * ratio), weights);
    weights[s - 1] -= start; // value of the polynomial at @p start
    for (int j = 0; j < s; ++j)
    {
      const Number tangent = c[i] * ratio * inverse[(s - 1) * s + j];
      weights[j]           = is_near ? weights[j] : tangent;
    }
  }

  template <typename Complex>
  inline auto
  real_part(const Complex &z)
  {
    if constexpr (requires { z.re; })
      return z.re;
    else
      return z.real();
  }
  template <typename Complex>
  inline auto
  imaginary_part(const Complex &z)
  {
    if constexpr (requires { z.im; })
      return z.im;
    else
      return z.imag();
  }

  /// Transforms the right-hand sides @p f of the stages to the eigenbasis of A^-1, where the stages are decoupled: one
  /// @p real one, and (s-1)/2 complex ones [pair][unknown]. @p rows: [1 + pairs][s][real, imaginary] (Hairer and
  /// Wanner, section IV.8).
  template <typename Count, typename Number, typename Complex>
  inline void
  to_eigenbasis(const Count s, const double *rows, const Number *f, const int n, Number *real, Complex *complex)
  {
    for (int d = 0; d < n; ++d)
    {
      Number own[max_stages], sum = Number{};
      for (int j = 0; j < s; ++j)
      {
        own[j] = f[j * n + d];
        sum += rows[2 * j] * own[j];
      }
      real[d] = sum;
      for (int p = 0; p < (s - 1) / 2; ++p)
      {
        const double *row = rows + 2 * (p + 1) * s;
        Number re{}, im{};
        for (int j = 0; j < s; ++j)
        {
          re += row[2 * j] * own[j];
          im += row[2 * j + 1] * own[j];
        }
        complex[p * n + d] = {re, im};
      }
    }
  }

  /// Transforms back, for unknown @p d of stage @p i. @p vectors: [s][1 + pairs][real, imaginary].
  template <typename Count, typename Number, typename Complex>
  inline Number
  from_eigenbasis(const Count s,
                  const double *vectors,
                  const int i,
                  const int d,
                  const int n,
                  const Number *real,
                  const Complex *complex)
  {
    const int pairs = (s - 1) / 2, columns = 1 + pairs;
    Number sum = vectors[2 * i * columns] * real[d];
    for (int p = 0; p < pairs; ++p)
    {
      const double *vector = vectors + 2 * (i * columns + p + 1);
      const Complex &x     = complex[p * n + d];
      sum += 2. * vector[0] * real_part(x) - 2. * vector[1] * imaginary_part(x);
    }
    return sum;
  }
} // namespace crawler::radau::inline CRAWLER_INSTRUCTION_SET
