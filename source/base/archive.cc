// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/archive.h>
#include <crawler/base/exceptions.h>

#include <cstring>

namespace crawler
{
  void
  Archive::raw(void *data, const std::size_t n)
  {
    if (!reads_)
    {
      bytes_.append(static_cast<const char *>(data), n);
      return;
    }
    if (n > bytes_.size() - place_)
      fail("its end");
    if (n > 0)
      std::memcpy(data, bytes_.data() + place_, n);
    place_ += n;
  }

  void
  Archive::fail(const std::string_view what)
  {
    throw FileError("a saved state does not match the program: " + std::string(what) + " differs");
  }
} // namespace crawler
