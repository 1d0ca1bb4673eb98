// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/completion.h>
#include <crawler/app/help_texts.h>
#include <crawler/app/option_names.h>
#include <crawler/app/parameter_listing.h>
#include <crawler/app/templates.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iostream>
#include <set>

namespace crawler
{
  namespace
  {
    /// Admissible values of an option or of an argument of a command.
    struct Values
    {
      enum class Kind
      {
        none,
        words,
        beginnings, ///< beginnings of a word, which continues behind them
        parameter_file,
        folder,
        file
      } kind                         = Kind::none;
      std::vector<std::string> words = {};
    };

    std::vector<std::string>
    section_names()
    {
      std::set<std::string> sections;
      for (const std::string &entry : entry_names())
        for (std::size_t i = entry.find('/'); i != std::string::npos; i = entry.find('/', i + 1))
          sections.insert(entry.substr(0, i));
      return {sections.begin(), sections.end()};
    }

    Values
    values_of(const CLI::App &command, const CLI::Option &option)
    {
      using Kind             = Values::Kind;
      const std::string name = option.get_positional() ? option.get_name() : option.get_lnames().front();
      if (name == "FILE")
        return {Kind::parameter_file};
      if (name == "DIR")
        return {Kind::folder};
      if (name == "output")
        return {command.get_name() == "init" ? Kind::file : Kind::folder};
      if (name == "TEMPLATE")
        return {Kind::words, template_names()};
      if (name == "SHELL")
        return {Kind::words, completion_shells()};
      if (name == "SECTION")
        return {Kind::words, section_names()};
      if (name == "format")
        return {Kind::words, parameter_formats()};
      if (name == "kind")
        return {Kind::words, plot_kinds()};
      if (name != "set")
        return {};
      Values entries = {Kind::beginnings, entry_names()};
      for (std::string &entry : entries.words)
        entry += "=";
      return entries;
    }

    bool
    has_value(const CLI::Option &option)
    {
      return option.get_items_expected_max() > 0;
    }

    /// Commands that fill COMPREPLY.
    std::string
    bash_action(const Values &values)
    {
      switch (values.kind)
      {
        case Values::Kind::none:
          return ":";
        case Values::Kind::parameter_file:
          return "_crawler_files -X '!*.prm'";
        case Values::Kind::folder:
          return "_crawler_files -d";
        case Values::Kind::file:
          return "_crawler_files";
        case Values::Kind::beginnings:
          return fmt::format("compopt -o nospace 2>/dev/null; _crawler_words '{}'", fmt::join(values.words, "' '"));
        case Values::Kind::words:
          return fmt::format("_crawler_words '{}'", fmt::join(values.words, "' '"));
      }
      return ":";
    }

    constexpr const char *bash_head =
      R"~~~~(# Lets bash, and zsh after bashcompinit, complete the command line of crawler; made by "crawler completion bash".

# The given words that begin with what was typed, in quotes or not.
_crawler_words()
{
  local typed="$word" word_is_quoted="" one
  case "$typed" in
    \"* | \'*) word_is_quoted=1 typed="${typed:1}" ;;
    *) typed="${typed//\\/}" ;;
  esac
  for one in "$@"; do
    [[ "$one" == "$typed"* ]] || continue
    [ -n "$word_is_quoted" ] || one="${one// /\\ }"
    COMPREPLY+=("$one")
  done
}

# Files, and the folders on the way to them.
_crawler_files()
{
  compopt -o filenames 2>/dev/null
  local one
  while IFS= read -r one; do
    COMPREPLY+=("$one")
  done < <({ compgen -d -- "$word"; [ "$1" = -d ] || compgen -f "$@" -- "$word"; } | sort -u)
}

_crawler()
{
  local word="${COMP_WORDS[COMP_CWORD]}" before="${COMP_WORDS[COMP_CWORD - 1]}"
  COMPREPLY=()
  [ "$before" != "=" ] && [ "$word" != "=" ] || return 0
)~~~~";

    void
    print_bash(const CLI::App &app)
    {
      std::cout << bash_head;
      std::vector<std::string> names;
      for (const CLI::App *command : all_commands(app))
        names.push_back(command->get_name());
      for (const CLI::Option *option : app.get_options())
        names.push_back(typed_names(*option).front());
      std::cout << fmt::format("  [ \"$COMP_CWORD\" -gt 1 ] || {{ _crawler_words '{}'; return; }}\n"
                               "  case \"${{COMP_WORDS[1]}} $before\" in\n",
                               fmt::join(names, "' '"));
      std::string arguments;
      for (const CLI::App *command : all_commands(app))
      {
        std::vector<std::string> options;
        std::string action = ":";
        for (const CLI::Option *option : command->get_options())
        {
          if (option->get_positional())
          {
            action = bash_action(values_of(*command, *option));
            continue;
          }
          options.push_back(typed_names(*option).front());
          if (has_value(*option))
            std::cout << fmt::format("    '{} {}') {}; return ;;\n",
                                     command->get_name(),
                                     options.back(),
                                     bash_action(values_of(*command, *option)));
        }
        arguments += fmt::format("    '{0} '-*) _crawler_words '{1}' ;;\n    '{0} '*) {2} ;;\n",
                                 command->get_name(),
                                 fmt::join(options, "' '"),
                                 action);
      }
      std::cout << "  esac\n  case \"${COMP_WORDS[1]} $word\" in\n"
                << arguments << "  esac\n}\n"
                << "complete -F _crawler crawler\n";
    }
  } // namespace

  std::vector<std::string>
  completion_shells()
  {
    return {"bash"};
  }

  void
  print_completion(const CLI::App &app, const std::string &shell)
  {
    if (shell != "bash")
      throw InputError(fmt::format("unknown shell \"{}\"; {} is expected, whose script zsh reads, too, after "
                                   "\"autoload -U bashcompinit; bashcompinit\"",
                                   shell,
                                   quoted_list(completion_shells())));
    print_bash(app);
  }
} // namespace crawler
