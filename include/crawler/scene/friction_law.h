// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>
#include <optional>
#include <span>

namespace crawler
{
  /**
   * Resistance of the ground per reference length and velocity, g(w), as a function of the stretch
   * w = zeta_s > 0. The friction force per reference length is g(w) zeta_t.
   */
  class FrictionLaw
  {
  public:
    explicit FrictionLaw(const bool its_is_power_law = false)
      : is_power_law(its_is_power_law)
    {
    }
    virtual ~FrictionLaw() = default;

    const bool is_power_law; ///< with the exponent of the body: the only law of plain scenes (Scene::is_plain())

    /// Computes g [force time/length^2] at all stretches @p w and, unless @p w_dg is empty, its derivative with respect
    /// to the logarithm of the stretch, w dg/dw (spans of one length).
    virtual void
    values(std::span<const double> w, std::span<double> g, std::span<double> w_dg = {}) const = 0;

    /// g at one stretch.
    double
    value(double w) const;

    /// The law with another coefficient: g times @p factor.
    virtual std::unique_ptr<FrictionLaw>
    scaled(double factor) const = 0;

    /// Exponent w g'/g [1] at the stretch @p w: the exponent of the tangent power law.
    virtual double
    exponent(double w) const;
  };

  /// The p-model g(w) = gamma w^a, a = 1 - p, of Santhosh and Serra @cite SanthoshSerra2022 .
  class PowerFriction : public FrictionLaw
  {
  public:
    /// @param gamma friction coefficient [force time/length^2]; @param a exponent [1]; @param its_is_power_law false if
    /// the exponent is not that of the body.
    PowerFriction(double gamma, double a, bool its_is_power_law = true);

    void
    values(std::span<const double> w, std::span<double> g, std::span<double> w_dg = {}) const override;
    std::unique_ptr<FrictionLaw>
    scaled(const double factor) const override
    {
      return std::make_unique<PowerFriction>(gamma_ * factor, a_, is_power_law);
    }
    double
    exponent(double) const override
    {
      return a_;
    }

  private:
    const double gamma_;
    const double a_;
    const bool a_is_small_integer_; ///< powers are then products, much cheaper than pow()
  };

  /// Bound of the merit of gaits with stretches between two positive numbers: F of D <= F sqrt(W T/L), the largest
  /// 1/sqrt(g) less the smallest (doc/theory.md, "Gait efficiency"). 0 if they differ by round-off only.
  double
  largest_merit(const FrictionLaw &friction, double from, double to);

  /// A stretch between two positive numbers where g is not positive and finite; nothing if none is found.
  std::optional<double>
  stretch_without_friction(const FrictionLaw &friction, double from, double to);
} // namespace crawler
