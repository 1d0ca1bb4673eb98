// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/help_texts.h>
#include <crawler/app/manual.h>
#include <crawler/base/versions.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iostream>

namespace crawler
{
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
        std::cout << ".PP\n"
                  << roff(example.meaning) << ":\n.PP\n.RS 4\n.nf\n"
                  << roff(example.command) << "\n.fi\n.RE\n";
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
    for (const ExitCodeMeaning &one : exit_code_meanings())
      print_item(one.code, one.meaning);
  }
} // namespace crawler
