// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>

/// What a fuzzer calls with bytes of its own (the interface of libFuzzer). Each file of this folder has one, which
/// gives them to a reader of the program. It must end within seconds, without a leak, and in order or with one of the
/// named exceptions.
extern "C" int
LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);

namespace crawler::fuzz
{
  /// The bytes of a fuzzer, taken from the front; behind their end there are zeros.
  class Bytes
  {
  public:
    Bytes(const std::uint8_t *data, const std::size_t size)
      : rest_(reinterpret_cast<const char *>(data), size)
    {
    }

    bool
    is_empty() const
    {
      return rest_.empty();
    }
    const std::string &
    rest() const
    {
      return rest_;
    }

    template <typename Number>
    Number
    number()
    {
      Number value{};
      const std::size_t n = std::min(sizeof(value), rest_.size());
      std::memcpy(&value, rest_.data(), n);
      rest_.erase(0, n);
      return value;
    }

    /// Up to @p separator, which is taken away.
    std::string
    word(const char separator)
    {
      const std::size_t end  = rest_.find(separator);
      const std::string text = rest_.substr(0, end);
      rest_.erase(0, end == std::string::npos ? end : end + 1);
      return text;
    }

  private:
    std::string rest_;
  };

  /// A file that is in order, with changes that the rest of @p bytes describes: so fuzzers reach what is behind
  /// signatures and sizes, and inputs stay of use when the layout of a file changes.
  std::string
  damaged(std::string file, Bytes &bytes);

  /// Runs @p work, which may throw the exceptions that the program answers with a sentence. Returns whether it did not.
  template <typename Work>
  bool
  is_accepted(const Work &work)
  {
    try
    {
      work();
      return true;
    }
    catch (const InputError &)
    {
      return false;
    }
    catch (const FileError &)
    {
      return false;
    }
  }

  /// Ends the program, as a failed assertion does.
  void
  require(bool condition, const char *what);

  /// A folder in memory that this process has for itself until it ends.
  const std::filesystem::path &
  scratch();

  /// Starts MPI and PETSc, if they do not run yet; what they keep is no leak of ours.
  void
  start_mpi();
} // namespace crawler::fuzz
