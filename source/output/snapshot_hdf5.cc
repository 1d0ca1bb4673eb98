// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/hdf5_calls.h>
#include <crawler/output/scenery.h>
#include <crawler/output/snapshot_hdf5.h>

#include <algorithm>
#include <numeric>

namespace crawler
{
  namespace
  {
    using Layout = SnapshotHdf5::Layout;

    std::size_t
    product(const SnapshotHdf5::Shape &shape)
    {
      return std::accumulate(shape.begin(), shape.end(), std::size_t(1), std::multiplies<>());
    }

    Hdf5Handle
    opened(const std::filesystem::path &path)
    {
      const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
      H5Pset_sieve_buf_size(access, 1); // write numbers to the file at once
      return {hdf5::checked(H5Fopen(path.c_str(), H5F_ACC_RDWR, access), path, "open"), H5Fclose};
    }

  } // namespace

  const std::map<std::string, SnapshotHdf5::Layout> &
  SnapshotHdf5::layouts()
  {
    static const std::map<std::string, Layout> all = [] {
      const hsize_t arrows = 3 * n_arrows, strips = 4 * Scenery::max_ground;
      std::map<std::string, Layout> layouts = {
        {"time", {"time", "time of each frame; NaN: it was not written", true, {}}},
        {"step", {"1", "number of the time step", true, {}, true}},
        {"n_points", {"1", "number of points of each frame; what follows them is NaN", true, {}, true}},
        {"body/points", {"length", "x, y and z at the ground and at the upper edge", true, {n_points, 2, 3}}},
        {"body/s", {"length", "place at rest", true, {n_points, 2}}},
        {"line/cells", {"1", "the points in their order", false, {1, n_points}, true}},
        {"line/s", {"length", "place at rest", true, {n_points}}},
        {"line/points", {"length", "s on the x axis", true, {n_points, 3}}},
        {"grip/points",
         {"length", "corners of the triangles that show the forces of the ground on the body", true, {arrows, 3}}},
        {"grip/friction_force", {"force/length", "of each corner", true, {arrows}}},
        {"grip/cells", {"1", "corners of the triangles", false, {n_arrows, 3}, true}},
        {"ground/points", {"length", "corners of the quadrilaterals that show the ground", false, {strips, 3}}},
        {"ground/cells", {"1", "their corners", false, {Scenery::max_ground, 4}, true}},
        {"scale/points", {"length", "corners of a quadrilateral that shows the scale of the fields", false, {4, 3}}},
        {"scale/cells", {"1", "its corners", false, {1, 4}, true}}};
      for (const FieldName &field : field_names)
      {
        layouts[std::string("body/") + field.name] = {
          field.unit, "values at the points of the body", true, {n_points, 2}};
        layouts[std::string("line/") + field.name] = {field.unit, "values at the points of the line", true, {n_points}};
        layouts[std::string("scale/") + field.name] = {field.unit, "smallest and largest value of the run", false, {4}};
      }
      return layouts;
    }();
    return all;
  }

  SnapshotHdf5::Shape
  SnapshotHdf5::shape(const Layout &layout, const std::size_t n_rows, const std::size_t n)
  {
    Shape shape = layout.shape;
    std::replace(shape.begin(), shape.end(), n_points, static_cast<hsize_t>(n));
    if (layout.has_rows)
      shape.insert(shape.begin(), n_rows);
    return shape;
  }

  void
  SnapshotHdf5::create(const std::filesystem::path &path, const std::size_t n_frames, const std::size_t n)
  {
    H5Eset_auto(H5E_DEFAULT, nullptr, nullptr); // our own message instead of HDF5's stack
    double bytes = 1e5;
    for (const auto &[name, layout] : layouts())
      bytes += 8. * static_cast<double>(product(shape(layout, n_frames, n)));
    hdf5::require_space(path, bytes);
    const Hdf5Handle file(
      hdf5::checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), path, "create"), H5Fclose);
    for (const char *group : {"body", "line", "grip", "ground", "scale"})
      Hdf5Handle(hdf5::checked(H5Gcreate(file, group, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), path, "write"), H5Gclose);
    for (const auto &[name, layout] : layouts())
    {
      const Shape size = shape(layout, n_frames, n);
      const Hdf5Handle space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
      const hid_t type = layout.is_whole ? H5T_STD_I32LE : H5T_IEEE_F64LE;
      const Hdf5Handle dataset(hdf5::create_dataset(file, name, type, space, /*is_filled=*/true, path), H5Dclose);
      hdf5::write_attribute(dataset, "unit", layout.unit, path);
      hdf5::write_attribute(dataset, "description", layout.description, path);
    }
    hdf5::checked(H5Fflush(file, H5F_SCOPE_GLOBAL), path, "write");
  }

  SnapshotHdf5::SnapshotHdf5(const std::filesystem::path &path)
    : path_(path)
    , file_(opened(path))
  {
    for (const auto &[name, layout] : layouts())
      datasets_[name] =
        std::make_unique<Hdf5Handle>(hdf5::checked(H5Dopen(file_, name.c_str(), H5P_DEFAULT), path, "open"), H5Dclose);
  }

  hdf5::Part
  SnapshotHdf5::part(const std::string &name,
                     const std::size_t row,
                     const std::size_t n_rows,
                     const std::size_t n) const
  {
    const Layout &layout = layouts().at(name);
    const Shape count    = shape(layout, n_rows, n);
    Shape start(count.size(), 0);
    if (layout.has_rows)
      start[0] = row;
    return {*datasets_.at(name), start, count};
  }

  void
  SnapshotHdf5::write(const std::string &name,
                      const std::vector<double> &values,
                      const std::size_t row,
                      const std::size_t n_rows,
                      const std::size_t n) const
  {
    part(name, row, n_rows, n).write(H5T_NATIVE_DOUBLE, values.data(), path_);
  }

  std::vector<double>
  SnapshotHdf5::read(const std::string &name,
                     const std::size_t row,
                     const std::size_t n_rows,
                     const std::size_t n) const
  {
    std::vector<double> values(product(shape(layouts().at(name), n_rows, n)));
    part(name, row, n_rows, n).read(H5T_NATIVE_DOUBLE, values.data(), path_);
    return values;
  }

  std::pair<std::size_t, std::size_t>
  SnapshotHdf5::size() const
  {
    const Hdf5Handle space(H5Dget_space(*datasets_.at("line/s")), H5Sclose);
    if (H5Sget_simple_extent_ndims(space) != 2)
      throw FileError("cannot continue \"" + path_.string() + "\": its form differs from what was written");
    hsize_t size[2] = {0, 0};
    H5Sget_simple_extent_dims(space, size, nullptr);
    return {size[0], size[1]};
  }

  std::size_t
  SnapshotHdf5::place(const std::string &name, const std::size_t row) const
  {
    const hid_t dataset = *datasets_.at(name);
    const Hdf5Handle space(H5Dget_space(dataset), H5Sclose), type(H5Dget_type(dataset), H5Tclose);
    Shape size(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, size.data(), nullptr);
    size[0] = row;
    return H5Dget_offset(dataset) + product(size) * H5Tget_size(type);
  }
} // namespace crawler
