// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/short_text.h>

#include <algorithm>

namespace crawler
{
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
} // namespace crawler
