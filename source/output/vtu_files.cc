// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/files.h>
#include <crawler/base/growing_text.h>
#include <crawler/output/snapshot_writer.h>
#include <crawler/output/vtk_xml.h>

#include <fmt/format.h>

#include <numeric>

namespace crawler
{
  namespace
  {
    /// Cell types as numbered by VTK.
    enum class CellType : std::uint8_t
    {
      line          = 3,
      triangle      = 5,
      quadrilateral = 9
    };

    using Indices = std::vector<std::int32_t>;

    /// A file with cells of one type, from the text of its field and point data, its points and the points of the
    /// cells.
    std::string
    vtu_file(const CellType type,
             const std::string &field_data,
             const std::string &point_data,
             const std::vector<double> &points,
             const Indices &connectivity)
    {
      const unsigned int n_corners = type == CellType::line ? 2 : type == CellType::triangle ? 3 : 4;
      const std::size_t n_cells    = connectivity.size() / n_corners;
      Indices offsets(n_cells);
      for (std::size_t c = 0; c < n_cells; ++c)
        offsets[c] = static_cast<std::int32_t>(c + 1) * static_cast<std::int32_t>(n_corners);
      return vtk_file(
        "UnstructuredGrid",
        fmt::format(">\n<FieldData>\n{}</FieldData>\n<Piece NumberOfPoints=\"{}\" "
                    "NumberOfCells=\"{}\">\n<PointData{}</PointData>\n<Points>\n{}</Points>\n<Cells>\n"
                    "{}{}{}</Cells>\n</Piece>\n",
                    field_data,
                    points.size() / 3,
                    n_cells,
                    point_data,
                    vtk_array("Points", points, 3, "length"),
                    vtk_array("connectivity", connectivity),
                    vtk_array("offsets", offsets),
                    vtk_array("types", std::vector<std::uint8_t>(n_cells, static_cast<std::uint8_t>(type)))));
    }

    /// Cells that share no points.
    Indices
    in_order(const std::vector<double> &points)
    {
      Indices indices(points.size() / 3);
      std::iota(indices.begin(), indices.end(), 0);
      return indices;
    }

    /// Vectors along x.
    std::vector<double>
    along_x(const std::vector<double> &values, const double factor)
    {
      std::vector<double> vectors(3 * values.size(), 0.);
      for (std::size_t i = 0; i < values.size(); ++i)
        vectors[3 * i] = factor * values[i];
      return vectors;
    }

    std::string
    field_data_of(const Frame &frame)
    {
      return vtk_array("TimeValue", std::vector<double>{frame.time}) +
             vtk_array("CYCLE", Indices{static_cast<std::int32_t>(frame.step)}) + vtk_text("units", units_of_fields());
    }

    std::string
    body_file(const Frame &frame, const double length)
    {
      const auto n        = static_cast<std::int32_t>(frame.s.size()),
                 per_cell = static_cast<std::int32_t>(frame.points_per_cell);
      Indices cells;
      for (std::int32_t i = 0; i + 1 < n; ++i)
        if ((i + 1) % per_cell != 0)
          cells.insert(cells.end(), {2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
      std::string fields = " Scalars=\"stretch\" Vectors=\"ground_force\">\n";
      for (const FieldName &field : field_names)
        fields += vtk_array(field.name, on_both_edges(frame.fields.*field.values), 1, field.unit);
      fields += vtk_array("s", on_both_edges(frame.s), 1, "length");
      fields += vtk_array("ground_force", along_x(on_both_edges(frame.fields.friction_force), -1.), 3, "force/length");
      return vtu_file(CellType::quadrilateral, field_data_of(frame), fields, ribbon(frame, length), cells);
    }

    std::string
    line_file(const Frame &frame)
    {
      const auto n        = static_cast<std::int32_t>(frame.s.size()),
                 per_cell = static_cast<std::int32_t>(frame.points_per_cell);
      Indices cells;
      for (std::int32_t i = 0; i + 1 < n; ++i)
        if ((i + 1) % per_cell != 0)
          cells.insert(cells.end(), {i, i + 1});
      std::string fields = " Scalars=\"stretch\" Vectors=\"displacement\">\n";
      for (const FieldName &field : field_names)
        fields += field.values == &Fields::displacement
                    ? vtk_array(field.name, along_x(frame.fields.displacement, 1.), 3, field.unit)
                    : vtk_array(field.name, frame.fields.*field.values, 1, field.unit);
      return vtu_file(CellType::line, field_data_of(frame), fields, along_x(frame.s, 1.), cells);
    }

    std::string
    grip_file(const Frame &frame, const Scenery &scenery)
    {
      const Arrows arrows = scenery.arrows(frame);
      return vtu_file(CellType::triangle,
                      "",
                      ">\n" + vtk_array("friction_force", arrows.friction_force, 1, "force/length"),
                      arrows.points,
                      in_order(arrows.points));
    }

    constexpr const char *list_begin = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
                                       "byte_order=\"LittleEndian\">\n  <Collection>\n",
                         *list_end   = "  </Collection>\n</VTKFile>\n";

    /// Line of a file in the list.
    std::string
    entry(const double time, const unsigned int part, const std::string &name, const std::string &file)
    {
      return fmt::format(
        "    <DataSet timestep=\"{}\" part=\"{}\" name=\"{}\" file=\"solution/{}.vtu\"/>\n", time, part, name, file);
    }
    class VtuFiles : public SnapshotWriter
    {
    public:
      VtuFiles(const std::filesystem::path &folder, const double length)
        : SnapshotWriter(length)
        , folder_(folder)
        , body_(folder / "solution.pvd", list_begin, list_end)
        , line_(folder / "line.pvd", list_begin, list_end)
      {
      }

      void
      exchange(Archive &archive) override
      {
        SnapshotWriter::exchange(archive);
        archive(n_frames_, body_, line_);
      }

    private:
      void
      add(const Frame &frame, const bool scenery_changed) override
      {
        const std::filesystem::path files = folder_ / "solution";
        const std::string number          = fmt::format("{:06}", n_frames_++);
        if (scenery_changed)
          write_scenery();
        write_file(files / (number + ".vtu"), body_file(frame, length_));
        write_file(files / ("grip_" + number + ".vtu"), grip_file(frame, scenery_));
        write_file(files / ("line_" + number + ".vtu"), line_file(frame));
        body_.add(entry(frame.time, 0, "body", number) + entry(frame.time, 1, "grip", "grip_" + number) +
                  entry(frame.time, 2, "ground", "ground") + entry(frame.time, 3, "scale", "scale"));
        line_.add(entry(frame.time, 0, "line", "line_" + number));
      }

      void
      end_files() override
      {
        if (n_frames_ > 0)
          write_scenery();
      }

      void
      write_scenery() const
      {
        const Corners ground = scenery_.ground(), scale = scenery_.scale();
        write_file(folder_ / "solution" / "ground.vtu",
                   vtu_file(CellType::quadrilateral,
                            vtk_array("tick_distance", std::vector<double>{scenery_.tick_distance()}, 1, "length"),
                            ">\n",
                            ground,
                            in_order(ground)));
        std::string fields = " Scalars=\"stretch\">\n";
        for (std::size_t f = 0; f < scenery_.ranges().size(); ++f)
        {
          const auto [smallest, largest] = scenery_.ranges()[f];
          fields += vtk_array(
            field_names[f].name, std::vector<double>{smallest, largest, largest, smallest}, 1, field_names[f].unit);
        }
        write_file(folder_ / "solution" / "scale.vtu",
                   vtu_file(CellType::quadrilateral, "", fields, scale, in_order(scale)));
      }

      const std::filesystem::path folder_;
      unsigned int n_frames_ = 0;
      GrowingText body_, line_; ///< the lists of files
    };
  } // namespace

  std::shared_ptr<SnapshotWriter>
  vtu_files(const std::filesystem::path &folder, const double length)
  {
    return std::make_shared<VtuFiles>(folder, length);
  }
} // namespace crawler
