// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/model/crawler_equation.h>
#include <crawler/observers/field_sampler.h>

#include <deal.II/base/polynomial.h>

namespace crawler
{
  FieldSampler::FieldSampler(const Scene &scene, const Discretization &discretization, std::vector<Point> points)
    : scene_(scene)
    , discretization_(discretization)
    , points_(std::move(points))
  {
    std::vector<dealii::Point<1>> nodes;
    for (const double x : discretization.element().nodes)
      nodes.emplace_back(x);
    const auto shape = dealii::Polynomials::generate_complete_Lagrange_basis(nodes);
    std::vector<double> value_and_derivative(2);
    for (const Point &point : points_)
    {
      const double h = discretization.cell_size()[point.cell];
      coordinates_.push_back(discretization.cell_left()[point.cell] + point.x * h);
      for (const auto &polynomial : shape)
      {
        polynomial.value(point.x, value_and_derivative);
        values_.push_back(value_and_derivative[0]);
        derivatives_.push_back(value_and_derivative[1] / h);
      }
    }
    stress_ = scene.active_stress->at(coordinates_);
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
  FieldSampler::sample(const double t, const std::span<const double> u, const std::span<const double> v)
  {
    const auto u_local   = discretization_.to_local(u, u_local_);
    const auto v_local   = discretization_.to_local(v, v_local_);
    const unsigned int n = discretization_.element().n, q = discretization_.element().degree;
    const double k = scene_.body.elastic_modulus;
    for (std::size_t p = 0; p < points_.size(); ++p)
    {
      double u_p = 0., v_p = 0., e = 0.;
      for (unsigned int i = 0; i < n; ++i)
      {
        const std::size_t node = static_cast<std::size_t>(points_[p].cell) * q + i;
        u_p += values_[p * n + i] * u_local[node];
        v_p += values_[p * n + i] * v_local[node];
        e += derivatives_[p * n + i] * u_local[node];
      }
      fields_.displacement[p]   = u_p;
      fields_.position[p]       = coordinates_[p] + u_p;
      fields_.velocity[p]       = v_p;
      fields_.stretch[p]        = 1. + e;
      fields_.elastic_stress[p] = equation::body_force(e, 0., k);
    }
    stress_->values(t, fields_.active_stress);
    scene_.friction->values(fields_.stretch, fields_.friction_force);
    for (std::size_t p = 0; p < points_.size(); ++p)
      fields_.friction_force[p] = equation::friction_force(fields_.friction_force[p], fields_.velocity[p]);
    return fields_;
  }
} // namespace crawler
