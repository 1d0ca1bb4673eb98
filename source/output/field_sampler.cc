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
      if (is_true_anywhere(is_bad, discretization.communicator()))
        throw NonfiniteStress(fmt::format("the active stress at t = {:.9g} is not a finite number everywhere", t));
    }
  } // namespace

  FieldSampler::FieldSampler(const Assembler &assembler, const Units &units, std::vector<CellPlace> points)
    : assembler_(assembler)
    , units_(units)
    , points_(std::move(points))
    , values_(interpolation_matrix(assembler.discretization().element().nodes, in_cells(points_)))
    , stretch_(assembler.discretization().element(), in_cells(points_))
  {
    coordinates_ = assembler.discretization().points_of(points_);
    if (assembler.scene().is_plain())
      stress_ = assembler.scene().active_stress->at(coordinates_);
    else
      general_ = std::make_unique<GeneralSampler>(assembler, points_);
    for (double &s : coordinates_)
      s *= units.length;
    for (auto *field : {&fields_.position,
                        &fields_.displacement,
                        &fields_.stretch,
                        &fields_.velocity,
                        &fields_.active_stress,
                        &fields_.elastic_stress,
                        &fields_.friction_force})
      field->resize(points_.size());
  }

  const Fields &
  FieldSampler::sample(const double t, const std::span<const double> y, const std::span<const double> v)
  {
    const Discretization &d            = assembler_.discretization();
    const auto u_local                 = d.to_local(assembler_.displacement(y), u_local_);
    const auto v_local                 = d.to_local(v, v_local_);
    const std::vector<double> slopes   = assembler_.stretch_slopes(y);
    const std::vector<double> friction = assembler_.node_friction(t, y, v);
    const auto cells                   = assembler_.stretch(y);
    const unsigned int n = d.element().n, q = d.element().degree;
    const double k = assembler_.scene().body.elastic_modulus;
    for (std::size_t p = 0; p < points_.size(); ++p)
    {
      const unsigned int cell = points_[p].cell;
      const auto place        = static_cast<unsigned int>(p);
      double u_p = 0., v_p = 0.;
      for (unsigned int i = 0; i < n; ++i)
      {
        const std::size_t node = static_cast<std::size_t>(cell) * q + i;
        u_p += values_[p * n + i] * u_local[node];
        v_p += values_[p * n + i] * v_local[node];
      }
      fields_.displacement[p] = u_p * units_.length;
      fields_.position[p]     = coordinates_[p] + fields_.displacement[p];
      fields_.velocity[p]     = v_p;
      double strain           = stretch_.strain(u_local, cell, d.cell_size()[cell], place);
      fields_.stretch[p]      = 1. + strain;
      if (!cells.empty())
      {
        const double drawn = slopes[cell] * (points_[p].x - 0.5);
        strain += drawn;
        fields_.stretch[p] = std::max(cells[cell] + drawn, 0.);
      }
      fields_.elastic_stress[p] = units_.force * equation::body_force(strain, 0., k);
    }
    if (general_)
    {
      general_->sample(t, y, v);
      const BodyForceAtPoints &force = general_->force();
      fields_.active_stress          = force.m;
      fields_.friction_force         = general_->friction();
      for (std::size_t p = 0; p < points_.size(); ++p)
        fields_.elastic_stress[p] = units_.force * (force.N[p] - force.m[p]);
    }
    else
    {
      stress_->values(t, fields_.active_stress);
      assembler_.scene().friction->values(fields_.stretch, fields_.friction_force);
      for (std::size_t p = 0; p < points_.size(); ++p)
        fields_.friction_force[p] = equation::friction_force(fields_.friction_force[p], fields_.velocity[p]);
    }
    if (!friction.empty())
      for (std::size_t p = 0; p < points_.size(); ++p)
        fields_.friction_force[p] =
          values_[p * n] * friction[points_[p].cell] + values_[p * n + 1] * friction[points_[p].cell + 1];
    require_finite(fields_.active_stress, t * units_.time, d);
    for (std::size_t p = 0; p < points_.size(); ++p)
    {
      fields_.friction_force[p] *= units_.force / units_.length;
      fields_.active_stress[p] *= units_.force;
      fields_.velocity[p] *= units_.velocity();
    }
    return fields_;
  }
} // namespace crawler
