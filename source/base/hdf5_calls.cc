// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/hdf5_calls.h>
#include <crawler/base/process.h>

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <set>
#include <tuple>

namespace crawler::hdf5
{
  hid_t
  checked(const hid_t result, const std::filesystem::path &path, const std::string &what)
  {
    const bool writes = what == "write" || what == "create";
    if (result < 0)
      throw FileError(fmt::format("cannot {} \"{}\"{}", what, path.string(), writes ? " (is the disk full?)" : ""));
    return result;
  }

  void
  require_space(const std::filesystem::path &path, const double bytes)
  {
    std::error_code no_space;
    const auto left = std::filesystem::space(std::filesystem::absolute(path).parent_path(), no_space).available;
    if (!no_space && static_cast<double>(left) < bytes)
      throw FileError(fmt::format("\"{}\" needs {:.3g} MB, but only {:.3g} MB are left: the disk is full",
                                  path.string(),
                                  bytes / 1e6,
                                  static_cast<double>(left) / 1e6));
  }

  hid_t
  text_type(const std::size_t width)
  {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, width);
    H5Tset_strpad(type, H5T_STR_NULLPAD);
    H5Tset_cset(type, H5T_CSET_ASCII);
    return type;
  }

  void
  write_attribute(const hid_t object,
                  const std::string &name,
                  const std::string &text,
                  const std::filesystem::path &path)
  {
    const Hdf5Handle type(text_type(std::max<std::size_t>(text.size(), 1)), H5Tclose),
      space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle attribute(H5Acreate(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    const std::string value = text.empty() ? std::string(1, '\0') : text;
    checked(attribute < 0 ? -1 : H5Awrite(attribute, type, value.data()), path, "write");
  }

  hid_t
  create_dataset(const hid_t parent,
                 const std::string &name,
                 const hid_t type,
                 const hid_t space,
                 const bool is_filled,
                 const std::filesystem::path &path)
  {
    const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(creation, is_filled ? H5D_FILL_TIME_ALLOC : H5D_FILL_TIME_NEVER);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (H5Tget_class(type) == H5T_FLOAT)
      H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &nan);
    return checked(H5Dcreate(parent, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), path, "write");
  }

  Part::Part(const hid_t dataset, const std::vector<hsize_t> &start, const std::vector<hsize_t> &count)
    : dataset_(dataset)
    , memory_(H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr), H5Sclose)
    , space_(H5Dget_space(dataset), H5Sclose)
  {
    H5Sselect_hyperslab(space_, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  }

  void
  Part::read(const hid_t type, void *const values, const std::filesystem::path &path) const
  {
    checked(H5Dread(dataset_, type, memory_, space_, H5P_DEFAULT, values), path, "read");
  }

  void
  Part::write(const hid_t type, const void *const values, const std::filesystem::path &path, const hid_t transfer) const
  {
    checked(H5Dwrite(dataset_, type, memory_, space_, transfer, values), path, "write");
  }

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
