// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/crawler_equation.h>
#include <crawler/output/kymograph_writer.h>
#include <crawler/output/snapshot_writer.h>
#include <crawler/output/statistics_writer.h>
#include <crawler/run/reduced_model.h>
#include <crawler/studies/run/reduced_pictures.h>

namespace crawler
{
  namespace
  {
    /// Fields of a state in the user's units, at @p points in natural ones.
    Fields
    physical_fields(const ReducedFields &state,
                    const std::vector<double> &points,
                    const Scene &scene,
                    const Units &units)
    {
      const std::size_t n = points.size();
      Fields fields;
      fields.active_stress = state.active_stress;
      fields.velocity      = state.velocity;
      fields.friction_force.resize(n);
      for (std::size_t i = 0; i < n; ++i)
      {
        fields.displacement.push_back(state.displacement[i] * units.length);
        fields.position.push_back(points[i] * units.length + fields.displacement[i]);
        fields.stretch.push_back(1. + state.strain[i]);
        fields.elastic_stress.push_back(units.force *
                                        equation::body_force(state.strain[i], 0., scene.body.elastic_modulus));
        fields.active_stress[i] *= units.force;
        fields.velocity[i] *= units.velocity();
      }
      scene.friction->values(fields.stretch, fields.friction_force);
      for (std::size_t i = 0; i < n; ++i)
        fields.friction_force[i] =
          equation::friction_force(fields.friction_force[i], state.velocity[i]) * units.force / units.length;
      return fields;
    }

  } // namespace

  PictureTimes
  times_without_mesh(const Input &input)
  {
    OutputParameters wanted = input.parameters.output;
    if (!wanted.has_snapshots())
    {
      wanted.n_snapshots.reset();
      wanted.kymograph = false;
    }
    return picture_times(wanted, input.scene);
  }

  bool
  show_pictures(const ReducedModel &level,
                const PictureTimes &times,
                const PictureViewers &viewers,
                const std::function<bool()> &keep_going)
  {
    const Units &units = level.reduced_scene().units();
    const auto points  = viewers.kymograph != nullptr ? viewers.kymograph->points() : Kymograph::equidistant();
    std::vector<double> natural;
    for (std::size_t i = 0; i < times.all().size(); ++i)
      natural.push_back(times.natural(i));
    std::vector<double> places; // [length]
    for (const double point : points)
      places.push_back(point * units.length);
    unsigned int number = 0, n_rows = 0;
    bool stopped  = false;
    double before = 0.;
    level.replay(natural, points, [&](const double t, const ReducedModel::State &state) {
      const PictureTimes::Time &picture = times.all()[number++];
      const double time                 = picture.value;
      const Fields fields               = physical_fields(state.fields, points, level.reduced_scene().scene(), units);
      if (picture.kinds.is_row && viewers.kymograph != nullptr)
        viewers.kymograph->add(time, fields);
      stopped = !keep_going();
      if (!picture.kinds.is_snapshot)
        return !stopped && t <= 1.;
      const Step step{time, time - before, n_rows++, true, 0, 0};
      before = time;
      if (viewers.snapshots)
        viewers.snapshots({time, step.number, static_cast<unsigned int>(points.size()), places, fields});
      const auto stretch_at = [&](const StrainExtreme &e) { return StretchAt{1. + e.strain, e.s * units.length}; };
      if (viewers.statistics != nullptr)
        viewers.statistics->write({step,
                                   state.displacement * units.length,
                                   {stretch_at(state.smallest), stretch_at(state.largest)},
                                   state.velocity * units.velocity(),
                                   state.energies.scaled(units.energy()),
                                   state.net_friction * units.force});
      return !stopped && t <= 1.;
    });
    return !stopped;
  }

  bool
  write_pictures(const ReducedModel &level,
                 const Input &input,
                 const std::filesystem::path &folder,
                 const std::function<bool()> &keep_going)
  {
    const OutputParameters &output = input.parameters.output;
    const double length            = input.scene.body.length;
    const PictureTimes times       = times_without_mesh(input);
    std::optional<SnapshotWriter> snapshots;
    if (output.has_snapshots())
      snapshots.emplace(output.snapshot_format, folder, length, times.n_snapshots() + 1);
    KymographWriter kymograph(length, input.scene.end_time, input.scene.ground.profile, folder);
    std::optional<StatisticsWriter> statistics;
    if (output.statistics)
      statistics.emplace(length, true, folder, output.energy_balance, input.parameters.units);
    const bool whole = show_pictures(
      level,
      times,
      {snapshots ? [&](const Frame &frame) { snapshots->write(frame); } : std::function<void(const Frame &)>(),
       output.has_snapshots() ? &kymograph : nullptr,
       statistics ? &*statistics : nullptr},
      keep_going);
    if (statistics)
      statistics->end();
    if (snapshots)
      snapshots->end();
    if (output.has_snapshots() && output.kymograph)
      kymograph.end();
    return whole;
  }
} // namespace crawler
