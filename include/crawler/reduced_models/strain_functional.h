// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>
#include <crawler/scene/given_motion.h>

#include <array>
#include <optional>
#include <vector>

namespace crawler
{
  /// Strain and its rate, or weights of them, on a grid: [time][point].
  struct StrainSamples
  {
    std::vector<double> strain, rate;

    void
    resize(const std::size_t n)
    {
      strain.resize(n);
      rate.resize(n);
    }
  };

  /**
   * Displacement and works of a body with a given strain (KinematicBody) by quadrature on a fixed grid, and their
   * derivatives by the strain, for the optimisation of gaits. In natural units. With the weights a, b of a number a
   * strain e + x changes it by sum a x + b x_t to first order, exactly for this quadrature: from
   *
   *   d<v> = <(1 - g/<g>) dB_t> - <g' v de>/<g>,   dQ = <g' v^2 de> + 2 <g v dB_t>,   B_t = int_0^s e_t ds,
   *
   * where running integrals are transposed (doc/theory.md, "Prescribed strain").
   */
  class StrainFunctional
  {
  public:
    /// Numbers computed, over 0 <= t <= 1.
    enum Number
    {
      displacement,
      dissipation,
      stress_work,
      positive_work,
      mean_square, ///< int int e^2 ds dt
      n_numbers
    };
    using Values = std::array<double, n_numbers>;

    StrainFunctional(unsigned int n_space_panels, unsigned int n_time_panels);

    const std::vector<double> points, times; ///< places and times of the grid: those of the quadrature, and both ends

    StrainSamples
    sample(const ActiveStress &strain) const;

    /// Values for a strain; nothing if a stretch is not positive. @p body: at points().
    std::optional<Values>
    values(const StrainSamples &samples, const BodyAtPoints &body) const;

    /// Weights of one number.
    StrainSamples
    weights(Number number, const StrainSamples &samples, const BodyAtPoints &body) const;

  private:
    /// Finds motion and active stress at one time; false if a stretch is not positive.
    bool
    evaluate(std::size_t time,
             const StrainSamples &samples,
             const BodyAtPoints &body,
             GivenMotion &motion,
             std::vector<double> &m) const;

    const GaussPanels space_, time_;
    const std::size_t n_; ///< points of the quadrature over the body
    std::vector<double> time_weights_;
  };
} // namespace crawler
