// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/friction_law.h>

namespace crawler
{
  /// A viscous film under the body: force per present length proportional to the velocity, g(w) = gamma w.
  class NewtonianFriction : public FrictionLaw
  {
  public:
    static constexpr const char *description = "a viscous film: gamma times stretch";

    /// @param gamma friction coefficient [force time/length^2].
    explicit NewtonianFriction(double gamma);

    void
    values(std::span<const double> w, std::span<double> g) const override;
    void
    values_and_log_derivatives(std::span<const double> w, std::span<double> g, std::span<double> w_dg) const override;
    std::unique_ptr<FrictionLaw>
    scaled(double factor) const override;
    double
    exponent(double) const override
    {
      return 1.;
    }

  private:
    const double gamma_;
  };
} // namespace crawler
