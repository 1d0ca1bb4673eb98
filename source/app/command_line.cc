// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/command_line.h>
#include <crawler/app/commands.h>
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/mpi_session.h>
#include <crawler/base/petsc_object.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/base/process.h>
#include <crawler/base/standard_output.h>
#include <crawler/lanes/lane_engine.h>
#include <crawler/studies/core/python.h>
#include <crawler/time/failure.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

namespace crawler
{
  namespace
  {
    /// Prints an error message. Returns the exit code.
    int
    say(const ExitCode code, const std::string &message)
    {
      std::cerr << "crawler: " << without_controls(with_short_quotes(with_plain_numbers(message)), /*keep_lines=*/false)
                << std::endl;
      return static_cast<int>(code);
    }

    /// Reports an error of one rank, or of all.
    int
    report_error(MPI_Comm communicator, const ExitCode code, const std::string &message, const bool on_all_ranks)
    {
      if (!on_all_ranks || rank_of(communicator) == 0)
        say(code, message);
      // MPI_Abort, since a rank that fails alone would leave the others waiting.
      if (!on_all_ranks && size_of(communicator) > 1)
        MPI_Abort(communicator, static_cast<int>(code));
      return static_cast<int>(code);
    }

    /// Handles the command line, and commands that compute nothing. Returns nothing if there is still work to do.
    std::optional<int>
    without_mpi(Commands &commands,
                const std::vector<std::string> &arguments,
                const std::vector<std::string> &petsc_options)
    {
      const bool first = rank_of_launcher() == 0; // one of several processes prints
      const auto fail  = [&](const ExitCode code, const std::string &message) {
        return first ? say(code, message) : static_cast<int>(code);
      };
      try
      {
        if (!commands.parse(arguments, petsc_options))
          return 0;
        if (commands.needs_mpi())
        {
          forced_instruction_set(); // throws if it is not available
          return std::nullopt;
        }
        if (first)
          commands.run_alone();
        return 0;
      }
      catch (const InputError &error)
      {
        return fail(ExitCode::bad_input, error.what());
      }
      catch (const FileError &error)
      {
        return fail(ExitCode::file_error, error.what());
      }
      catch (const std::filesystem::filesystem_error &error)
      {
        return fail(ExitCode::file_error, in_words(error));
      }
      catch (const Stopped &error)
      {
        return fail(ExitCode::stopped, error.what());
      }
      catch (const std::exception &error)
      {
        return fail(ExitCode::numerical_failure, error.what());
      }
    }

    /// Runs a command that computes, after MPI has started.
    int
    with_mpi(MPI_Comm communicator, const Commands &commands)
    {
      try
      {
        return static_cast<int>(commands.run(communicator));
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
        return report_error(communicator, ExitCode::file_error, in_words(error), /*on_all_ranks=*/false);
      }
      catch (...)
      {
        const TimeOutcome failure = failure_of(std::current_exception());
        return report_error(
          communicator, ExitCode::numerical_failure, failure.reason + ": " + failure.message, /*on_all_ranks=*/false);
      }
    }

    /// Starts MPI and PETSc, and runs the command.
    int
    start_mpi_and_run(char **argv, const Commands &commands, char **first_petsc_option, char **end)
    {
      static char no_signal_handler[] = "-no_signal_handler", yes[] = "true";
      std::vector<char *> petsc_arguments = {argv[0], no_signal_handler, yes};
      petsc_arguments.insert(petsc_arguments.end(), first_petsc_option, end);
      int petsc_argc = static_cast<int>(petsc_arguments.size());
      petsc_arguments.push_back(nullptr);
      char **petsc_argv = petsc_arguments.data();

      MPI_Comm communicator = MPI_COMM_WORLD;
      std::unique_ptr<const MpiSession> session;
      std::optional<PetscErrorWords> petsc_error(std::in_place);
      try
      {
        const QuickStart quick_start;
        session = std::make_unique<MpiSession>(petsc_argc, petsc_argv);
      }
      catch (const std::exception &)
      {
        report_error(communicator,
                     ExitCode::bad_input,
                     "PETSc refuses an option after \"--\": " + petsc_error->text,
                     /*on_all_ranks=*/false);
        MPI_Finalize();
        return static_cast<int>(ExitCode::bad_input);
      }
      petsc_error.reset();
      return with_mpi(communicator, commands);
    }
  } // namespace

  int
  run_command_line(int argc, char **argv)
  {
    std::signal(SIGPIPE, SIG_IGN); // a run goes on when the reader of its output has ended
    std::signal(SIGXFSZ, SIG_IGN); // a file that becomes too large (ulimit -f) is a file that cannot be written
    // Arguments behind "--" are for PETSc, all before it for the program.
    char **end       = argv + argc;
    char **separator = std::find_if(argv, end, [](const char *text) { return std::strcmp(text, "--") == 0; });
    char **petsc     = separator == end ? end : separator + 1;
    StandardOutput output;
    Commands commands;
    const auto early = without_mpi(commands, {argv + 1, separator}, {petsc, end});
    const int code   = early ? *early : start_mpi_and_run(argv, commands, petsc, end);
    if (const std::string problem = output.problem(); !problem.empty())
    {
      say(ExitCode::file_error, "cannot write to standard output: " + problem);
      return code == 0 ? static_cast<int>(ExitCode::file_error) : code;
    }
    return code;
  }
} // namespace crawler
