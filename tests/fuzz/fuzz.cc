// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../support/temporary_folder.h"

#include <crawler/base/mpi_session.h>

#include <cstdio>
#include <cstdlib>

#include "fuzz.h"

#ifdef __SANITIZE_ADDRESS__
#  include <sanitizer/lsan_interface.h>

/// What MPI keeps to the end of a program, and what HDF5 loses when it refuses a damaged file.
extern "C" const char *
__lsan_default_suppressions()
{
  return "leak:libpmix\nleak:libopen-pal\nleak:libopen-rte\nleak:libmpi\nleak:libhdf5\n";
}
#endif

namespace crawler::fuzz
{
  std::string
  damaged(std::string file, Bytes &bytes)
  {
    while (!bytes.is_empty() && !file.empty())
    {
      const auto kind         = bytes.number<std::uint8_t>();
      const std::size_t place = bytes.number<std::uint32_t>() % file.size();
      const auto value        = bytes.number<std::uint64_t>();
      switch (kind % 6)
      {
        case 0: // a bit
          file[place] = static_cast<char>(file[place] ^ (1 << value % 8));
          break;
        case 1: // a byte
          file[place] = static_cast<char>(value);
          break;
        case 2: // a number of 64 bits, as sizes and addresses are
          std::memcpy(&file[place], &value, std::min(sizeof(value), file.size() - place));
          break;
        case 3: // another part of the file
          file.replace(place,
                       std::min<std::size_t>(value % 64, file.size() - place),
                       file.substr(value % file.size(), value % 64));
          break;
        case 4: // a gap
          file.erase(place, 1 + value % 64);
          break;
        default: // an end
          file.resize(place);
      }
    }
    return file;
  }

  void
  require(const bool condition, const char *what)
  {
    if (condition)
      return;
    std::fprintf(stderr, "expected: %s\n", what);
    std::abort();
  }

  const std::filesystem::path &
  scratch()
  {
    static const std::filesystem::path memory = "/dev/shm";
    static const test::TemporaryFolder folder(
      std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path());
    return folder.path;
  }

  void
  start_mpi()
  {
    static auto *const started = []() {
      static char name[]   = "fuzz";
      static char *words[] = {name, nullptr}, **arguments = words;
      static int n = 1;
#ifdef __SANITIZE_ADDRESS__
      __lsan_disable();
#endif
      // Not ended: that would look for leaks in what a fuzzer leaves when it ends itself.
      auto *const guard = new crawler::MpiSession(n, arguments);
#ifdef __SANITIZE_ADDRESS__
      __lsan_enable();
#endif
      return guard;
    }();
    require(started != nullptr, "MPI runs");
  }
} // namespace crawler::fuzz
