// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/hdf5_trial.h>
#include <crawler/base/process.h>

#include <sys/stat.h>

#include <mutex>
#include <set>
#include <tuple>

namespace crawler::hdf5
{
  bool
  is_harmless(const std::filesystem::path &path, const std::string &purpose, const std::function<void()> &read)
  {
    using Version = std::tuple<std::string, dev_t, ino_t, off_t, time_t, long>;
    static std::mutex access;
    static std::set<Version> known;
    constexpr off_t bytes_per_second = 20000000; // of slow disks, and of compressed data
    constexpr unsigned int least     = 5;
    struct stat state;
    if (::stat(path.c_str(), &state) != 0)
      return true; // opening it gives the reason
    const Version version = {
      purpose, state.st_dev, state.st_ino, state.st_size, state.st_mtim.tv_sec, state.st_mtim.tv_nsec};
    const std::lock_guard lock(access);
    if (known.contains(version))
      return true;
    const bool is_good = comes_to_an_end(read, least + static_cast<unsigned int>(state.st_size / bytes_per_second));
    if (is_good)
      known.insert(version);
    return is_good;
  }
} // namespace crawler::hdf5
