// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/hdf5_calls.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /**
   * The file solution.h5: datasets with a row for each frame and room for the points of the largest mesh. Its layout is
   * made with the file; later only numbers are written, so a file whose writer was killed is valid.
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
      Shape shape;           ///< of a row, or of the whole dataset; n_points stands for the number of points
      bool is_whole = false; ///< integers
    };
    static constexpr hsize_t n_points = 0;

    /// Datasets by name.
    static const std::map<std::string, Layout> &
    layouts();

    /// The shape of @p n_rows rows (of the dataset, if it has no rows) with @p n points.
    static Shape
    shape(const Layout &layout, std::size_t n_rows, std::size_t n);

    /// Creates a file whose numbers are NaN. Throws FileError.
    static void
    create(const std::filesystem::path &path, std::size_t n_frames, std::size_t n);

    /// Opens a file made by create(). Throws FileError.
    explicit SnapshotHdf5(const std::filesystem::path &path);

    /// Writes @p values, @p n_rows rows from @p row on with @p n points each, or a dataset without rows. They are in
    /// the file on return. Throws FileError.
    void
    write(const std::string &name,
          const std::vector<double> &values,
          std::size_t row    = 0,
          std::size_t n_rows = 1,
          std::size_t n      = 1) const;

    /// Reads rows. Throws FileError.
    std::vector<double>
    read(const std::string &name, std::size_t row, std::size_t n_rows, std::size_t n) const;

    /// Capacity: number of frames, and of points in each.
    std::pair<std::size_t, std::size_t>
    size() const;

    /// Offset of the numbers of a row in the file [bytes].
    std::size_t
    place(const std::string &name, std::size_t row) const;

  private:
    hdf5::Part
    part(const std::string &name, std::size_t row, std::size_t n_rows, std::size_t n) const;

    std::filesystem::path path_;
    Hdf5Handle file_;
    std::map<std::string, std::unique_ptr<Hdf5Handle>> datasets_;
  };
} // namespace crawler
