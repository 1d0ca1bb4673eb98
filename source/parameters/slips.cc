// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/slips.h>

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <regex>

namespace crawler
{
  namespace
  {
    /// A UTF-8 sign, its name, and the keyboard's sign for it.
    struct Sign
    {
      const char *bytes, *name, *expected;
    };
    constexpr const char *blank = "a blank", *minus = "\"-\"", *quote = "the straight quote \" or none",
                         *times = "\"*\"";
    constexpr Sign signs[]      = {{"\xC2\xA0", "a no-break space (U+00A0)", blank},
                                   {"\xE2\x80\x87", "a figure space (U+2007)", blank},
                                   {"\xE2\x80\x89", "a thin space (U+2009)", blank},
                                   {"\xE2\x80\xAF", "a narrow no-break space (U+202F)", blank},
                                   {"\xE2\x80\x8B", "a zero-width space (U+200B)", "nothing"},
                                   {"\xEF\xBB\xBF", "a byte order mark (U+FEFF)", "nothing"},
                                   {"\xE2\x88\x92", "a typographic minus sign (U+2212)", minus},
                                   {"\xE2\x80\x90", "a typographic hyphen (U+2010)", minus},
                                   {"\xE2\x80\x91", "a no-break hyphen (U+2011)", minus},
                                   {"\xE2\x80\x93", "a dash (U+2013)", minus},
                                   {"\xE2\x80\x94", "a long dash (U+2014)", minus},
                                   {"\xE2\x80\x9C", "a typographic quote (U+201C)", quote},
                                   {"\xE2\x80\x9D", "a typographic quote (U+201D)", quote},
                                   {"\xE2\x80\x9E", "a typographic quote (U+201E)", quote},
                                   {"\xE2\x80\x98", "a typographic quote (U+2018)", quote},
                                   {"\xE2\x80\x99", "a typographic quote (U+2019)", quote},
                                   {"\xC2\xAB", "a typographic quote (U+00AB)", quote},
                                   {"\xC2\xBB", "a typographic quote (U+00BB)", quote},
                                   {"\xC3\x97", "a typographic times sign (U+00D7)", times},
                                   {"\xC2\xB7", "a centred dot (U+00B7)", times},
                                   {"\xE2\x8B\x85", "a centred dot (U+22C5)", times},
                                   {"\xCF\x80", "a Greek pi (U+03C0)", "\"pi\""}};
  } // namespace

  std::string
  foreign_sign(const std::string &text)
  {
    const Sign *first = nullptr;
    std::size_t place = std::string::npos;
    for (const Sign &sign : signs)
      if (const auto found = text.find(sign.bytes); found < place)
      {
        first = &sign;
        place = found;
      }
    if (first == nullptr)
      return "";
    return fmt::format("there is {} in \"{}\", but {} is expected", first->name, text, first->expected);
  }

  std::string
  home_sign(const std::string &file)
  {
    if (file != "~" && !file.starts_with("~/"))
      return "";
    const char *const home = std::getenv("HOME");
    return fmt::format(
      "\"{}\" begins with \"~\", which only a shell replaces by the home folder; the full path is expected{}",
      file,
      home == nullptr ? "" : fmt::format(": {}{}", home, file.substr(1)));
  }

  std::string
  probable_slip(const std::string &value)
  {
    std::smatch found;
    // Decimal commas are single commas between digits; neither two arguments of a function nor a list of three or more.
    static const std::regex comma(R"((^|[^\w.,])(\d+),(\d+)(?![\d.,]))"),
      arguments(R"(\(\d+,\d+\)|(lin|log)space\([^,()]*,[^,()]*,[^,()]*\))");
    if (const std::string rest = std::regex_replace(value, arguments, ""); std::regex_search(rest, found, comma))
      return fmt::format("; decimals are written with a point: {}.{}", found.str(2), found.str(3));
    static const std::regex home(R"(^~/.*$|~/[^\s,;:")]*)");
    if (std::regex_search(value, found, home))
      return "; " + home_sign(found.str(0));
    static const std::regex exponent(R"((?:^|[^\w.])((?:\d+\.?\d*|\.\d+)[eE]\+?\d+)(?![\w.]))");
    for (std::sregex_iterator number(value.begin(), value.end(), exponent); number != std::sregex_iterator(); ++number)
      if (std::isinf(std::strtod(number->str(1).c_str(), nullptr)))
        return fmt::format("; the largest number is {:.1e}", std::numeric_limits<double>::max());
    return "";
  }

  std::string
  successor_of(const std::string &former)
  {
    if (former == "atlas")
      return "\"crawler sweep\" with the entry \"Sweep/Cross-check = true\"";
    if (former == "Atlas")
      return "\"Sweep/Axes = FIRST AXIS; SECOND AXIS\" with \"Sweep/Cross-check = true\", \"Sweep/Cross-check "
             "refinement\" "
             "(was Refinement) and \"Sweep/Time limit per point\" (was Time limit per run)";
    return "";
  }
} // namespace crawler
