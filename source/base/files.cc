// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

namespace crawler
{
  void
  write_file(const std::filesystem::path &path, const std::string &content)
  {
    const std::filesystem::path temporary = path.string() + ".part";
    {
      std::ofstream out(temporary, std::ios::binary);
      out << content;
      out.close();
      if (!out)
        throw FileError("cannot write \"" + path.string() + "\": " + std::strerror(errno));
    }
    std::error_code error;
    std::filesystem::rename(temporary, path, error);
    if (error)
      throw FileError("cannot write \"" + path.string() + "\": " + error.message());
  }

  std::string
  read_whole_file(const std::filesystem::path &path)
  {
    std::ifstream in(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (!in)
      throw FileError("cannot read \"" + path.string() + "\"");
    return text;
  }
} // namespace crawler
