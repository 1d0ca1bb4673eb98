// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/log.h>
#include <crawler/studies/optimize/scene_family.h>

#include <optional>

namespace crawler
{
  /// Prints the derivatives of all requested numbers, and of the limited ones where they are most extreme, at @p x
  /// beside differences of the model. Returns true if they agree to 1e-5 of the gradient's size, or, where gaits are
  /// simulated, within their accuracy; nothing if all derivatives are differences themselves.
  std::optional<bool>
  check_gradient(GaitModel &model, const std::vector<double> &x, Log &log);
} // namespace crawler
