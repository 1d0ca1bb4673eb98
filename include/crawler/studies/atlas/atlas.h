// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/run/run.h>

namespace crawler
{
  /**
   * crawler atlas: a map over two entries of the parameter file. Every point is run in all forms and refined, and the
   * answers are compared (cross_check.h). The ranks share the points (collective).
   */
  ExitCode
  atlas(MPI_Comm communicator, const CommandOptions &options);
} // namespace crawler
