// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/help_texts.h>
#include <crawler/app/texts.h>
#include <crawler/base/versions.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <iostream>
#include <sstream>

namespace crawler
{
  namespace
  {
    /// Command line with its purpose, or exit code with its meaning.
    struct Example
    {
      std::string text, meaning;
    };

    /// Examples for all commands: the command to which an example belongs is its second word or, behind mpirun -n N,
    /// its fifth.
    const std::vector<Example> all_examples = {
      {"crawler init earthworm > worm.prm", "a parameter file to start from"},
      {"crawler init table --output my.prm", "the same, into a new file"},
      {"crawler check worm.prm", "what would be computed, and whether all entries are valid"},
      {"crawler run worm.prm", "one run, with its files in output-worm/"},
      {"crawler run worm.prm --set \"Body/Length=12\" --output longer", "another value, another folder"},
      {"crawler run worm.prm --resume", "resumes a run that was stopped"},
      {"crawler run worm.prm -- -ts_monitor", "options for PETSc follow a lone \"--\""},
      {"mpirun -n 2 crawler sweep sweep.prm", "a table of many runs, shared by two processes"},
      {"crawler sweep sweep.prm --resume", "resumes one that was stopped"},
      {"crawler optimize gait.prm", "the best gait within limits"},
      {"crawler fit worm.prm --data tracks.csv", "what measured data say about the numbers of a scene"},
      {"crawler sweep sweep.prm --set Sweep/Cross-check=true", "with every answer cross-checked"},
      {"crawler tradeoff scene.prm", "what accuracy costs on this scene"},
      {"crawler plot output-worm", "a picture in the folder"},
      {"crawler plot output-worm --last-stride", "the last stride only (or --from TIME --to TIME)"},
      {"crawler plot output-worm --help", "all options of this picture"},
      {"crawler paper output-worm --columns 2", "a figure and a table for a journal"},
      {"crawler report output-worm", "a page for browsers in the folder"},
      {"crawler parameters Body", "one section of the parameter file, every entry explained"},
      {"crawler parameters --format schema", "types, ranges and defaults for other programs"},
      {"source <(crawler completion bash)", "the Tab key completes commands, options and entries"},
      {"crawler man | man -l -", "the manual page"}};

    std::string
    command_of(const Example &example)
    {
      const std::size_t start = example.text.find("crawler ") + 8;
      return example.text.substr(start, example.text.find(' ', start) - start);
    }

    std::string
    in_columns(const std::vector<Example> &examples)
    {
      std::size_t width = 0;
      for (const Example &example : examples)
        width = std::max(width, example.text.size());
      std::string text;
      for (const Example &example : examples)
        text += fmt::format("  {:{}}  {}\n", example.text, width, example.meaning);
      return text;
    }

    /// Examples of a command; without a name, first steps.
    std::vector<Example>
    examples_of(const std::string &command = "")
    {
      const std::vector<std::string> first_steps = {"init", "check", "run", "sweep", "plot", "parameters"};
      std::vector<Example> list;
      for (const Example &example : all_examples)
      {
        const std::string own = command_of(example);
        const bool is_first =
          std::ranges::none_of(list, [&](const Example &other) { return command_of(other) == own; });
        if (command.empty() ? is_first && std::ranges::find(first_steps, own) != first_steps.end() : own == command)
          list.push_back(example);
      }
      return list;
    }

    /// Exit codes as in the table of the user guide.
    std::vector<Example>
    exit_codes()
    {
      std::vector<Example> list;
      std::istringstream lines{std::string(exit_codes_section)};
      for (std::string line; std::getline(lines, line);)
        if (line.size() > 6 && line.starts_with("| ") && std::isdigit(static_cast<unsigned char>(line[2])))
        {
          const std::size_t first = line.find(" | "), second = line.find(" | ", first + 3);
          list.push_back({line.substr(2, first - 2), line.substr(first + 3, second - first - 3)});
        }
      return list;
    }
  } // namespace

  const std::vector<std::string> &
  plot_kinds()
  {
    static const std::vector<std::string> kinds = {
      "tradeoff", "optimize", "fit", "sweep", "calibration", "table", "kymograph", "sensitivity", "scaling"};
    return kinds;
  }

  std::vector<const CLI::App *>
  all_commands(const CLI::App &app)
  {
    return app.get_subcommands([](const CLI::App *) { return true; });
  }

  std::vector<std::string>
  typed_names(const CLI::Option &option)
  {
    std::vector<std::string> names;
    for (const std::string &name : option.get_lnames())
      names.push_back("--" + name);
    for (const std::string &name : option.get_snames())
      names.push_back("-" + name);
    return names;
  }

  std::string
  help_footer()
  {
    return "Examples:\n" + in_columns(examples_of()) + "\nExit codes:\n" + in_columns(exit_codes()) +
           "\nOptions for PETSc go after a lone \"--\", e.g. crawler run FILE.prm -- -ts_monitor\n"
           "crawler COMMAND --help lists the options of a command; crawler man has it all.";
  }

  std::string
  help_footer(const std::string &command)
  {
    const auto examples = examples_of(command);
    return examples.empty() ? "" : "Examples:\n" + in_columns(examples);
  }

  namespace
  {
    /// Text in roff: no escapes, no requests, hyphens that can be copied.
    std::string
    roff(const std::string &text)
    {
      std::string escaped = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
      for (const char c : text)
        escaped += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
      return escaped;
    }

    /// Prints a name in bold with its meaning.
    void
    print_item(const std::string &name, const std::string &meaning)
    {
      std::cout << ".TP\n\\fB" << roff(name) << "\\fR\n" << roff(meaning) << ".\n";
    }

    void
    print_option(const CLI::Option &option)
    {
      const std::string name =
        option.get_positional() ? option.get_name() : fmt::format("{}", fmt::join(typed_names(option), ", "));
      const std::string &value = option.get_option_text();
      print_item(value.empty() ? name : name + " " + value, option.get_description());
    }

    void
    print_command(const CLI::App &command)
    {
      std::string usage = "crawler " + command.get_name();
      for (const CLI::Option *option : command.get_options())
        if (option->get_positional())
          usage += option->get_required() ? " " + option->get_name() : " [" + option->get_name() + "]";
      std::cout << ".SS \"" << roff(usage) << "\"\n" << roff(command.get_description()) << ".\n";
      for (const CLI::Option *option : command.get_options())
        if (typed_names(*option) != std::vector<std::string>{"--help", "-h"})
          print_option(*option);
      for (const Example &example : examples_of(command.get_name()))
        std::cout << ".PP\n" << roff(example.meaning) << ":\n.PP\n.RS 4\n.nf\n" << roff(example.text) << "\n.fi\n.RE\n";
    }
  } // namespace

  void
  print_manual(const CLI::App &app)
  {
    std::cout
      << ".\\\" Made by \"crawler man\".\n.TH CRAWLER 1 \"\" \"crawler " << roff(versions().at("crawler"))
      << "\" \"User Commands\"\n.SH NAME\ncrawler \\- simulates limbless crawlers: earthworms, snails, soft "
         "robots\n.SH SYNOPSIS\n.B crawler\n.I COMMAND\n[\\fIARGUMENT\\fR] [\\fIOPTION\\fR]... [-- "
         "\\fIPETSC OPTION\\fR...]\n.br\n.B mpirun -n\n.I N\n.B crawler\n.I COMMAND\n\\&...\n"
         ".SH DESCRIPTION\n"
      << roff(app.get_description())
      << "\nThe scene is described in a parameter file; its entries are listed by\n.BR \"crawler parameters\" .\n"
         ".SH OPTIONS\n";
    for (const CLI::Option *option : app.get_options())
      print_option(*option);
    print_item("-- PETSC OPTION...", "Everything after a lone \"--\" is passed to PETSc");
    std::cout << ".SH COMMANDS\n";
    for (const CLI::App *command : all_commands(app))
      print_command(*command);
    std::cout << ".SH EXIT STATUS\n";
    for (const Example &one : exit_codes())
      print_item(one.text, one.meaning);
  }
} // namespace crawler
