// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/crawler_equation.h>
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
                const std::vector<double> &points,
                const Observers &observers,
                const std::function<bool()> &keep_going)
  {
    const Units &units = level.reduced_scene.units;
    std::vector<double> natural;
    for (std::size_t i = 0; i < times.all().size(); ++i)
      natural.push_back(times.natural(i));
    std::vector<double> places; // [length]
    for (const double point : points)
      places.push_back(point * units.length);
    unsigned int number = 0, n_snapshots = 0;
    bool stopped  = false;
    double before = 0.;
    level.replay(natural, points, [&](const double t, const ReducedModel::State &state) {
      const PictureTimes::Time &picture = times.all()[number++];
      const double time                 = picture.value;
      StateNumbers numbers              = state.in_units(units);
      numbers.step                      = {time, time - before, n_snapshots, true, 0, 0};
      if (picture.kinds.is_snapshot)
      {
        ++n_snapshots;
        before = time;
      }
      const StateWithoutMesh shown{numbers,
                                   picture.kinds,
                                   {time,
                                    numbers.step.number,
                                    static_cast<unsigned int>(points.size()),
                                    places,
                                    physical_fields(state.fields, points, level.reduced_scene.scene, units)}};
      for (const auto &observer : observers)
        observer->show(shown);
      stopped = !keep_going();
      return !stopped && t <= 1.;
    });
    for (const auto &observer : observers)
      observer->end();
    return !stopped;
  }
} // namespace crawler
