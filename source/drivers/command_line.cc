// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/versions.h>
#include <crawler/drivers/command_line.h>
#include <crawler/drivers/parameters.h>
#include <crawler/drivers/run.h>
#include <crawler/parameters/declarations.h>

#include <deal.II/base/mpi.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <iostream>

namespace crawler
{
  namespace
  {
    int
    report_error(MPI_Comm communicator, const ExitCode code, const std::string &message, const bool on_all_ranks)
    {
      if (!on_all_ranks || rank_of(communicator) == 0)
        std::cerr << "crawler: " << message << std::endl;
      // A rank that fails alone must not leave the others waiting.
      if (!on_all_ranks && size_of(communicator) > 1)
        MPI_Abort(communicator, static_cast<int>(code));
      return static_cast<int>(code);
    }

    std::string
    version_text()
    {
      std::string text;
      for (const auto &[name, version] : versions())
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, version);
      return text;
    }

    int
    print_parameters(const std::string &format)
    {
      Parameters   parameters;
      Declarations declarations;
      parameters.add_parameters(declarations);
      if (format == "json")
        declarations.print_json(std::cout);
      else if (format == "markdown")
        declarations.print_markdown(std::cout);
      else
        declarations.print_prm(std::cout);
      return 0;
    }

    int
    dispatch(MPI_Comm communicator, const std::vector<std::string> &arguments)
    {
      const bool first = rank_of(communicator) == 0;
      CLI::App   app("Crawler: the limbless crawler, a body that pushes itself along by waves of active stress.", "crawler");
      app.set_version_flag("--version", version_text());
      app.require_subcommand(1);
      app.footer("Options for PETSc go behind a lone \"--\", e.g. crawler run FILE.prm -- -ts_monitor");

      CommandOptions options;
      options.command_line = fmt::format("crawler {}", fmt::join(arguments, " "));
      const auto common    = [&](CLI::App *command) {
        command->add_option("FILE", options.file, "Parameter file; - reads standard input")->required();
        command->add_option("--set", options.overrides, "Sets an entry: \"Section/Entry=value\" (repeatable)")
          ->allow_extra_args(false)
          ->take_all();
        command->add_option("--output", options.output, "Output folder (default: output-NAME for NAME.prm)");
      };
      CLI::App *run_command = app.add_subcommand("run", "Runs the crawler of a parameter file");
      common(run_command);
      run_command->add_flag("--overwrite", options.overwrite, "Replaces the results in the output folder");
      run_command->add_flag("--quiet", options.quiet, "Prints nothing but errors");
      CLI::App *check_command =
        app.add_subcommand("check", "Says what run would do with a parameter file; runs and writes nothing");
      common(check_command);
      std::string format           = "prm";
      CLI::App   *parameter_command = app.add_subcommand("parameters", "Prints every entry of the parameter file");
      parameter_command->add_option("--format", format, "prm, json or markdown")
        ->check(CLI::IsMember({"prm", "json", "markdown"}));

      std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
      try
        {
          app.parse(reversed);
        }
      catch (const CLI::Success &success)
        {
          return first ? app.exit(success) : 0;
        }
      catch (const CLI::ParseError &error)
        {
          return report_error(communicator,
                              ExitCode::bad_input,
                              std::string(error.what()) + " (crawler --help tells the commands and options)",
                              /*on_all_ranks=*/true);
        }
      if (*parameter_command)
        return first ? print_parameters(format) : 0;
      return static_cast<int>(*run_command ? run(communicator, options) : check(communicator, options));
    }
  } // namespace

  int
  run_command_line(int argc, char **argv)
  {
    // What stands behind "--" is for PETSc, everything before it for us.
    char **separator = std::find_if(argv, argv + argc, [](const char *text) { return std::strcmp(text, "--") == 0; });
    const std::vector<std::string> arguments(argv + 1, separator);
    std::vector<char *>            petsc_arguments = {argv[0]};
    static char                    no_signal_handler[] = "-no_signal_handler";
    petsc_arguments.push_back(no_signal_handler);
    if (separator != argv + argc)
      petsc_arguments.insert(petsc_arguments.end(), separator + 1, argv + argc);
    int    petsc_argc = static_cast<int>(petsc_arguments.size());
    petsc_arguments.push_back(nullptr);
    char **petsc_argv = petsc_arguments.data();

    const dealii::Utilities::MPI::MPI_InitFinalize guard(petsc_argc, petsc_argv, /*max_num_threads=*/1);
    MPI_Comm communicator = MPI_COMM_WORLD;
    try
      {
        return dispatch(communicator, arguments);
      }
    catch (const InputError &error)
      {
        return report_error(communicator, ExitCode::bad_input, error.what(), /*on_all_ranks=*/true);
      }
    catch (const FileError &error)
      {
        return report_error(communicator, ExitCode::file_error, error.what(), error.on_all_ranks);
      }
    catch (const std::bad_alloc &)
      {
        return report_error(communicator, ExitCode::numerical_failure, "out of memory", /*on_all_ranks=*/false);
      }
    catch (const std::exception &error)
      {
        return report_error(communicator, ExitCode::numerical_failure, error.what(), /*on_all_ranks=*/false);
      }
  }
} // namespace crawler
