// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /// An object of HDF5, closed at the end of its life; nothing is closed if the identifier is negative, HDF5's sign of
  /// a failed call.
  class Hdf5Handle
  {
  public:
    Hdf5Handle(const hid_t id, herr_t (*close)(hid_t))
      : id_(id)
      , close_(close)
    {
    }
    Hdf5Handle(Hdf5Handle &&other) noexcept
      : id_(std::exchange(other.id_, -1))
      , close_(other.close_)
    {
    }
    ~Hdf5Handle()
    {
      if (id_ >= 0)
        close_(id_);
    }
    operator hid_t() const
    {
      return id_;
    }

  private:
    hid_t id_;
    herr_t (*const close_)(hid_t);
  };

  namespace hdf5
  {
    /// Returns the @p result of a call that does @p what ("write", "create", "open", "read") with a file. Throws
    /// FileError if it is negative, HDF5's sign of a failed call.
    hid_t
    checked(hid_t result, const std::filesystem::path &path, const std::string &what);

    /// Throws FileError if there is no room for @p bytes beside @p path. HDF5 cannot close a file that it could not
    /// write: it crashes at the end of the process.
    void
    require_space(const std::filesystem::path &path, double bytes);

    /// Type of texts of @p width bytes (the caller closes it). UTF-8 labelled ASCII: Octave cannot read a group with
    /// texts labelled UTF-8, and for pure ASCII, all texts but file names, it makes no difference.
    hid_t
    text_type(std::size_t width);

    /// Writes a text attribute. Throws FileError.
    void
    write_attribute(hid_t object, const std::string &name, const std::string &text, const std::filesystem::path &path);

    /// Creates a dataset (the caller closes it) with room for all its values at once. If @p is_filled they are NaN, 0
    /// or empty texts until they are written. Throws FileError.
    hid_t
    create_dataset(hid_t parent,
                   const std::string &name,
                   hid_t type,
                   hid_t space,
                   bool is_filled,
                   const std::filesystem::path &path);

    /// Part of a dataset: in each direction @p count values from @p start on.
    class Part
    {
    public:
      Part(hid_t dataset, const std::vector<hsize_t> &start, const std::vector<hsize_t> &count);

      /// Both are for @p values of this type in memory. Throw FileError.
      void
      read(hid_t type, void *values, const std::filesystem::path &path) const;
      void
      write(hid_t type, const void *values, const std::filesystem::path &path, hid_t transfer = H5P_DEFAULT) const;

    private:
      const hid_t dataset_;
      const Hdf5Handle memory_, space_;
    };

    /// True if @p read, which reads the structure of the HDF5 file @p path, terminates. HDF5 1.10 crashes on some
    /// damaged files and never ends on others, so a copy of this process tries first, once for each @p purpose and each
    /// state of a file.
    bool
    is_harmless(const std::filesystem::path &path, const std::string &purpose, const std::function<void()> &read);
  } // namespace hdf5
} // namespace crawler
