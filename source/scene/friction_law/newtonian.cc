// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/scene/friction_law/newtonian.h>

#include <algorithm>

namespace crawler
{
  NewtonianFriction::NewtonianFriction(const double gamma)
    : gamma_(gamma)
  {
  }

  void
  NewtonianFriction::values(const std::span<const double> w, const std::span<double> g) const
  {
    for (std::size_t i = 0; i < w.size(); ++i)
      g[i] = gamma_ * w[i];
  }

  void
  NewtonianFriction::values_and_log_derivatives(const std::span<const double> w,
                                                const std::span<double> g,
                                                const std::span<double> w_dg) const
  {
    values(w, g);
    std::copy(g.begin(), g.end(), w_dg.begin());
  }

  std::unique_ptr<FrictionLaw>
  NewtonianFriction::scaled(const double factor) const
  {
    return std::make_unique<NewtonianFriction>(gamma_ * factor);
  }
} // namespace crawler
