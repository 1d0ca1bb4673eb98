// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/scene/active_stress/none.h>

#include <algorithm>

namespace crawler
{
  namespace
  {
    class Zero : public ActiveStressAtPoints
    {
      void
      values(double, const std::span<double> m) override
      {
        std::fill(m.begin(), m.end(), 0.);
      }
    };
  } // namespace

  std::unique_ptr<ActiveStressAtPoints>
  NoActiveStress::at(const std::vector<double> &) const
  {
    return std::make_unique<Zero>();
  }

  std::unique_ptr<ActiveStressAtPoints>
  NoActiveStress::rate_at(const std::vector<double> &) const
  {
    return std::make_unique<Zero>();
  }

  std::optional<ActiveStress::Bounds>
  NoActiveStress::bounds(const Box &) const
  {
    return Bounds{0., 0.};
  }
} // namespace crawler
