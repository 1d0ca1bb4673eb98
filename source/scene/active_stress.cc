// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/scene/active_stress.h>

namespace crawler
{
  void
  ActiveStress::report(std::ostream &) const
  {
  }
} // namespace crawler
