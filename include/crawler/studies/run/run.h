// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/model_choice.h>
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
  /// The same of a parameter file that is read already.
  ExitCode
  run_input(MPI_Comm communicator, const CommandOptions &options, ParameterFile file);

  /// The lines that say what will be computed.
  void
  report_plan(Log &log, const Input &input, const ModelChoice &model, const NumericsChoice &choice);

  class StopSignal;

  /// What `crawler run` does on a level that needs no mesh (collective; the first rank computes and writes all files,
  /// whose names and contents are those of any run). @p begin (base/clock.h) is when the program began.
  ExitCode
  run_reduced_model(MPI_Comm communicator,
                    const CommandOptions &options,
                    const Input &input,
                    const ModelChoice &choice,
                    const StopSignal &stop_signal,
                    double begin,
                    Log &log);

  /// The same for `crawler check`.
  ExitCode
  check_reduced_model(const Input &input, const ModelChoice &choice, Log &log);
} // namespace crawler
