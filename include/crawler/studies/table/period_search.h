// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/table/samples.h>

#include <optional>

namespace crawler
{
  /// The shortest time after which samples without gaps repeat themselves, found by the mean square difference of the
  /// samples and those later on; the duration must be at least 1.25 times as long. Nothing if nothing repeats.
  std::optional<double>
  find_period(const Samples &samples);
} // namespace crawler
