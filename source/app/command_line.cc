// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/check.h>
#include <crawler/app/command_line.h>
#include <crawler/app/plot.h>
#include <crawler/app/table_command.h>
#include <crawler/base/communication.h>
#include <crawler/base/nearest_name.h>
#include <crawler/base/petsc_object.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/base/versions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/studies/atlas/atlas.h>
#include <crawler/studies/core/parameters.h>
#include <crawler/studies/optimize/optimize.h>
#include <crawler/studies/report/report.h>
#include <crawler/studies/run/run.h>
#include <crawler/studies/sweep/sweep.h>
#include <crawler/studies/tradeoff/tradeoff.h>
#include <crawler/time/failure.h>

#include <deal.II/base/mpi.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

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
    int
    report_error(MPI_Comm communicator, const ExitCode code, const std::string &message, const bool on_all_ranks)
    {
      if (!on_all_ranks || rank_of(communicator) == 0)
        std::cerr << "crawler: " << without_controls(with_short_quotes(with_plain_numbers(message))) << std::endl;
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
      const std::vector<std::string> formats = {"prm", "json", "markdown"};
      if (std::find(formats.begin(), formats.end(), format) == formats.end())
        throw InputError(fmt::format("\"--format\" is \"{}\", but {} is expected", format, quoted_list(formats)));
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

    /// What is wrong with the arguments, of which CLI11 knows less.
    std::string
    in_words(const CLI::ParseError &error, const CLI::App &app, const std::vector<std::string> &arguments)
    {
      const bool has_command  = !app.get_subcommands().empty();
      const CLI::App *command = has_command ? app.get_subcommands().front() : &app;
      std::vector<std::string> known;
      for (const CLI::Option *option : command->get_options())
        for (const std::string &name : option->get_lnames())
          known.push_back("--" + name);
      known.push_back("-h");
      std::vector<std::string> words; // without the values of options
      for (std::size_t i = 0; i < arguments.size(); ++i)
      {
        const std::string name = arguments[i].substr(0, arguments[i].find('='));
        if (!name.starts_with("-") || name == "-")
        {
          words.push_back(name);
          continue;
        }
        const CLI::Option *option = name == "-h" ? nullptr : command->get_option_no_throw(name);
        if (option == nullptr && name != "-h")
        {
          const auto near = nearest_names(name, known, 1);
          return fmt::format("unknown option \"{}\"{}{}",
                             name,
                             has_command ? fmt::format(" of the command \"{}\"", command->get_name()) : "",
                             near.empty() ? "" : "; the nearest is " + quoted_list(near));
        }
        const bool has_value = option != nullptr && option->get_items_expected_max() > 0;
        if (has_command && words.empty())
          return fmt::format(
            "\"{}\" stands before the command \"{}\", but behind it is expected", name, command->get_name());
        if (has_value && arguments[i] == name + "=")
          return fmt::format("found \"{}\", but a value is expected behind it", arguments[i]);
        if (!has_value && name != arguments[i])
          return fmt::format("found \"{}\", but \"{}\" without a value is expected", arguments[i], name);
        if (has_value && name == arguments[i] && ++i == arguments.size())
          return fmt::format("\"{}\" is the last word, but a value is expected behind it", name);
        if (has_value && name != "--set" && option->count() > 1)
          return fmt::format("\"{}\" is there {} times, but once is expected", name, option->count());
      }
      const bool wants_folder  = command->get_option_no_throw("DIR") != nullptr;
      const bool wants_table   = command->get_option_no_throw("OUT") != nullptr;
      const std::size_t wanted = wants_table                                                        ? 3
                                 : command->get_option_no_throw("FILE") == nullptr && !wants_folder ? 1
                                                                                                    : 2;
      if (has_command && words.size() < wanted && wants_table)
        return "a file is missing; \"crawler table IN.csv OUT.csv\" is expected";
      if (has_command && words.size() < wanted)
        return fmt::format("the {} is missing; \"crawler {} {}\" is expected",
                           wants_folder ? "folder" : "parameter file",
                           command->get_name(),
                           wants_folder ? "DIR" : "FILE.prm");
      if (has_command && words.size() > wanted)
        return fmt::format("found \"{}\" behind \"{}\", but {} is expected",
                           words[wanted],
                           words[wanted - 1],
                           wanted == 1    ? "nothing"
                           : wants_folder ? "one folder"
                           : wants_table  ? "IN.csv OUT.csv"
                                          : "one parameter file");
      return error.what();
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
      if (arguments[0].ends_with(".prm"))
        throw InputError(
          fmt::format("the command is missing before \"{0}\"; did you mean \"crawler run {0}\"?", arguments[0]));
      const auto near = nearest_names(arguments[0], names, 1);
      throw InputError(fmt::format("unknown command \"{}\"; {} is expected{}",
                                   arguments[0],
                                   quoted_list(names),
                                   near.empty() ? "" : "; the nearest is " + quoted_list(near)));
    }

    /// A command that reads a parameter file, or the folder that another one has made.
    struct Command
    {
      const char *name, *description;
      ExitCode (*function)(MPI_Comm, const CommandOptions &);
      bool writes, is_study; ///< --overwrite and --quiet; --resume
    };
    constexpr Command commands[] = {
      {"run", "Runs the crawler of a parameter file", run, true, false},
      {"check",
       "Says what run would do with a parameter file; runs and writes nothing",
       check,
       /*writes=*/false,
       /*is_study=*/false},
      {"atlas",
       "Maps two entries of a parameter file: runs every point in all forms and compares",
       atlas,
       /*writes=*/true,
       /*is_study=*/true},
      {"tradeoff",
       "Measures cost against error of many settings on the scene of a parameter file",
       tradeoff,
       /*writes=*/true,
       /*is_study=*/true},
      {"optimize",
       "Looks for the best gait of section Optimize of a parameter file",
       optimize,
       /*writes=*/true,
       /*is_study=*/true},
      {"sweep",
       "Runs all points of section Sweep of a parameter file and makes a table of them",
       sweep,
       /*writes=*/true,
       /*is_study=*/true},
      {"report",
       "Makes a page for browsers, report.html, of the output folder of any other command",
       report,
       /*writes=*/false,
       /*is_study=*/false}};

    void
    add_command(const Command &command, CLI::App &app, CommandOptions &options)
    {
      CLI::App *own = app.add_subcommand(command.name, command.description);
      if (command.function == report)
      {
        own->add_option("DIR", options.file, "Output folder of a run, sweep, atlas, tradeoff or optimisation")
          ->required();
        own->add_flag("--quiet", options.quiet, "Prints nothing but errors");
        return;
      }
      own->add_option("FILE", options.file, "Parameter file; - reads standard input")->required();
      own->add_option("--set", options.overrides, "Sets an entry: \"Section/Entry=value\" (repeatable)")
        ->allow_extra_args(false)
        ->take_all();
      own->add_option("--output", options.output, "Output folder (default: output-NAME for NAME.prm)");
      if (command.is_study)
        own->add_flag("--resume",
                      options.resume,
                      fmt::format("Goes on with {} {} that was stopped or killed",
                                  command.name[0] == 'a' || command.name[0] == 'o' ? "an" : "a",
                                  command.name));
      if (command.function == optimize)
        own->add_flag("--check-gradient",
                      options.check_gradient,
                      "Compares the derivatives at the start with differences, and optimises nothing");
      if (command.function == sweep)
        own->add_flag("--strict", options.strict, "Exit code 8 if the row of a point failed");
      if (command.writes)
      {
        own->add_flag("--overwrite", options.overwrite, "Replaces the results in the output folder");
        own->add_flag("--quiet", options.quiet, "Prints nothing but errors");
      }
    }

    /// crawler plot: what it does not know is for the script.
    struct PlotCommand
    {
      CLI::App *command = nullptr;
      std::string path, kind;
      bool help = false;

      explicit PlotCommand(CLI::App &app)
        : command(app.add_subcommand("plot", "Draws the output folder of a run or study into it"))
      {
        command->set_help_flag();
        command->add_option(
          "DIR", path, "Output folder of a run or study, or the table of a calibration or of crawler table");
        command->add_option("--kind", kind, fmt::format("{} (default: what fits)", fmt::join(plot_kinds(), ", ")));
        command->add_flag("-h,--help", help, "Help; behind DIR that of the script, which takes all other options");
        command->allow_extras();
      }

      ExitCode
      operator()(MPI_Comm communicator) const
      {
        std::vector<std::string> options = command->remaining();
        if (help && !path.empty())
          options.emplace_back("--help");
        if (!help || !path.empty())
          return plot(communicator, path, kind, options);
        if (rank_of(communicator) == 0)
          std::cout << command->help();
        return ExitCode::finished;
      }
    };

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
      options.command_line  = fmt::format("crawler {}", fmt::join(arguments, " "));
      options.petsc_options = fmt::format("{}", fmt::join(petsc_options, " "));
      if (!petsc_options.empty())
        options.command_line += " -- " + options.petsc_options;
      for (const Command &command : commands)
        add_command(command, app, options);
      std::string format          = "prm";
      CLI::App *parameter_command = app.add_subcommand("parameters", "Prints every entry of the parameter file");
      parameter_command->add_option("--format", format, "prm, json or markdown");

      PlotCommand plot_command(app);
      const TableCommand table_command(app);

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
        throw InputError(in_words(error, app, arguments) + " (crawler --help tells the commands and options)");
      }
      const CLI::App *const chosen = app.get_subcommands().front();
      if (chosen->get_option_no_throw("--output") != nullptr && chosen->count("--output") > 0 && options.output.empty())
        throw InputError("behind \"--output\" stands \"\", but the name of a folder is expected");
      const auto command = std::find_if(
        std::begin(commands), std::end(commands), [&](const Command &c) { return c.name == chosen->get_name(); });
      if (!petsc_options.empty() &&
          (command == std::end(commands) || command->function == atlas || command->function == tradeoff ||
           command->function == optimize || command->function == report))
        throw InputError(fmt::format("behind \"--\" stands \"{}\", but the command \"{}\" has no use for PETSc options",
                                     petsc_options[0],
                                     chosen->get_name()));
      if (chosen == plot_command.command)
        return static_cast<int>(plot_command(communicator));
      if (table_command.is(chosen))
        return static_cast<int>(table_command(communicator));
      if (command == std::end(commands))
        return first ? print_parameters(format) : 0;
      if (!petsc_options.empty()) // they are for PETSc's objects, unless the user wants something else
        options.overrides.insert(options.overrides.begin(), "Time/Engine=petsc");
      return static_cast<int>(command->function(communicator, options));
    }
  } // namespace

  int
  run_command_line(int argc, char **argv)
  {
    std::signal(SIGPIPE, SIG_IGN); // a run goes on when the reader of its output has ended
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
      const QuickStart quick_start;
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
