// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/unit_names.h>

#include <algorithm>
#include <cctype>

namespace crawler
{
  void
  UnitNames::add_parameters(Declarations &declarations)
  {
    const std::string name = "a name, like mm";
    declarations.text("Length", length, name)
      .means("Name of the unit of length in pictures, reports, table headers and on the screen. It is only a name: "
             "nothing is converted.");
    declarations.text("Time", time, name).means("Name of the unit of time.");
    declarations.text("Force", force, name).means("Name of the unit of force.");
  }

  void
  UnitNames::require_plain() const
  {
    for (const auto &[entry, name] : {std::pair("Length", length), std::pair("Time", time), std::pair("Force", force)})
      if (name.empty() || name.find_first_of(",;\"[]") != std::string::npos)
        refuse(std::string("Units/") + entry,
               "\"Units/{}\" is \"{}\", but a name without commas, quotes and brackets is expected",
               entry,
               name);
  }

  std::string
  UnitNames::of(const std::string &unit) const
  {
    const auto is_letter = [](const unsigned char c) { return std::isalpha(c) != 0; };
    std::string named;
    for (auto from = unit.begin(); from != unit.end();)
    {
      const auto to          = std::find_if_not(from, unit.end(), is_letter);
      const std::string word = std::string(from, to);
      named += word == "length"                    ? length
               : word == "time"                    ? time
               : word == "force"                   ? force
               : word == "energy" && !is_general() ? force + " " + length
                                                   : word;
      if (to == unit.end())
        break;
      named += *to;
      from = to + 1;
    }
    return named;
  }

  std::string
  UnitNames::in_brackets(const std::string &text) const
  {
    std::string named;
    std::size_t done = 0;
    for (std::size_t open = text.find('['); open != std::string::npos; open = text.find('[', done))
    {
      const std::size_t close = std::min(text.find(']', open), text.size());
      named += text.substr(done, open + 1 - done) + of(text.substr(open + 1, close - open - 1));
      done = close;
    }
    return named + text.substr(done);
  }
} // namespace crawler
