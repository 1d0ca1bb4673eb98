// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/files.h>
#include <crawler/output/kymograph_writer.h>

#include <deal.II/base/utilities.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <iterator>

namespace crawler
{
  namespace
  {
    constexpr unsigned int n_points = Kymograph::n_points;
    constexpr unsigned int n_fields = 5;

    /// As VTK's XML files have it: the number of bytes and the values, in base 64.
    std::string
    encoded(const std::vector<double> &values)
    {
      const std::uint64_t size = values.size() * sizeof(double);
      std::vector<unsigned char> bytes(sizeof(size) + size);
      std::memcpy(bytes.data(), &size, sizeof(size));
      std::memcpy(bytes.data() + sizeof(size), values.data(), size);
      return dealii::Utilities::encode_base64(bytes);
    }

    /// In the order of the names.
    std::array<const std::vector<double> *, n_fields>
    written(const Fields &fields)
    {
      return {{&fields.stretch, &fields.velocity, &fields.active_stress, &fields.friction_force, &fields.displacement}};
    }

    /// Those of the equidistant points that lie in this rank's cells.
    std::vector<FieldSampler::Point>
    own_points(const Discretization &discretization)
    {
      std::vector<FieldSampler::Point> points;
      const auto &left = discretization.cell_left();
      if (left.empty())
        return points;
      const double end = left.back() + discretization.cell_size().back();
      for (unsigned int i = 0; i < n_points; ++i)
      {
        const double s  = discretization.length() * i / (n_points - 1);
        const bool last = !discretization.has_right_neighbour();
        if (s < left.front() || (last ? i + 1 < n_points && s > end : s >= end))
          continue;
        const auto cell = static_cast<unsigned int>(
          std::max<std::ptrdiff_t>(0, std::upper_bound(left.begin(), left.end(), s) - left.begin() - 1));
        points.push_back({cell, std::clamp((s - left[cell]) / discretization.cell_size()[cell], 0., 1.)});
      }
      return points;
    }
  } // namespace

  KymographWriter::KymographWriter(const double end_time, const std::filesystem::path &folder)
    : end_time_(end_time)
    , folder_(folder)
  {
  }

  const std::vector<std::string> &
  Kymograph::field_names()
  {
    static const std::vector<std::string> names = {
      "stretch", "velocity", "active_stress", "friction_force", "displacement"};
    return names;
  }

  void
  Kymograph::observe(const Snapshot &snapshot)
  {
    if (!snapshot.pictures.is_row)
      return;
    const Discretization &d = snapshot.assembler.discretization();
    if (!sampler_ || mesh_number_ != snapshot.mesh_number)
      sampler_ = std::make_unique<FieldSampler>(snapshot.assembler, snapshot.units, own_points(d));
    mesh_number_         = snapshot.mesh_number;
    const Fields &fields = sampler_->sample(snapshot.computed_time, snapshot.y, snapshot.v);
    const int own        = static_cast<int>(fields.stretch.size());
    const auto n_ranks   = d.n_ranks();
    std::vector<int> counts(n_ranks), offsets(n_ranks, 0);
    MPI_Allgather(&own, 1, MPI_INT, counts.data(), 1, MPI_INT, d.communicator());
    for (unsigned int r = 1; r < n_ranks; ++r)
      offsets[r] = offsets[r - 1] + counts[r - 1];
    times_.push_back(snapshot.step.time);
    for (const auto *field : written(fields))
    {
      std::vector<double> all(d.rank() == 0 ? n_points : 0); // so rows_ stays empty on the others
      MPI_Gatherv(
        field->data(), own, MPI_DOUBLE, all.data(), counts.data(), offsets.data(), MPI_DOUBLE, 0, d.communicator());
      rows_.insert(rows_.end(), all.begin(), all.end());
    }
  }

  void
  Kymograph::add(const double time, const Fields &fields)
  {
    times_.push_back(time);
    for (const auto *field : written(fields))
      rows_.insert(rows_.end(), field->begin(), field->end());
  }

  void
  KymographWriter::end()
  {
    if (rows().empty() || times().size() < 2)
      return;
    const std::size_t n_times = times().size();
    std::string text          = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"StructuredGrid\" version=\"1.0\" "
               "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<StructuredGrid WholeExtent=\"0 {0} 0 {1} 0 0\">\n"
               "<Piece Extent=\"0 {0} 0 {1} 0 0\">\n<PointData Scalars=\"stretch\">\n",
      n_points - 1,
      n_times - 1);
    std::vector<double> values;
    const auto add_array = [&](const std::string &attributes) {
      text += fmt::format("<DataArray type=\"Float64\" {} format=\"binary\">", attributes) + encoded(values) +
              "</DataArray>\n";
      values.clear();
    };
    for (unsigned int f = 0; f < n_fields; ++f)
    {
      for (std::size_t j = 0; j < n_times; ++j)
      {
        const auto row = rows().begin() + static_cast<std::ptrdiff_t>((j * n_fields + f) * n_points);
        values.insert(values.end(), row, row + n_points);
      }
      add_array(fmt::format("Name=\"{}\"", field_names()[f]));
    }
    text += "</PointData>\n<Points>\n";
    for (const double time : times())
      for (unsigned int i = 0; i < n_points; ++i)
        values.insert(values.end(), {static_cast<double>(i) / (n_points - 1), time / end_time_, 0.});
    add_array("NumberOfComponents=\"3\"");
    text += "</Points>\n</Piece>\n</StructuredGrid>\n</VTKFile>\n";
    write_file(folder_ / "kymograph.vts", text);
  }
} // namespace crawler
