// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/scene/friction_law/expression_friction.h>

namespace crawler
{
  ExpressionFriction::ExpressionFriction(const double gamma, std::shared_ptr<const Formula> formula)
    : gamma_(gamma)
    , formula_(std::move(formula))
    , gradient_(formula_)
  {
  }

  void
  ExpressionFriction::values(const std::span<const double> w, const std::span<double> g) const
  {
    const std::span<const double> stretch[] = {w};
    gradient_.evaluate(stretch, g);
    for (double &value : g)
      value *= gamma_;
  }

  void
  ExpressionFriction::values_and_log_derivatives(const std::span<const double> w,
                                                 const std::span<double> g,
                                                 const std::span<double> w_dg) const
  {
    const std::span<const double> stretch[] = {w};
    const std::span<double> derivatives[]   = {w_dg};
    gradient_.evaluate(stretch, g, derivatives);
    for (std::size_t i = 0; i < w.size(); ++i)
    {
      g[i] *= gamma_;
      w_dg[i] *= gamma_ * w[i];
    }
  }

  std::unique_ptr<FrictionLaw>
  ExpressionFriction::scaled(const double factor) const
  {
    return std::make_unique<ExpressionFriction>(gamma_ * factor, formula_);
  }
} // namespace crawler
