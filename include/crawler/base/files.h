// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace crawler
{
  /// Name of the temporary file beside @p path under which it is written until complete. An existing file of that name
  /// is removed; if it is a link, its target is not touched. Throws FileError.
  std::filesystem::path
  temporary_file(const std::filesystem::path &path);

  /// Renames a complete temporary file to its final name; removes it if that fails. Throws FileError.
  void
  rename_whole(const std::filesystem::path &temporary, const std::filesystem::path &path);

  /// Writes a whole file, first beside it under another name, then renamed: a file under its own name is always
  /// complete. Throws FileError.
  void
  write_file(const std::filesystem::path &path, const std::string &content);

  /// Cuts a file to @p size bytes. Throws FileError, also if it is shorter.
  void
  cut_file(const std::filesystem::path &path, std::uintmax_t size);

  /// Reason in words why a file named by the user must not be read (devices may have no end). Empty if it may be read.
  std::string
  unreadable(const std::filesystem::path &path);

  /// The message of the file system as a sentence.
  std::string
  in_words(const std::filesystem::filesystem_error &error);

  /// The whole text of a file. Throws FileError.
  std::string
  read_whole_file(const std::filesystem::path &path);

  /// Fingerprint that distinguishes a changed file: "12 bytes, CRC-32 0a1b2c3d" (the checksum of zlib and of `crc32`).
  /// Throws FileError.
  std::string
  fingerprint(const std::filesystem::path &path);

  /// The text without the byte order mark that some editors put before UTF-8.
  std::string_view
  without_byte_order_mark(std::string_view text);

  /// Name of the foreign format ("text in UTF-16") if @p text is not lines of text in UTF-8 but what other programs
  /// write; else empty.
  std::string
  foreign_format(std::string_view text);
} // namespace crawler
