// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/hdf5_handle.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /**
   * solution.h5: datasets with a row for each frame and room for as many points as the largest mesh has. Its layout is
   * made with the file and later only numbers are written, so that a file whose writer was killed is a valid file.
   */
  class SnapshotHdf5
  {
  public:
    using Shape = std::vector<hsize_t>;
    /// A dataset of the file.
    struct Layout
    {
      std::string unit, description;
      bool has_rows;         ///< one for each frame
      Shape shape;           ///< of a row, or of all; n_points stands for the number of points
      bool is_whole = false; ///< whole numbers
    };
    static constexpr hsize_t n_points = 0;

    /// All datasets by their names.
    static const std::map<std::string, Layout> &
    layouts();

    /// The shape of @p n_rows rows (of all, if there are no rows) with @p n points.
    static Shape
    shape(const Layout &layout, std::size_t n_rows, std::size_t n);

    /// Makes a file in which numbers are NaN. Throws FileError.
    static void
    create(const std::filesystem::path &path, std::size_t n_frames, std::size_t n);

    /// Opens what create() has made. Throws FileError.
    explicit SnapshotHdf5(const std::filesystem::path &path);

    /// Writes @p values, @p n_rows rows from @p row on with @p n points each, or a dataset without rows. They are in
    /// the file when this returns. Throws FileError.
    void
    write(const std::string &name,
          const std::vector<double> &values,
          std::size_t row    = 0,
          std::size_t n_rows = 1,
          std::size_t n      = 1) const;

    /// Throws FileError.
    std::vector<double>
    read(const std::string &name, std::size_t row, std::size_t n_rows, std::size_t n) const;

    /// Frames, and points of each of them, for which there is room.
    std::pair<std::size_t, std::size_t>
    size() const;

    /// Where the numbers of a row begin in the file, in bytes.
    std::size_t
    place(const std::string &name, std::size_t row) const;

  private:
    /// Calls @p work with the dataset, the spaces of memory and file, and the number of values.
    template <typename Work>
    void
    select(const std::string &name, std::size_t row, std::size_t n_rows, std::size_t n, const Work &work) const;

    std::filesystem::path path_;
    Hdf5Handle file_;
    std::map<std::string, std::unique_ptr<Hdf5Handle>> datasets_;
  };
} // namespace crawler
