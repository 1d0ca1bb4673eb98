// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace crawler
{
  /// The name under which a file is written until it is complete, beside it. What stands there is removed; if that is a
  /// link, what it points to is not touched. Throws FileError.
  std::filesystem::path
  temporary_file(const std::filesystem::path &path);

  /// Gives a temporary file that is complete its name; it is removed if that fails. Throws FileError.
  void
  rename_whole(const std::filesystem::path &temporary, const std::filesystem::path &path);

  /// Writes a whole file: first beside it under another name, then renamed, so that a file under its own name is always
  /// complete. Throws FileError.
  void
  write_file(const std::filesystem::path &path, const std::string &content);

  /// Cuts a file that may be longer to @p size bytes. Throws FileError, also if it is shorter.
  void
  cut_file(const std::filesystem::path &path, std::uintmax_t size);

  /// Why a file that users name is not to be read, in words: devices may have no end. Empty if it may be read.
  std::string
  unreadable(const std::filesystem::path &path);

  /// What the file system says, in a sentence.
  std::string
  in_words(const std::filesystem::filesystem_error &error);

  /// The whole text of a file. Throws FileError.
  std::string
  read_whole_file(const std::filesystem::path &path);

  /// What tells a changed file from the old one: "12 bytes, CRC-32 0a1b2c3d" (the checksum of zlib and of `crc32`).
  /// Throws FileError.
  std::string
  fingerprint(const std::filesystem::path &path);

  /// A text without the mark that some editors put before UTF-8.
  std::string_view
  without_byte_order_mark(std::string_view text);

  /// What other programs make instead of text in UTF-8, in words ("text in UTF-16"); empty if @p text is none of them.
  std::string
  foreign_format(std::string_view text);
} // namespace crawler
