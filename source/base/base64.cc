// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/base64.h>
#include <crawler/base/exceptions.h>

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/dataflow_exception.hpp>
#include <boost/archive/iterators/transform_width.hpp>

#include <algorithm>

namespace crawler
{
  namespace
  {
    using namespace boost::archive::iterators;
    using Encoder = base64_from_binary<transform_width<std::vector<unsigned char>::const_iterator, 6, 8>>;
    using Decoder = transform_width<binary_from_base64<std::string::const_iterator>, 8, 6>;
  } // namespace

  std::string
  encode_base64(const std::vector<unsigned char> &bytes)
  {
    // Whole groups of three bytes, since the iterator would read beyond the end.
    std::vector<unsigned char> groups = bytes;
    groups.resize((bytes.size() + 2) / 3 * 3, 0);
    std::string text(Encoder(groups.cbegin()), Encoder(groups.cend()));
    const std::size_t missing = groups.size() - bytes.size();
    text.replace(text.size() - missing, missing, missing, '=');
    return text;
  }

  std::vector<unsigned char>
  decode_base64(const std::string &text)
  {
    std::string letters       = text;
    const std::size_t missing = std::min<std::size_t>(2, letters.size() - (letters.find_last_not_of('=') + 1));
    if (letters.size() % 4 != 0)
      throw InputError("a text in base 64 that is not whole");
    std::replace(letters.end() - static_cast<std::ptrdiff_t>(missing), letters.end(), '=', 'A');
    try
    {
      std::vector<unsigned char> bytes(Decoder(letters.cbegin()), Decoder(letters.cend()));
      for (std::size_t i = 0; i < missing && !bytes.empty(); ++i)
        bytes.pop_back();
      return bytes;
    }
    catch (const dataflow_exception &)
    {
      throw InputError("a text that is not in base 64");
    }
  }
} // namespace crawler
