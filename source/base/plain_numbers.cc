// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/plain_numbers.h>

#include <algorithm>
#include <string_view>

namespace crawler
{
  std::string
  with_plain_numbers(std::string text)
  {
    constexpr std::string_view before = " \n(,:=", after = " \n),;:";
    for (std::size_t minus = text.find('-'); minus != text.npos; minus = text.find('-', minus + 1))
    {
      if (minus > 0 && before.find(text[minus - 1]) == before.npos)
        continue;
      std::size_t end = minus + 1;
      if (text.compare(end, 3, "nan") == 0)
        end += 3;
      else if (text[end] == '0')
        end = std::min(text.find_first_not_of(text.compare(end, 2, "0.") == 0 ? "0." : "0", end), text.size());
      if (end == minus + 1 || (end < text.size() && after.find(text[end]) == after.npos))
        continue;
      const bool is_aligned = minus > 1 && text.compare(minus - 2, 2, "  ") == 0;
      text.replace(minus, 1, is_aligned ? " " : "");
    }
    return text;
  }

  std::string
  counted(const unsigned long number, const std::string &noun)
  {
    return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
  }
} // namespace crawler
