// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/output/snapshot_writer.h>

namespace crawler
{
  namespace
  {
    std::vector<CellPlace>
    line_points(const Discretization &discretization)
    {
      const unsigned int q = discretization.element.degree;
      std::vector<CellPlace> points;
      for (unsigned int c = 0; c < discretization.n_local_cells(); ++c)
        for (unsigned int i = 0; i <= q; ++i)
          points.push_back({c, static_cast<double>(i) / q});
      return points;
    }
  } // namespace

  std::string
  animation_file(const SnapshotFormat format)
  {
    return format == SnapshotFormat::xdmf ? "solution.xdmf" : "solution.pvd";
  }

  SnapshotWriter::SnapshotWriter(const double length)
    : length_(length)
    , scenery_(length)
    , sampler_(line_points)
  {
  }

  void
  SnapshotWriter::observe(const Snapshot &snapshot)
  {
    if (!snapshot.pictures.is_snapshot)
      return;
    const Discretization &d = snapshot.assembler.discretization;
    communicator_           = d.communicator;
    const Fields &own       = sampler_.sample(snapshot);
    Frame frame{
      snapshot.step.time, snapshot.step.number, d.element.n, gather(sampler_.coordinates(), communicator_), {}};
    for (const FieldName &field : field_names)
      frame.fields.*field.values = gather(own.*field.values, communicator_);
    on_first_rank(communicator_, [&]() { write(frame); });
  }

  void
  SnapshotWriter::end()
  {
    on_first_rank(communicator_, [&]() {
      scenery_.finish();
      end_files();
    });
  }
} // namespace crawler
