// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/grid_samples.h>
#include <crawler/output/kymograph_writer.h>
#include <crawler/output/vtk_xml.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  std::vector<double>
  Kymograph::equidistant()
  {
    return equal_parts(0., 1., n_points - 1);
  }

  Kymograph::Kymograph(std::vector<double> points)
    : points(std::move(points))
    , sampler_([points = this->points](const Discretization &mesh) {
      std::vector<double> s = points;
      for (double &point : s)
        point *= mesh.length;
      return mesh.own_places(s);
    })
  {
  }

  KymographWriter::KymographWriter(const double length,
                                   const double end_time,
                                   std::shared_ptr<const Profile> ground,
                                   const std::filesystem::path &folder)
    : length_(length)
    , end_time_(end_time)
    , ground_(std::move(ground))
    , folder_(folder)
  {
  }

  void
  Kymograph::observe(const Snapshot &snapshot)
  {
    if (!snapshot.pictures.is_row)
      return;
    const Fields &own = sampler_.sample(snapshot);
    Fields all; // empty except on rank 0
    for (const FieldName &field : field_names)
      if (field.in_kymograph)
        all.*field.values = gather(own.*field.values, snapshot.assembler.discretization.communicator);
    add(snapshot.step.time, all);
  }

  void
  Kymograph::exchange(Archive &archive)
  {
    archive(times_);
    for (const FieldName &field : field_names)
      archive(rows_.*field.values);
  }

  void
  Kymograph::add(const double time, const Fields &fields)
  {
    times_.push_back(time);
    for (const FieldName &field : field_names)
      if (field.in_kymograph)
      {
        const std::vector<double> &row = fields.*field.values;
        (rows_.*field.values).insert((rows_.*field.values).end(), row.begin(), row.end());
      }
  }

  FieldRange
  Kymograph::shown(const FieldName &field) const
  {
    const std::vector<double> &values = rows_.*field.values;
    FieldRange all                    = {HUGE_VAL, -HUGE_VAL};
    for (const double value : values)
      if (std::isfinite(value))
        all = {std::min(all.first, value), std::max(all.second, value)};
    if (all.first > all.second)
      all = {0., 0.};
    if (!field.has_peaks)
      return all;
    UsualSize size;
    for (std::size_t i = 0; i < times_.size(); ++i)
      size.add(times_[i], std::span(values).subspan(i * points.size(), points.size()));
    return size.within(all);
  }

  std::string
  KymographWriter::ground_arrays() const
  {
    constexpr unsigned int n_places = 400;
    constexpr double margin         = 0.3; // on both sides, relative to the length
    if (!ground_)
      return "";
    const auto [low, high] = std::minmax_element(rows().displacement.begin(), rows().displacement.end());
    std::vector<double> places;
    for (unsigned int i = 0; i < n_places; ++i)
      places.push_back(std::lerp(*low - margin * length_, *high + (1. + margin) * length_, i / (n_places - 1.)));
    return vtk_array("ground_x", places, 1, "length") + vtk_array("ground_factor", profile_at(ground_, places), 1, "1");
  }

  void
  KymographWriter::end()
  {
    if (rows().stretch.empty() || times().size() < 2)
      return;
    const std::size_t n_times = times().size();
    std::string fields, shown_ranges;
    for (const FieldName &field : field_names)
      if (field.in_kymograph)
      {
        const auto [low, high] = shown(field);
        fields += vtk_array(field.name, rows().*field.values, 1, field.unit);
        shown_ranges += vtk_array(std::string("shown_") + field.name, std::vector<double>{low, high}, 1, field.unit);
      }
    std::vector<double> points;
    for (const double time : times())
      for (const double point : Kymograph::points)
        points.insert(points.end(), {point, time / end_time_, 0.});
    const std::string text = vtk_file(
      "StructuredGrid",
      fmt::format(" WholeExtent=\"0 {0} 0 {1} 0 0\">\n<FieldData>\n{2}</FieldData>\n<Piece Extent=\"0 {0} 0 {1} "
                  "0 0\">\n<PointData Scalars=\"stretch\">\n{3}</PointData>\n<Points>\n{4}</Points>\n</Piece>\n",
                  n_points - 1,
                  n_times - 1,
                  vtk_text("AxisTitleForX", "s/L") + vtk_text("AxisTitleForY", "t/T") +
                    vtk_array("L", std::vector<double>{length_}, 1, "length") +
                    vtk_array("T", std::vector<double>{end_time_}, 1, "time") + vtk_text("units", units_of_fields()) +
                    shown_ranges + ground_arrays(),
                  fields,
                  vtk_array("Points", points, 3)));
    write_file(folder_ / "kymograph.vts", text);
  }
} // namespace crawler
