// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/stop_place.h>

#include <boost/crc.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

namespace crawler
{
  std::filesystem::path
  temporary_file(const std::filesystem::path &path)
  {
    std::filesystem::path temporary = path.string() + ".part";
    std::error_code error;
    std::filesystem::remove(temporary, error);
    if (error)
      throw FileError("cannot write \"" + temporary.string() + "\": " + error.message());
    return temporary;
  }

  void
  write_file(const std::filesystem::path &path, const std::string &content)
  {
    const std::filesystem::path temporary = temporary_file(path);
    std::FILE *const file                 = std::fopen(temporary.c_str(), "wbx"); // a new file, not through a link
    bool is_good = file != nullptr && std::fwrite(content.data(), 1, content.size(), file) == content.size();
    int reason   = errno;
    if (file != nullptr && std::fclose(file) != 0 && is_good)
    {
      is_good = false;
      reason  = errno;
    }
    std::error_code error;
    if (!is_good)
    {
      if (file != nullptr)
        std::filesystem::remove(temporary, error);
      throw FileError("cannot write \"" + path.string() + "\": " + std::strerror(reason));
    }
    rename_whole(temporary, path);
  }

  void
  rename_whole(const std::filesystem::path &temporary, const std::filesystem::path &path)
  {
    reach_write(path);
    std::error_code error;
    std::filesystem::rename(temporary, path, error);
    if (!error)
      return;
    const std::string reason = error.message();
    std::filesystem::remove(temporary, error);
    throw FileError("cannot write \"" + path.string() + "\": " + reason);
  }

  void
  cut_file(const std::filesystem::path &path, const std::uintmax_t size)
  {
    std::error_code error;
    const bool is_own           = std::filesystem::is_regular_file(std::filesystem::symlink_status(path, error));
    const std::uintmax_t before = is_own ? std::filesystem::file_size(path, error) : 0;
    if (!is_own || error || before < size)
      throw FileError(fmt::format("cannot continue \"{}\": a file of at least {} bytes is expected, but {}",
                                  path.string(),
                                  size,
                                  is_own ? fmt::format("it has {}", before) : "it does not exist"));
    std::filesystem::resize_file(path, size, error);
    if (error)
      throw FileError("cannot write \"" + path.string() + "\": " + error.message());
  }

  std::string
  unreadable(const std::filesystem::path &path)
  {
    constexpr std::uintmax_t most = std::uintmax_t(1) << 32;
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (std::filesystem::is_character_file(status) || std::filesystem::is_block_file(status))
      return "is a device";
    if (std::filesystem::is_regular_file(status) && std::filesystem::file_size(path, error) > most && !error)
      return "is larger than 4 GiB";
    return "";
  }

  std::string
  in_words(const std::filesystem::filesystem_error &error)
  {
    return fmt::format("cannot use \"{}\": {}", error.path1().string(), error.code().message());
  }

  std::string
  read_whole_file(const std::filesystem::path &path)
  {
    if (const std::string reason = unreadable(path); !reason.empty())
      throw FileError("cannot read \"" + path.string() + "\": it " + reason);
    std::ifstream in(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (!in)
      throw FileError("cannot read \"" + path.string() + "\"");
    return text;
  }

  std::string
  fingerprint(const std::filesystem::path &path)
  {
    std::ifstream in(path, std::ios::binary);
    boost::crc_32_type checksum;
    std::size_t n = 0;
    for (std::vector<char> piece(1 << 16); in;)
    {
      in.read(piece.data(), static_cast<std::streamsize>(piece.size()));
      checksum.process_bytes(piece.data(), static_cast<std::size_t>(in.gcount()));
      n += static_cast<std::size_t>(in.gcount());
    }
    if (!in.eof())
      throw FileError("cannot read \"" + path.string() + "\"");
    return fmt::format("{} bytes, CRC-32 {:08x}", n, checksum.checksum());
  }

  std::string_view
  without_byte_order_mark(const std::string_view text)
  {
    constexpr std::string_view mark = "\xef\xbb\xbf";
    return text.starts_with(mark) ? text.substr(mark.size()) : text;
  }

  std::string
  foreign_format(const std::string_view text)
  {
    if (text.starts_with("PK\x03\x04"))
      return "a zip archive, as .xlsx, .ods and .docx files are";
    const bool has_zeros = text.size() > 3 && ((text[0] == 0 && text[2] == 0) || (text[1] == 0 && text[3] == 0));
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") || has_zeros)
      return "text in UTF-16";
    if (std::ranges::any_of(text, [](const char c) { return static_cast<unsigned char>(c) < 9; }))
      return "a binary file";
    const auto ends_line = [](const char c, const char next) { return c == '\r' && next != '\r' && next != '\n'; };
    return std::ranges::adjacent_find(text, ends_line) != text.end() ? "text with old Mac line ends (CR alone)" : "";
  }
} // namespace crawler
