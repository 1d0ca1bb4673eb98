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

  /// Mesh and steps, for the user.
  std::string
  in_words(const Numerics &numerics, const Input &input);

  /// The lines that say what will be computed. @p choice: null on a level that needs no mesh.
  void
  report_plan(Log &log, const Input &input, const ModelChoice &model, const NumericsChoice *choice);
} // namespace crawler
