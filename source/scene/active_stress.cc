// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/scene/active_stress.h>

namespace crawler
{
  std::optional<double>
  ActiveStress::period() const
  {
    return std::nullopt;
  }

  std::vector<double>
  ActiveStress::breaks_in_space() const
  {
    return {};
  }

  std::vector<double>
  ActiveStress::breaks_in_time() const
  {
    return {};
  }

  const StretchFeedback *
  ActiveStress::feedback() const
  {
    return nullptr;
  }

  std::unique_ptr<ActiveStressAtPoints>
  ActiveStress::rate_at(const std::vector<double> &) const
  {
    return nullptr;
  }

  const StrainHistory *
  ActiveStress::prescribed_strain() const
  {
    return nullptr;
  }

  void
  ActiveStress::report(std::ostream &) const
  {
  }
} // namespace crawler
