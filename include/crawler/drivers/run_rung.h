// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/drivers/input.h>
#include <crawler/drivers/model_choice.h>
#include <crawler/drivers/run.h>

#include <chrono>

namespace crawler
{
  class Log;
  class StopSignal;

  /// What `crawler run` does on a rung that needs no mesh (collective; the first rank computes and writes all files,
  /// whose names and contents are those of any run). @p start is when the program started.
  ExitCode
  run_rung(MPI_Comm communicator,
           const CommandOptions &options,
           const Input &input,
           const ModelChoice &choice,
           const StopSignal &stop_signal,
           std::chrono::steady_clock::time_point start,
           Log &log);

  /// The same for `crawler check`.
  ExitCode
  check_rung(const Input &input, const ModelChoice &choice, Log &log);
} // namespace crawler
