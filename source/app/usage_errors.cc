// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/help_texts.h>
#include <crawler/app/usage_errors.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/slips.h>

#include <fmt/format.h>

#include <algorithm>

namespace crawler
{
  namespace
  {
    /// Positional argument of a command, without a name of its own.
    struct Argument
    {
      const char *name, *meaning, *usage;
    };
    constexpr Argument arguments_of_commands[] = {{"FILE", "parameter file", "FILE.prm"},
                                                  {"DIR", "folder", "DIR"},
                                                  {"TEMPLATE", "template", "TEMPLATE"},
                                                  {"SHELL", "shell", "SHELL"},
                                                  {"SECTION", "section", "SECTION"}};

    /// Error message if @p words, the first of which is the command, are too few or too many; empty otherwise.
    std::string
    count_error(const CLI::App &command, const std::vector<std::string> &words)
    {
      const Argument *const argument = std::ranges::find_if(
        arguments_of_commands, [&](const Argument &one) { return command.get_option_no_throw(one.name) != nullptr; });
      const bool has_one     = argument != std::end(arguments_of_commands);
      const std::size_t most = has_one ? 2 : 1;
      if (words.size() < most)
        return fmt::format(
          "the {} is missing; \"crawler {} {}\" is expected", argument->meaning, command.get_name(), argument->usage);
      if (words.size() > most)
        return fmt::format("found \"{}\" after \"{}\", but {} is expected",
                           words[most],
                           words[most - 1],
                           has_one ? fmt::format("one {}", argument->meaning) : "nothing");
      return "";
    }

    /// Throws InputError for a setting that the shell has split at its blanks, or that has a blank instead of its "=".
    void
    require_whole_settings(const std::vector<std::string> &arguments)
    {
      for (std::size_t i = 1; i + 1 < arguments.size(); ++i)
      {
        if (arguments[i - 1] != "--set" || arguments[i].find('=') != std::string::npos)
          continue;
        std::string whole = arguments[i];
        for (std::size_t j = i + 1; j < arguments.size() && !arguments[j].starts_with("-"); ++j)
        {
          whole += " " + arguments[j];
          if (arguments[j].find('=') != std::string::npos)
            throw InputError(fmt::format("\"--set {0}\" contains blanks, at which a shell splits it; quotes around the "
                                         "whole are expected: --set \"{0}\"",
                                         whole));
        }
        if (!arguments[i + 1].starts_with("-") && !arguments[i + 1].ends_with(".prm"))
          throw InputError(fmt::format("\"--set {0} {1}\" has no \"=\", but \"Section/Entry=value\" is expected: --set "
                                       "\"{0}={1}\"",
                                       arguments[i],
                                       arguments[i + 1]));
      }
    }
  } // namespace

  void
  require_command(const CLI::App &app, const std::vector<std::string> &arguments)
  {
    std::vector<std::string> names;
    for (const CLI::App *command : all_commands(app))
      names.push_back(command->get_name());
    if (arguments.empty())
      throw InputError("the command is missing; " + quoted_list(names) + " is expected (see crawler --help)");
    if (arguments[0].starts_with("-") || std::find(names.begin(), names.end(), arguments[0]) != names.end())
    {
      require_whole_settings(arguments);
      return;
    }
    if (arguments[0].ends_with(".prm"))
      throw InputError(
        fmt::format("the command is missing before \"{0}\"; did you mean \"crawler run {0}\"?", arguments[0]));
    if (const std::string now = successor_of(arguments[0]); !now.empty())
      throw InputError(fmt::format("the command \"{}\" was removed; {} is expected", arguments[0], now));
    throw InputError(fmt::format("unknown command \"{}\"; {} is expected{} (see crawler --help)",
                                 arguments[0],
                                 quoted_list(names),
                                 nearest_hint(arguments[0], names)));
  }

  std::string
  usage_error(const CLI::ParseError &error, const CLI::App &app, const std::vector<std::string> &arguments)
  {
    const bool has_command  = !app.get_subcommands().empty();
    const CLI::App *command = has_command ? app.get_subcommands().front() : &app;
    std::vector<std::string> known;
    for (const CLI::Option *option : command->get_options())
      for (const std::string &name : typed_names(*option))
        known.push_back(name);
    known.emplace_back("-h");
    for (const std::string &argument : arguments)
      if (std::string sign = foreign_sign(argument); !sign.empty())
        return sign;
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
        return fmt::format("unknown option \"{}\"{}{}",
                           name,
                           has_command ? fmt::format(" of the command \"{}\"", command->get_name()) : "",
                           nearest_hint(name, known));
      }
      const bool has_value = option != nullptr && option->get_items_expected_max() > 0;
      if (has_command && words.empty())
        return fmt::format("\"{}\" is before the command \"{}\", but is expected after it", name, command->get_name());
      if (has_value && arguments[i] == name + "=")
        return fmt::format("found \"{}\", but a value is expected after it", arguments[i]);
      if (!has_value && name != arguments[i])
        return fmt::format("found \"{}\", but \"{}\" without a value is expected", arguments[i], name);
      if (has_value && name == arguments[i] && ++i == arguments.size())
        return fmt::format("\"{}\" is the last word, but a value is expected after it", name);
      if (has_value && dynamic_cast<const CLI::ConversionError *>(&error) != nullptr &&
          std::string(error.what()).find(": " + name + " = ") != std::string::npos)
        return fmt::format("\"{}\" is \"{}\", but a {} is expected",
                           name,
                           arguments[i].starts_with(name + "=") ? arguments[i].substr(name.size() + 1) : arguments[i],
                           option->get_type_name() == "NUMBER" ? "number" : "whole number of 0 or more");
      if (has_value && name != "--set" && option->count() > 1)
        return fmt::format("\"{}\" is given {} times, but is expected only once", name, option->count());
    }
    if (std::string problem = has_command ? count_error(*command, words) : ""; !problem.empty())
      return problem;
    return error.what();
  }
} // namespace crawler
