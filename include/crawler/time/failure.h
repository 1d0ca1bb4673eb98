// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/time/stepper.h>

#include <exception>

namespace crawler
{
  /// Outcome of a computation that has thrown @p error: failed, with a reason of doc/user_guide.md and the error's
  /// message. InputError and FileError, which the user has to mend, are thrown again.
  TimeOutcome
  failure_of(const std::exception_ptr &error);
} // namespace crawler
