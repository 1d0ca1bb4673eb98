// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
  /// Bytes as text, as in the binary arrays of VTK's XML files (RFC 4648).
  std::string
  encode_base64(const std::vector<unsigned char> &bytes);

  /// The other way round. Throws InputError if @p text is no such text.
  std::vector<unsigned char>
  decode_base64(const std::string &text);
} // namespace crawler
