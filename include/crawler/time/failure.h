// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/time/stepper.h>

#include <exception>

namespace crawler
{
  /// How a computation ended that has thrown @p error: failed, with a reason of doc/user_guide.md and what was thrown
  /// as message. What the user has to mend is no such end: InputError and FileError are thrown again.
  TimeOutcome
  failure_of(const std::exception_ptr &error);
} // namespace crawler
