// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/equation/crawler_equation.h>
#include <crawler/output/field_sampler.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Throws NonfiniteStress on all ranks if a value of any rank is not finite.
    void
    require_finite(const std::vector<double> &m, const double t, const Discretization &discretization)
    {
      const bool is_bad = !std::ranges::all_of(m, [](const double value) { return std::isfinite(value); });
      if (is_true_anywhere(is_bad, discretization.communicator))
        throw NonfiniteStress(fmt::format("the active stress at t = {:.9g} is not a finite number everywhere", t));
    }
  } // namespace

  FieldSampler::FieldSampler(Places places)
    : places_(std::move(places))
  {
  }

  void
  FieldSampler::begin_mesh(const Snapshot &snapshot)
  {
    const Assembler &assembler      = snapshot.assembler;
    const ReferenceElement &element = assembler.discretization.element;
    mesh_number_                    = snapshot.mesh_number;
    points_                         = places_(assembler.discretization);
    coordinates_                    = assembler.discretization.points_of(points_);
    values_                         = interpolation_matrix(element.nodes, in_cells(points_));
    derivatives_                    = interpolation_matrix(element.nodes, in_cells(points_), /*derivative=*/true);
    if (assembler.scene.is_plain())
      stress_ = assembler.scene.active_stress->at(coordinates_);
    else
      general_ = std::make_unique<GeneralSampler>(assembler, points_);
    for (double &s : coordinates_)
      s *= snapshot.units.length;
    for (const FieldName &field : field_names)
      (fields_.*field.values).resize(points_.size());
  }

  const Fields &
  FieldSampler::sample(const Snapshot &snapshot)
  {
    if (mesh_number_ != snapshot.mesh_number)
      begin_mesh(snapshot);
    const Assembler &assembler         = snapshot.assembler;
    const Units &units                 = snapshot.units;
    const Discretization &d            = assembler.discretization;
    const auto u_local                 = d.to_local(assembler.displacement(snapshot.y), u_local_);
    const auto v_local                 = d.to_local(snapshot.v, v_local_);
    const std::vector<double> slopes   = assembler.stretch_slopes(snapshot.y);
    const std::vector<double> friction = assembler.node_friction(snapshot.computed_time, snapshot.y, snapshot.v);
    const auto cells                   = assembler.stretch(snapshot.y);
    const std::size_t n = d.element.n, q = d.element.degree;
    for (std::size_t p = 0; p < points_.size(); ++p)
    {
      const unsigned int cell = points_[p].cell;
      double u_p = 0., v_p = 0.;
      for (std::size_t i = 0; i < n; ++i)
      {
        u_p += values_[p * n + i] * u_local[cell * q + i];
        v_p += values_[p * n + i] * v_local[cell * q + i];
      }
      fields_.displacement[p]   = u_p * units.length;
      fields_.position[p]       = coordinates_[p] + fields_.displacement[p];
      fields_.velocity[p]       = v_p;
      const double drawn        = cells.empty() ? 0. : slopes[cell] * (points_[p].x - 0.5);
      const double strain       = d.slope(u_local, cell, &derivatives_[p * n]) + drawn;
      fields_.stretch[p]        = cells.empty() ? 1. + strain : std::max(cells[cell] + drawn, 0.);
      fields_.elastic_stress[p] = units.force * equation::body_force(strain, 0., assembler.scene.body.elastic_modulus);
    }
    if (general_)
    {
      general_->sample(snapshot.computed_time, snapshot.y, snapshot.v);
      fields_.active_stress  = general_->force.m;
      fields_.friction_force = general_->friction.f;
      for (std::size_t p = 0; p < points_.size(); ++p)
        fields_.elastic_stress[p] = units.force * (general_->force.N[p] - general_->force.m[p]);
    }
    else
    {
      stress_->values(snapshot.computed_time, fields_.active_stress);
      assembler.scene.friction->values(fields_.stretch, fields_.friction_force);
      for (std::size_t p = 0; p < points_.size(); ++p)
        fields_.friction_force[p] = equation::friction_force(fields_.friction_force[p], fields_.velocity[p]);
    }
    if (!friction.empty())
      for (std::size_t p = 0; p < points_.size(); ++p)
        fields_.friction_force[p] =
          values_[p * n] * friction[points_[p].cell] + values_[p * n + 1] * friction[points_[p].cell + 1];
    require_finite(fields_.active_stress, snapshot.computed_time * units.time, d);
    for (std::size_t p = 0; p < points_.size(); ++p)
    {
      fields_.friction_force[p] *= units.force / units.length;
      fields_.active_stress[p] *= units.force;
      fields_.velocity[p] *= units.velocity();
    }
    return fields_;
  }
} // namespace crawler
