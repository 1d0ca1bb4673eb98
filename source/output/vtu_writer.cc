// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/output/vtu_writer.h>

#include <deal.II/base/data_out_base.h>

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <sstream>

namespace crawler
{
  namespace
  {
    using NonscalarRange = std::
      tuple<unsigned int, unsigned int, std::string, dealii::DataComponentInterpretation::DataComponentInterpretation>;

    /// Hands our patches to deal.II's writers.
    class PatchOutput : public dealii::DataOutInterface<1, 1>
    {
    public:
      std::vector<dealii::DataOutBase::Patch<1, 1>> patches;

    private:
      const std::vector<dealii::DataOutBase::Patch<1, 1>> &
      get_patches() const override
      {
        return patches;
      }
      std::vector<std::string>
      get_dataset_names() const override
      {
        return {"displacement",
                "displacement",
                "displacement",
                "position",
                "stretch",
                "velocity",
                "active_stress",
                "elastic_stress",
                "friction_force"};
      }
      std::vector<NonscalarRange>
      get_nonscalar_data_ranges() const override
      {
        return {{0, 2, "displacement", dealii::DataComponentInterpretation::component_is_part_of_vector}};
      }
    };

    std::vector<FieldSampler::Point>
    line_points(const Discretization &discretization)
    {
      const unsigned int q = discretization.element().degree;
      std::vector<FieldSampler::Point> points;
      for (unsigned int c = 0; c < discretization.n_local_cells(); ++c)
        for (unsigned int i = 0; i <= q; ++i)
          points.push_back({c, static_cast<double>(i) / q});
      return points;
    }
  } // namespace

  VtuWriter::VtuWriter(const std::filesystem::path &folder)
    : folder_(folder)
  {
  }

  void
  VtuWriter::observe(const Snapshot &snapshot)
  {
    if (!snapshot.pictures.is_snapshot)
      return;
    const Discretization &d = snapshot.assembler.discretization();
    if (!sampler_ || mesh_number_ != snapshot.mesh_number)
      sampler_ = std::make_unique<FieldSampler>(snapshot.assembler, snapshot.units, line_points(d));
    mesh_number_        = snapshot.mesh_number;
    const double length = snapshot.units.length;
    std::vector<Cell> cells(d.n_local_cells());
    for (unsigned int c = 0; c < cells.size(); ++c)
    {
      const double left = d.cell_left()[c] * length;
      cells[c]          = {left, left + d.cell_size()[c] * length};
    }
    write(snapshot.step.time,
          snapshot.step.number,
          cells,
          d.element().n,
          sampler_->sample(snapshot.computed_time, snapshot.y, snapshot.v),
          d.communicator());
  }

  void
  VtuWriter::write(const double time,
                   const unsigned int number,
                   const std::vector<Cell> &cells,
                   const unsigned int n,
                   const Fields &fields,
                   MPI_Comm communicator)
  {
    PatchOutput output;
    output.patches.resize(cells.size());
    for (unsigned int c = 0; c < cells.size(); ++c)
    {
      auto &patch          = output.patches[c];
      patch.vertices[0]    = dealii::Point<1>(cells[c].left);
      patch.vertices[1]    = dealii::Point<1>(cells[c].right);
      patch.patch_index    = c;
      patch.n_subdivisions = n - 1;
      patch.reference_cell = dealii::ReferenceCells::Line;
      patch.data.reinit(9, n);
      for (unsigned int i = 0; i < n; ++i)
      {
        const std::size_t p = static_cast<std::size_t>(c) * n + i;
        patch.data(0, i)    = fields.displacement[p];
        patch.data(1, i)    = 0.;
        patch.data(2, i)    = 0.;
        patch.data(3, i)    = fields.position[p];
        patch.data(4, i)    = fields.stretch[p];
        patch.data(5, i)    = fields.velocity[p];
        patch.data(6, i)    = fields.active_stress[p];
        patch.data(7, i)    = fields.elastic_stress[p];
        patch.data(8, i)    = fields.friction_force[p];
      }
    }
    dealii::DataOutBase::VtkFlags flags;
    flags.time              = time;
    flags.cycle             = number;
    flags.compression_level = dealii::DataOutBase::VtkFlags::best_speed; // the arrays are small
    output.set_flags(flags);

    const std::string name = fmt::format("solution/{:06}.vtu", n_files_++);
    if (size_of(communicator) == 1)
    {
      std::ostringstream text;
      output.write_vtu(text);
      write_file(folder_ / name, text.str());
    }
    else
      output.write_vtu_in_parallel((folder_ / name).string(), communicator);
    if (rank_of(communicator) == 0)
      add_to_record(time, name);
  }

  void
  VtuWriter::add_to_record(const double time, const std::string &name)
  {
    const std::filesystem::path path = folder_ / "solution.pvd";
    std::ostringstream out;
    dealii::DataOutBase::write_pvd_record(out, {{time, name}});
    const std::string text = out.str();
    const auto entry = text.find("    <DataSet"), end = text.find("  </Collection>");
    if (n_files_ == 1)
    {
      write_file(path, text);
      record_.open(path, std::ios::binary | std::ios::in | std::ios::out); // "in" keeps what is there
      record_end_ = static_cast<std::streamoff>(entry);
    }
    // One small write() takes the place of the end. To replace the file each time is quadratic, and ext4 waits for the
    // disk whenever a file replaces another one.
    record_.seekp(record_end_);
    record_ << text.substr(entry) << std::flush;
    if (!record_)
      throw FileError("cannot write \"" + path.string() + "\": " + std::strerror(errno));
    record_end_ += static_cast<std::streamoff>(end - entry);
  }
} // namespace crawler
