// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>

namespace crawler
{
  /// No actuation: m = 0. The simplest generator, and the template for a new one.
  class NoActiveStress : public ActiveStress
  {
  public:
    static constexpr const char *description = "no actuation, m = 0";

    std::unique_ptr<ActiveStressAtPoints>
    at(const std::vector<double> &points) const override;
    std::unique_ptr<ActiveStressAtPoints>
    rate_at(const std::vector<double> &points) const override;
    std::optional<Bounds>
    bounds(const Box &box) const override;
  };
} // namespace crawler
