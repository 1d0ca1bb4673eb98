// SPDX-License-Identifier: LGPL-2.1-or-later
#include "command.h"

#include <crawler/studies/core/input.h>
#include <crawler/studies/optimize/optimize.h>
#include <crawler/studies/optimize/optimize_cases.h>
#include <crawler/studies/run/run.h>
#include <crawler/studies/sweep/sweep.h>
#include <crawler/studies/sweep/sweep_points.h>

namespace crawler
{
  std::pair<int, std::vector<std::string>>
  run_command(const std::string &name, const CommandOptions &options, const ParameterFile &file)
  {
    const auto notes    = name == "run"     ? read_input(file).notes
                          : name == "sweep" ? SweepPoints(MPI_COMM_SELF, file).notes()
                                            : OptimizeCases(MPI_COMM_SELF, file).notes(file);
    const ExitCode code = name == "sweep"      ? sweep(MPI_COMM_SELF, options, file)
                          : name == "optimize" ? optimize(MPI_COMM_SELF, options, file)
                                               : run(MPI_COMM_SELF, options, file);
    return {static_cast<int>(code), notes};
  }
} // namespace crawler
