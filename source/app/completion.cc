// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/completion.h>
#include <crawler/app/help_texts.h>
#include <crawler/app/parameter_listing.h>
#include <crawler/app/templates.h>
#include <crawler/base/exceptions.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iostream>
#include <set>

namespace crawler
{
  namespace
  {
    std::vector<std::string>
    section_names()
    {
      std::set<std::string> sections;
      for (const std::string &entry : entry_names())
        for (std::size_t i = entry.find('/'); i != std::string::npos; i = entry.find('/', i + 1))
          sections.insert(entry.substr(0, i));
      return {sections.begin(), sections.end()};
    }

    /// Commands that fill COMPREPLY with those of the words that fit.
    std::string
    words_action(const std::vector<std::string> &words)
    {
      return fmt::format("_crawler_words '{}'", fmt::join(words, "' '"));
    }

    /// Commands for the admissible values of an option or of an argument of a command.
    std::string
    bash_action(const CLI::App &command, const CLI::Option &option)
    {
      const std::string name = option.get_positional() ? option.get_name() : option.get_lnames().front();
      if (name == "FILE")
        return "_crawler_files -X '!*.prm'";
      if (name == "output" && command.get_name() == "init")
        return "_crawler_files";
      if (name == "output" || name == "DIR")
        return "_crawler_files -d";
      if (name == "TEMPLATE")
        return words_action(template_names());
      if (name == "SHELL")
        return words_action({"bash"});
      if (name == "SECTION")
        return words_action(section_names());
      if (name == "format")
        return words_action(parameter_formats());
      if (name == "kind")
        return words_action(plot_kinds());
      if (name != "set")
        return ":";
      std::vector<std::string> beginnings = entry_names();
      for (std::string &entry : beginnings)
        entry += "=";
      return "compopt -o nospace 2>/dev/null; " + words_action(beginnings);
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
  } // namespace

  void
  print_completion(const CLI::App &app, const std::string &shell)
  {
    if (shell != "bash")
      throw InputError(fmt::format("unknown shell \"{}\"; \"bash\" is expected, whose script zsh reads, too, after "
                                   "\"autoload -U bashcompinit; bashcompinit\"",
                                   shell));
    std::cout << bash_head;
    std::vector<std::string> names;
    for (const CLI::App *command : all_commands(app))
      names.push_back(command->get_name());
    for (const CLI::Option *option : app.get_options())
      names.push_back(typed_names(*option).front());
    std::cout << fmt::format("  [ \"$COMP_CWORD\" -gt 1 ] || {{ {}; return; }}\n"
                             "  case \"${{COMP_WORDS[1]}} $before\" in\n",
                             words_action(names));
    std::string arguments;
    for (const CLI::App *command : all_commands(app))
    {
      std::vector<std::string> options;
      std::string action = ":";
      for (const CLI::Option *option : command->get_options())
      {
        if (option->get_positional())
        {
          action = bash_action(*command, *option);
          continue;
        }
        options.push_back(typed_names(*option).front());
        if (option->get_items_expected_max() > 0) // it has a value
          std::cout << fmt::format(
            "    '{} {}') {}; return ;;\n", command->get_name(), options.back(), bash_action(*command, *option));
      }
      arguments +=
        fmt::format("    '{0} '-*) {1} ;;\n    '{0} '*) {2} ;;\n", command->get_name(), words_action(options), action);
    }
    std::cout << "  esac\n  case \"${COMP_WORDS[1]} $word\" in\n"
              << arguments << "  esac\n}\n"
              << "complete -F _crawler crawler\n";
  }
} // namespace crawler
