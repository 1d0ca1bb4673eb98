// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>
#include <crawler/base/exceptions.h>
#include <crawler/studies/core/command_options.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/log.h>

#include <mpi.h>

namespace crawler
{
  /// crawler run: one simulation with all its files (collective).
  ExitCode
  run(MPI_Comm communicator, const CommandOptions &options);

  /// The lines that say what will be computed.
  void
  report_plan(Log &log, const Input &input, const ModelChoice &model, const NumericsChoice &choice);
} // namespace crawler
