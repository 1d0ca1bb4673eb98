// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/check.h>
#include <crawler/app/command_line.h>
#include <crawler/base/communication.h>
#include <crawler/base/nearest_name.h>
#include <crawler/base/petsc_object.h>
#include <crawler/base/versions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/studies/atlas/atlas.h>
#include <crawler/studies/core/parameters.h>
#include <crawler/studies/run/run.h>
#include <crawler/studies/sweep/sweep.h>
#include <crawler/studies/tradeoff/tradeoff.h>
#include <crawler/time/failure.h>

#include <deal.II/base/mpi.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

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
      Parameters parameters;
      Declarations declarations;
      parameters.count_terms(ParameterFile::from_text("subsection Active stress\nsubsection Sum\nsubsection Term 1\n"
                                                      "end\nend\nend\n",
                                                      "one term, to show its entries"));
      parameters.add_parameters(declarations);
      if (format == "json")
        declarations.print_json(std::cout);
      else if (format == "markdown")
        declarations.print_markdown(std::cout);
      else
        declarations.print_prm(std::cout);
      return 0;
    }

    /// The first option that the command does not know, with the nearest that it does.
    std::string
    unknown_argument(const CLI::App &app, const std::vector<std::string> &arguments)
    {
      const CLI::App *command = &app;
      std::vector<std::string> known;
      if (!app.get_subcommands().empty())
        command = app.get_subcommands().front();
      for (const CLI::Option *option : command->get_options())
        for (const std::string &name : option->get_lnames())
          known.push_back("--" + name);
      known.push_back("-h");
      for (const std::string &argument : arguments)
      {
        const std::string name = argument.substr(0, argument.find('='));
        if (name.starts_with("-") && name != "-" && std::find(known.begin(), known.end(), name) == known.end())
        {
          const auto near = nearest_names(name, known, 1);
          return fmt::format(
            "unknown option \"{}\"{}", name, near.empty() ? "" : "; the nearest is " + quoted_list(near));
        }
      }
      return "";
    }

    /// Throws InputError unless the first argument is a command or an option.
    void
    require_command(const CLI::App &app, const std::vector<std::string> &arguments)
    {
      std::vector<std::string> names;
      for (const CLI::App *command : app.get_subcommands([](const CLI::App *) { return true; }))
        names.push_back(command->get_name());
      if (arguments.empty())
        throw InputError("the command is missing; " + quoted_list(names) + " is expected (see crawler --help)");
      if (arguments[0].starts_with("-") || std::find(names.begin(), names.end(), arguments[0]) != names.end())
        return;
      const auto near = nearest_names(arguments[0], names, 1);
      throw InputError(fmt::format("unknown command \"{}\"; {} is expected{}",
                                   arguments[0],
                                   quoted_list(names),
                                   near.empty() ? "" : "; the nearest is " + quoted_list(near)));
    }

    int
    dispatch(MPI_Comm communicator,
             const std::vector<std::string> &arguments,
             const std::vector<std::string> &petsc_options)
    {
      const bool first = rank_of(communicator) == 0;
      CLI::App app("Crawler: the limbless crawler, a body that pushes itself along by waves of active stress.",
                   "crawler");
      app.set_version_flag("--version", version_text());
      app.require_subcommand(1);
      app.footer("Options for PETSc go behind a lone \"--\", e.g. crawler run FILE.prm -- -ts_monitor");

      CommandOptions options;
      options.command_line = fmt::format("crawler {}", fmt::join(arguments, " "));
      if (!petsc_options.empty())
        options.command_line += fmt::format(" -- {}", fmt::join(petsc_options, " "));
      const auto common = [&](CLI::App *command) {
        command->add_option("FILE", options.file, "Parameter file; - reads standard input")->required();
        command->add_option("--set", options.overrides, "Sets an entry: \"Section/Entry=value\" (repeatable)")
          ->allow_extra_args(false)
          ->take_all();
        command->add_option("--output", options.output, "Output folder (default: output-NAME for NAME.prm)");
      };
      CLI::App *run_command = app.add_subcommand("run", "Runs the crawler of a parameter file");
      common(run_command);
      CLI::App *check_command =
        app.add_subcommand("check", "Says what run would do with a parameter file; runs and writes nothing");
      common(check_command);
      CLI::App *atlas_command =
        app.add_subcommand("atlas", "Maps two entries of a parameter file: runs every point in all forms and compares");
      common(atlas_command);
      CLI::App *tradeoff_command =
        app.add_subcommand("tradeoff", "Measures cost against error of many settings on the scene of a parameter file");
      common(tradeoff_command);
      tradeoff_command->add_flag("--resume", options.resume, "Goes on with a tradeoff that was stopped or killed");
      CLI::App *sweep_command =
        app.add_subcommand("sweep", "Runs all points of section Sweep of a parameter file and makes a table of them");
      common(sweep_command);
      sweep_command->add_flag("--resume", options.resume, "Goes on with a sweep that was stopped or killed");
      atlas_command->add_flag("--resume", options.resume, "Goes on with an atlas that was stopped or killed");
      sweep_command->add_flag("--strict", options.strict, "Exit code 8 if the row of a point failed");
      for (CLI::App *command : {run_command, sweep_command, atlas_command, tradeoff_command})
      {
        command->add_flag("--overwrite", options.overwrite, "Replaces the results in the output folder");
        command->add_flag("--quiet", options.quiet, "Prints nothing but errors");
      }
      std::string format          = "prm";
      CLI::App *parameter_command = app.add_subcommand("parameters", "Prints every entry of the parameter file");
      parameter_command->add_option("--format", format, "prm, json or markdown")
        ->check(CLI::IsMember({"prm", "json", "markdown"}));

      require_command(app, arguments);
      if (!petsc_options.empty() && !petsc_options[0].starts_with("-"))
        throw InputError("behind \"--\" stands \"" + petsc_options[0] +
                         "\", but a PETSc option is expected, like -ts_monitor");

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
        const std::string unknown = unknown_argument(app, arguments);
        throw InputError((unknown.empty() ? error.what() : unknown) +
                         " (crawler --help tells the commands and options)");
      }
      if (!petsc_options.empty()) // they are for PETSc's objects, unless the user wants something else
        options.overrides.insert(options.overrides.begin(), "Time/Engine=petsc");
      if (*parameter_command)
        return first ? print_parameters(format) : 0;
      if (*sweep_command)
        return static_cast<int>(sweep(communicator, options));
      if (*atlas_command)
        return static_cast<int>(atlas(communicator, options));
      if (*tradeoff_command)
        return static_cast<int>(tradeoff(communicator, options));
      return static_cast<int>(*run_command ? run(communicator, options) : check(communicator, options));
    }
  } // namespace

  int
  run_command_line(int argc, char **argv)
  {
    // What stands behind "--" is for PETSc, everything before it for us.
    char **separator = std::find_if(argv, argv + argc, [](const char *text) { return std::strcmp(text, "--") == 0; });
    const std::vector<std::string> arguments(argv + 1, separator);
    const std::vector<std::string> petsc_options(separator == argv + argc ? separator : separator + 1, argv + argc);
    static char no_signal_handler[] = "-no_signal_handler", yes[] = "true";
    std::vector<char *> petsc_arguments = {argv[0], no_signal_handler, yes};
    petsc_arguments.insert(petsc_arguments.end(), argv + argc - petsc_options.size(), argv + argc);
    int petsc_argc = static_cast<int>(petsc_arguments.size());
    petsc_arguments.push_back(nullptr);
    char **petsc_argv = petsc_arguments.data();

    MPI_Comm communicator = MPI_COMM_WORLD;
    std::unique_ptr<const dealii::Utilities::MPI::MPI_InitFinalize> guard;
    std::optional<PetscErrorWords> petsc_error(std::in_place);
    try
    {
      guard = std::make_unique<dealii::Utilities::MPI::MPI_InitFinalize>(petsc_argc, petsc_argv, /*max_num_threads=*/1);
    }
    catch (const std::exception &)
    {
      report_error(communicator,
                   ExitCode::bad_input,
                   "PETSc refuses an option behind \"--\": " + petsc_error->text,
                   /*on_all_ranks=*/false);
      MPI_Finalize();
      return static_cast<int>(ExitCode::bad_input);
    }
    petsc_error.reset();
    try
    {
      return dispatch(communicator, arguments, petsc_options);
    }
    catch (const InputError &error)
    {
      return report_error(communicator, ExitCode::bad_input, error.what(), /*on_all_ranks=*/true);
    }
    catch (const FileError &error)
    {
      return report_error(communicator, ExitCode::file_error, error.what(), error.on_all_ranks);
    }
    catch (const std::filesystem::filesystem_error &error)
    {
      return report_error(communicator, ExitCode::file_error, error.what(), /*on_all_ranks=*/false);
    }
    catch (...)
    {
      const TimeOutcome failure = failure_of(std::current_exception());
      return report_error(
        communicator, ExitCode::numerical_failure, failure.reason + ": " + failure.message, /*on_all_ranks=*/false);
    }
  }
} // namespace crawler
