// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/check.h>
#include <crawler/app/commands.h>
#include <crawler/app/completion.h>
#include <crawler/app/help_texts.h>
#include <crawler/app/parameter_listing.h>
#include <crawler/app/templates.h>
#include <crawler/app/usage_errors.h>
#include <crawler/base/communication.h>
#include <crawler/base/process.h>
#include <crawler/base/versions.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/python.h>
#include <crawler/studies/optimize/optimize.h>
#include <crawler/studies/run/run.h>
#include <crawler/studies/sweep/sweep.h>
#include <crawler/studies/tradeoff/tradeoff.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <iostream>

namespace crawler
{
  namespace
  {
    /// Commands of contrib/python/crawler/__main__.py.
    constexpr std::pair<const char *, const char *> commands_in_python[] = {
      {"fit", "Finds numbers of a parameter file, with their uncertainty, from measured data"},
      {"paper", "Makes a figure and a table for a journal of the output folder of a run or sweep"},
      {"report", "Makes a page for browsers, report.html, of the output folder of any other command"},
      {"table", "Turns measured samples or tracks of markers into a table that a scene can read"}};

    /// Command that reads a parameter file.
    struct Command
    {
      const char *name, *description;
      ExitCode (*function)(MPI_Comm, const CommandOptions &, const ParameterFile &);
      bool takes_petsc_options;
      bool writes = true; ///< --resume, --overwrite and --quiet
    };
    constexpr Command commands[] = {
      {"run",
       "Runs the crawler that a parameter file describes",
       run,
       /*takes_petsc_options=*/true},
      {"check",
       "Says what run would do with a parameter file, without running it or writing anything",
       check,
       /*takes_petsc_options=*/true,
       /*writes=*/false},
      {"tradeoff",
       "Measures the cost and the error of many numerical settings on the scene of a parameter file",
       tradeoff,
       /*takes_petsc_options=*/false},
      {"optimize",
       "Searches for the best gait as section Optimize of a parameter file defines it",
       optimize,
       /*takes_petsc_options=*/false},
      {"sweep",
       "Runs all points of section Sweep of a parameter file and tabulates the results",
       sweep,
       /*takes_petsc_options=*/true},
    };

    const Command *
    find_command(const std::string &name)
    {
      const auto *const found =
        std::find_if(std::begin(commands), std::end(commands), [&](const Command &c) { return c.name == name; });
      return found == std::end(commands) ? nullptr : found;
    }

    void
    add_command(const Command &command, CLI::App &app, CommandOptions &options)
    {
      CLI::App *own = app.add_subcommand(command.name, command.description);
      own->add_option("FILE", options.file, "Parameter file; - reads standard input")->required();
      own->add_option("--set", options.overrides, "Sets an entry: \"Section/Entry=value\" (repeatable)")
        ->allow_extra_args(false)
        ->take_all()
        ->option_text("ENTRY=VALUE");
      own->add_option("--output", options.output, "Output folder (default: output-NAME for NAME.prm)")
        ->option_text("DIR");
      if (command.writes)
        own->add_flag(
          "--resume",
          options.resume,
          fmt::format("Resumes {} {} that was stopped or killed", command.name[0] == 'o' ? "an" : "a", command.name));
      if (command.function == optimize)
        own->add_flag("--check-gradient",
                      options.check_gradient,
                      "Compares the derivatives at the start with finite differences, without optimising");
      if (command.function == sweep)
        own->add_flag("--strict", options.strict, "Exits with code 8 if any point failed");
      if (command.writes)
      {
        own->add_flag("--overwrite", options.overwrite, "Replaces the results in the output folder");
        own->add_flag("--quiet", options.quiet, "Prints only errors");
      }
    }
  } // namespace

  Commands::Commands()
    : app_("Crawler: the limbless crawler, a body that pushes itself along by waves of active stress.", "crawler")
  {
    app_.set_version_flag("--version", versions_in_words());
    app_.require_subcommand(1);
    for (const Command &command : commands)
      add_command(command, app_, options_);
    add_own_commands();
    app_.footer([]() { return help_footer(); });
    for (CLI::App *command : app_.get_subcommands([](CLI::App *) { return true; }))
      command->footer(help_footer(command->get_name()));
  }

  void
  Commands::add_own_commands()
  {
    for (const auto &[name, description] : commands_in_python)
      if (CLI::App *const command = app_.add_subcommand(name, description); command->get_name() == "report")
      {
        command->add_option("DIR", options_.file, "Output folder of a run, sweep, tradeoff, optimisation or fit")
          ->required();
        command->add_flag("--quiet", options_.quiet, "Prints only errors");
      }
      else if (command->get_name() == "paper")
      {
        const auto in_python = [](const std::string &) {};
        command->set_help_flag();
        command->add_option("DIR", options_.file, "Output folder of a run or sweep");
        command->add_option_function<std::string>("--columns", in_python, "Width of the figure: 1 or 2 columns")
          ->option_text("N");
        command->add_option_function<std::string>("--height", in_python, "Height of the figure in mm")
          ->option_text("MM");
        command->add_option("--output", options_.output, "Folder of the files (default: DIR/paper)")
          ->option_text("FOLDER");
        command->allow_extras();
      }
      else
        command->prefix_command()->set_help_flag();

    CLI::App *plot = app_.add_subcommand("plot", "Draws the output folder of a run or study into it");
    plot->set_help_flag();
    plot->add_option(
      "DIR", options_.file, "Output folder of a run or study, or the table of a calibration or of crawler table");
    plot->add_option("--kind", kind_, fmt::format("{} (default: whichever fits)", fmt::join(plot_kinds(), ", ")))
      ->option_text("KIND");
    plot->add_flag("-h,--help", plot_help_, "Help; after DIR, that of the script, which takes all other options");
    plot->allow_extras();

    CLI::App *parameters = app_.add_subcommand("parameters", "Prints every entry of the parameter file");
    parameters->add_option("SECTION", name_, "Only this section, or this entry: \"Active stress/Pulse\"");
    parameters->add_option("--format", format_, fmt::format("{}", fmt::join(parameter_formats(), ", ")))
      ->option_text("FORMAT");

    CLI::App *init = app_.add_subcommand("init", "Prints a parameter file to start from");
    init->add_option("TEMPLATE", name_, fmt::format("{}", fmt::join(template_names(), ", ")))->required();
    init->add_option("--output", options_.output, "Writes it to this file, which must be new")->option_text("FILE");

    CLI::App *completion =
      app_.add_subcommand("completion", "Prints a script that lets a shell complete this command line");
    completion->add_option("SHELL", name_, "bash")->required();

    app_.add_subcommand("man", "Prints the manual page: crawler man | man -l -");
  }

  namespace
  {
    /// Quotes a word for a shell.
    std::string
    quoted(const std::string &word)
    {
      const auto is_plain = [](const unsigned char c) {
        return std::isalnum(c) || c > 127 || std::strchr("_@%+=:,./-", c);
      };
      if (!word.empty() && std::ranges::all_of(word, is_plain))
        return word;
      std::string result = "'";
      for (const char c : word)
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
      return result + "'";
    }
  } // namespace

  const std::string &
  Commands::chosen() const
  {
    return app_.get_subcommands().front()->get_name();
  }

  bool
  Commands::parse(const std::vector<std::string> &arguments, const std::vector<std::string> &petsc_options)
  {
    words_                = arguments;
    options_.command_line = "crawler";
    for (const std::string &word : arguments)
      options_.command_line += " " + quoted(word);
    options_.petsc_options = fmt::format("{}", fmt::join(petsc_options, " "));
    if (!petsc_options.empty())
      options_.command_line += " --";
    for (const std::string &word : petsc_options)
      options_.command_line += " " + quoted(word);
    // Control characters would break lines in the files and messages that repeat the words.
    for (const std::string &word : arguments)
      if (std::any_of(
            word.begin(), word.end(), [](const char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }))
        throw InputError(fmt::format("the command line has a control character in \"{}\", but text is expected", word));
    require_command(app_, arguments);
    if (!petsc_options.empty() && !petsc_options[0].starts_with("-"))
      throw InputError("found \"" + petsc_options[0] +
                       "\" after \"--\", but a PETSc option is expected, like -ts_monitor");
    for (const std::string &word : petsc_options)
      if (word.starts_with("--"))
        throw InputError(fmt::format(
          "found \"{}\" after \"--\", but PETSc options are expected; those of crawler go before it", word));
    try
    {
      app_.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    }
    catch (const CLI::Success &success)
    {
      if (rank_of_launcher() == 0)
        app_.exit(success);
      return false;
    }
    catch (const CLI::ParseError &error)
    {
      throw InputError(usage_error(error, app_, arguments) + " (crawler --help lists the commands and options)");
    }
    const CLI::App *const command = app_.get_subcommands().front();
    if (command->get_option_no_throw("--output") != nullptr && command->count("--output") > 0 &&
        options_.output.empty())
      throw InputError(fmt::format("found \"\" after \"--output\", but the name of a {} is expected",
                                   needs_mpi() ? "folder" : "file"));
    if (options_.resume && options_.overwrite)
      throw InputError("--resume and --overwrite contradict each other; one of them is expected");
    if (!petsc_options.empty())
    {
      if (const Command *const computes = find_command(chosen()); computes == nullptr || !computes->takes_petsc_options)
        throw InputError(fmt::format(
          "found \"{}\" after \"--\", but the command \"{}\" takes no PETSc options", petsc_options[0], chosen()));
      // PETSc options are for its integrators, unless the user chooses another engine
      options_.overrides.insert(options_.overrides.begin(), "Time/Engine=petsc");
    }
    return true;
  }

  bool
  Commands::needs_mpi() const
  {
    return find_command(chosen()) != nullptr;
  }

  void
  Commands::run_alone()
  {
    const std::string &name = chosen();
    if (name == "parameters")
      print_parameters(format_, name_);
    else if (name == "init")
      print_template(name_, options_.output);
    else if (name == "completion")
      print_completion(app_, name_);
    else if (name == "man")
      print_manual(app_);
    else if (plot_help_ && options_.file.empty())
      std::cout << app_.get_subcommands().front()->help();
    else
      hand_over_to_python("__main__.py", words_);
  }

  ExitCode
  Commands::run(MPI_Comm communicator) const
  {
    const ParameterFile file = read_file(communicator, options_.file, options_.overrides);
    return find_command(chosen())->function(communicator, options_, file);
  }
} // namespace crawler
