// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/choose_numerics.h>
#include <crawler/app/check.h>
#include <crawler/base/communication.h>
#include <crawler/run/simulation.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/progress.h>
#include <crawler/studies/core/scene_numbers.h>
#include <crawler/studies/optimize/optimize.h>
#include <crawler/studies/run/run_files.h>
#include <crawler/studies/sweep/sweep.h>

#include <fmt/format.h>

namespace crawler
{
  ExitCode
  check(MPI_Comm communicator, const CommandOptions &options, const ParameterFile &file)
  {
    Log log(rank_of(communicator) == 0, /*quiet=*/false);
    if (check_optimize(communicator, file, log) || check_sweep(communicator, file, log))
      return ExitCode::finished;
    const Input input = read_input(file, /*command=*/"check");
    if (const FitParameters &fit = input.parameters.fit; !trimmed(fit.variables).empty())
      log.line(fmt::format("Fit: {} unknown, from {}, which only crawler fit reads.",
                           read_variables(input.file, "Fit/Variables").size(),
                           fit.data.empty() ? "the file given with --data" : fit.data));
    const ModelChoice model = choose_model(input);
    if (!model.needs_mesh())
    {
      report_plan(log, input, model, nullptr);
      log.line("No mesh and no time steps are needed.");
      log.line(input.file.name() + " is valid; no files were written.");
      return ExitCode::finished;
    }
    WaitProgress pilots(log, pilot_runs);
    NumericsChoice choice = *choose_numerics({input.parameters, input.scene, [&]() {
                                                pilots.step();
                                                return true;
                                              }});
    if (input.parameters.output.has_snapshots())
      prepare_for_pictures(choice, input.parameters);
    const Simulation simulation(MPI_COMM_SELF, input.scene, input.parameters.time, choice.numerics);
    report_plan(log, input, model, &choice);
    log.line(
      fmt::format("Output: {} snapshots{}{}{}, to \"{}\" unless --output is given.",
                  picture_times(input.parameters.output, input.scene).n_snapshots(),
                  input.parameters.output.kymograph && input.parameters.output.has_snapshots() ? ", kymograph" : "",
                  input.parameters.output.statistics ? ", statistics" : "",
                  input.parameters.output.energy_balance ? ", energy balance" : "",
                  output_folder(options.output, options.file).string()));
    log.line(input.file.name() + " is valid; only pilot runs were made, and no files were written.");
    return ExitCode::finished;
  }
} // namespace crawler
