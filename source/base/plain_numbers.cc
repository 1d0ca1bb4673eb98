// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/plain_numbers.h>

#include <algorithm>
#include <cctype>
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
      if (end + 1 < text.size() && text[end] == ',' && std::isdigit(static_cast<unsigned char>(text[end + 1])) != 0)
        continue; // a decimal comma of quoted input, kept as it was
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

  std::string
  without_controls(const std::string &text, const bool keep_lines)
  {
    constexpr char digits[] = "0123456789abcdef";
    std::string result;
    unsigned int n_following = 0; // remaining bytes of the present UTF-8 character
    for (std::size_t i = 0; i < text.size(); ++i)
    {
      const auto byte    = static_cast<unsigned char>(text[i]);
      const auto next    = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
      const bool goes_on = n_following > 0 && (byte & 0xc0) == 0x80;
      // Control characters of ASCII, those of U+0080 to U+009F, and the latter as single bytes.
      const bool is_control     = byte < 0x20 || byte == 0x7f || (byte >= 0x80 && byte < 0xa0 && !goes_on);
      const bool begins_control = byte == 0xc2 && next >= 0x80 && next < 0xa0;
      n_following               = goes_on                 ? n_following - 1
                                  : begins_control        ? 0
                                  : (byte & 0xe0) == 0xc0 ? 1
                                  : (byte & 0xf0) == 0xe0 ? 2
                                  : (byte & 0xf8) == 0xf0 ? 3
                                                          : 0;
      if ((is_control && !(keep_lines && (byte == '\n' || byte == '\t'))) || begins_control)
        result += {'\\', 'x', digits[byte / 16], digits[byte % 16]};
      else
        result += text[i];
    }
    return result;
  }

  std::size_t
  whole_characters(const std::string &text, const std::size_t width)
  {
    std::size_t size = std::min(text.size(), width);
    if (size < text.size())
      while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xc0) == 0x80)
        --size;
    return size;
  }

  std::string
  shortened(const std::string &text, const std::size_t width)
  {
    if (text.size() <= width)
      return text;
    const std::string dots = "...";
    return text.substr(0, whole_characters(text, width - dots.size())) + dots;
  }

  std::string
  with_short_quotes(const std::string &text)
  {
    constexpr std::size_t most = 300, shown = 60; // at each end
    std::string result;
    for (std::size_t begin = 0; begin < text.size();)
    {
      const std::size_t open  = text.find('"', begin);
      const std::size_t close = open == std::string::npos ? open : text.find('"', open + 1);
      if (close == std::string::npos)
        return result + text.substr(begin);
      const std::string quoted = text.substr(open + 1, close - open - 1);
      result += text.substr(begin, open + 1 - begin);
      if (quoted.size() <= most)
        result += quoted;
      else // cut at ends of UTF-8 characters
        result += quoted.substr(0, whole_characters(quoted, shown)) + " ... (" + std::to_string(quoted.size()) +
                  " characters) ... " + quoted.substr(whole_characters(quoted, quoted.size() - shown));
      result += '"';
      begin = close + 1;
    }
    return result;
  }
} // namespace crawler
