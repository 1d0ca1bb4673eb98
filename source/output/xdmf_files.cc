// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/growing_text.h>
#include <crawler/output/snapshot_hdf5.h>
#include <crawler/output/snapshot_writer.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace crawler
{
  namespace
  {
    const std::string body = "body/", line = "line/", grip = "grip/", ground = "ground/", scale = "scale/";

    std::vector<double>
    numbers_to(const std::size_t n)
    {
      std::vector<double> numbers(n);
      std::iota(numbers.begin(), numbers.end(), 0.);
      return numbers;
    }

    /// A text of numbers for XDMF.
    std::string
    words(const SnapshotHdf5::Shape &numbers)
    {
      return fmt::format("{}", fmt::join(numbers, " "));
    }

    std::vector<std::string>
    all_fields()
    {
      std::vector<std::string> names;
      for (const FieldName &field : field_names)
        names.emplace_back(field.name);
      return names;
    }

    constexpr const char *description_begin =
                           "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n<Domain>\n"
                           "<Grid Name=\"crawler\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
                         *description_end = "</Grid>\n</Domain>\n</Xdmf>\n";
    /// The datasets have a row for each frame and as many columns as the largest mesh has points; unused ones are NaN,
    /// and n_points is the number of used ones. When frames or points exceed the capacity, a larger file replaces it.
    class XdmfFiles : public SnapshotWriter
    {
    public:
      XdmfFiles(const std::filesystem::path &folder, const double length, const std::size_t n_frames)
        : SnapshotWriter(length)
        , path_(folder / "solution.h5")
        , expected_(n_frames)
        , max_frames_(std::min<std::size_t>(n_frames, 4096)) // grows if there are more
        , body_(folder / "solution.xdmf", description_begin, description_end)
        , line_(folder / "line.xdmf", description_begin, description_end)
      {
      }

      void
      exchange(Archive &archive) override
      {
        SnapshotWriter::exchange(archive);
        archive(frames_);
        if (!archive.reads() || frames_.empty())
          return;
        file_                              = std::make_unique<SnapshotHdf5>(path_);
        std::tie(max_frames_, max_points_) = file_->size();
        if (max_frames_ < frames_.size())
          throw FileError("cannot continue \"" + path_.string() + "\": it has fewer frames than were written");
        rewrite_descriptions(); // positions of the frames in the file may have changed
      }

    private:
      void
      add(const Frame &frame, const bool scenery_changed) override
      {
        const std::size_t row = frames_.size(), n = frame.s.size();
        const bool grows = !file_ || row == max_frames_ || n > max_points_;
        if (grows)
          resize(row == max_frames_ ? std::max(row + 1, std::min(2 * row, expected_)) : max_frames_,
                 !file_            ? n
                 : n > max_points_ ? n + n / 2
                                   : max_points_);
        if (scenery_changed || grows)
          write_scenery();
        const auto write = [&](const std::string &name, const std::vector<double> &values) {
          file_->write(name, values, row, 1, n);
        };
        write(body + "points", ribbon(frame, length_));
        write(body + "s", on_both_edges(frame.s));
        write(line + "s", frame.s);
        for (const FieldName &field : field_names)
        {
          write(body + field.name, on_both_edges(frame.fields.*field.values));
          write(line + field.name, frame.fields.*field.values);
        }
        std::vector<double> line_points(3 * n, 0.);
        for (std::size_t i = 0; i < n; ++i)
          line_points[3 * i] = frame.s[i];
        write(line + "points", line_points);
        const Arrows arrows = scenery_.arrows(frame);
        write(grip + "points", arrows.points);
        write(grip + "friction_force", arrows.friction_force);
        write("step", {static_cast<double>(frame.step)});
        write("n_points", {static_cast<double>(n)});
        write("time", {frame.time}); // last: a frame with its time is complete
        frames_.push_back({frame.time, n});
        if (grows)
          rewrite_descriptions();
        else
        {
          body_.add(body_grid(row));
          line_.add(line_grid(row));
        }
      }

      void
      end_files() override
      {
        if (frames_.empty())
          return;
        std::size_t largest = 0;
        for (const FrameSize &frame : frames_)
          largest = std::max(largest, frame.n_points);
        if (frames_.size() != max_frames_ || largest != max_points_)
          resize(frames_.size(), largest);
        write_scenery();
        rewrite_descriptions();
        file_.reset();
      }

      /// Makes a file of the new size with all frames so far.
      void
      resize(const std::size_t n_frames, const std::size_t n)
      {
        const std::filesystem::path part = temporary_file(path_);
        const std::size_t common         = std::min(n, max_points_);
        try
        {
          SnapshotHdf5::create(part, n_frames, n);
          const SnapshotHdf5 larger(part);
          constexpr std::size_t together = 64;
          for (std::size_t row = 0; row < frames_.size(); row += together)
            for (const auto &[name, layout] : SnapshotHdf5::layouts())
              if (layout.has_rows)
              {
                const std::size_t n_rows = std::min(together, frames_.size() - row);
                larger.write(name, file_->read(name, row, n_rows, common), row, n_rows, common);
              }
          const std::size_t strips = Scenery::max_ground;
          larger.write(line + "cells", numbers_to(n), 0, 1, n);
          larger.write(grip + "cells", numbers_to(3 * n_arrows));
          larger.write(ground + "cells", numbers_to(4 * strips));
          larger.write(scale + "cells", numbers_to(4));
        }
        catch (...)
        {
          std::error_code ignored;
          std::filesystem::remove(part, ignored);
          throw;
        }
        file_.reset();
        rename_whole(part, path_);
        file_       = std::make_unique<SnapshotHdf5>(path_);
        max_frames_ = n_frames;
        max_points_ = n;
      }

      void
      write_scenery() const
      {
        Corners corners = scenery_.ground();
        const Corners last(corners.end() - 3, corners.end());
        while (corners.size() < 12 * Scenery::max_ground) // the remaining quadrilaterals have no area
          corners.insert(corners.end(), last.begin(), last.end());
        file_->write(ground + "points", corners);
        file_->write(scale + "points", scenery_.scale());
        for (std::size_t f = 0; f < scenery_.ranges().size(); ++f)
        {
          const auto [smallest, largest] = scenery_.ranges()[f];
          file_->write(scale + field_names[f].name, {smallest, largest, largest, smallest});
        }
      }

      /// Describes a dataset, or its part for the frame @p row. The part is given by its offset in the file, as binary
      /// numbers: only one of ParaView's three readers knows parts of HDF5 datasets.
      std::string
      item(const std::size_t row, const std::string &name) const
      {
        const SnapshotHdf5::Layout &layout = SnapshotHdf5::layouts().at(name);
        auto shape                         = SnapshotHdf5::shape(layout, 1, frames_[row].n_points);
        const char *type =
          layout.is_whole ? "NumberType=\"Int\" Precision=\"4\"" : "NumberType=\"Float\" Precision=\"8\"";
        if (!layout.has_rows && name != line + "cells")
          return fmt::format(
            "<DataItem Format=\"HDF\" {} Dimensions=\"{}\">solution.h5:/{}</DataItem>\n", type, words(shape), name);
        if (layout.has_rows)
          shape.erase(shape.begin());
        return fmt::format("<DataItem Format=\"Binary\" Endian=\"Little\" Seek=\"{}\" {} Dimensions=\"{}\"><!-- {} "
                           "-->solution.h5</DataItem>\n",
                           file_->place(name, layout.has_rows ? row : 0),
                           type,
                           words(shape),
                           row); // ParaView's XDMF Reader reuses the points of another frame if the texts begin alike
      }

      std::string
      points(const std::size_t row, const std::string &group) const
      {
        return "<Geometry GeometryType=\"XYZ\">\n" + item(row, group + "points") + "</Geometry>\n";
      }

      std::string
      field(const std::size_t row, const std::string &dataset, const std::string &name) const
      {
        return fmt::format("<Attribute Name=\"{}\" AttributeType=\"Scalar\" Center=\"Node\">\n{}</Attribute>\n",
                           name,
                           item(row, dataset));
      }

      /// Grid whose cells are listed in the dataset "cells" of the group.
      std::string
      cells(const std::size_t row,
            const std::string &group,
            const char *type,
            const std::vector<std::string> &fields) const
      {
        const auto shape = SnapshotHdf5::layouts().at(group + "cells").shape;
        std::string text = fmt::format("<Grid Name=\"{}\">\n<Topology TopologyType=\"{}\" NumberOfElements=\"{}\">\n",
                                       group.substr(0, group.size() - 1),
                                       type,
                                       shape[0]) +
                           item(row, group + "cells") + "</Topology>\n" + points(row, group);
        for (const std::string &name : fields)
          text += field(row, group + name, name);
        return text + "</Grid>\n";
      }

      /// Frame @p row as a grid of XDMF.
      std::string
      body_grid(const std::size_t row) const
      {
        const auto [time, n] = frames_[row];
        std::string text     = fmt::format("<Grid Name=\"frame\" GridType=\"Collection\" CollectionType=\"Spatial\">\n"
                                           "<Time Value=\"{}\"/>\n<Grid Name=\"body\">\n<Topology TopologyType=\"2DSMesh\" "
                                           "Dimensions=\"{} 2\"/>\n",
                                       time,
                                       n) +
                           points(row, body);
        for (const std::string &name : all_fields())
          text += field(row, body + name, name);
        text += field(row, body + "s", "s") + "</Grid>\n";
        return text + cells(row, grip, "Triangle", {"friction_force"}) + cells(row, ground, "Quadrilateral", {}) +
               cells(row, scale, "Quadrilateral", all_fields()) + "</Grid>\n";
      }

      std::string
      line_grid(const std::size_t row) const
      {
        const auto [time, n] = frames_[row];
        std::string text =
          fmt::format("<Grid Name=\"line\">\n<Time Value=\"{}\"/>\n<Topology TopologyType=\"Polyline\" "
                      "NumberOfElements=\"1\" NodesPerElement=\"{}\">\n",
                      time,
                      n) +
          item(row, line + "cells") + "</Topology>\n" + points(row, line);
        for (const std::string &name : all_fields())
          text += field(row, line + name, name);
        return text + "</Grid>\n";
      }

      void
      rewrite_descriptions()
      {
        std::string body_text, line_text;
        for (std::size_t row = 0; row < frames_.size(); ++row)
        {
          body_text += body_grid(row);
          line_text += line_grid(row);
        }
        body_.restart(body_text);
        line_.restart(line_text);
      }

      struct FrameSize
      {
        double time;
        std::size_t n_points;
      };

      const std::filesystem::path path_;        ///< of the HDF5 file
      const std::size_t expected_;              ///< frames
      std::size_t max_frames_, max_points_ = 0; ///< capacity of the file
      std::unique_ptr<SnapshotHdf5> file_;
      std::vector<FrameSize> frames_;
      GrowingText body_, line_; ///< the descriptions
    };
  } // namespace

  std::shared_ptr<SnapshotWriter>
  xdmf_files(const std::filesystem::path &folder, const double length, const std::size_t n_frames)
  {
    return std::make_shared<XdmfFiles>(folder, length, n_frames);
  }
} // namespace crawler
