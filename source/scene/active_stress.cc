// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/scene/active_stress.h>

namespace crawler
{
  std::optional<double>
  ActiveStress::period() const
  {
    return std::nullopt;
  }

  void
  ActiveStress::report(std::ostream &) const
  {
  }
} // namespace crawler
