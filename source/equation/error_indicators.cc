// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The part of PositionForm that says how well the mesh resolves a state (doc/numerics.md, "Error indicator" and
// "Accuracy").
#include <crawler/equation/crawler_equation.h>
#include <crawler/equation/general_sampler.h>
#include <crawler/equation/position_form.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    /// Errors of a stretch are relative to it, but not to less than this: what is emptied sticks and pushes no more.
    constexpr double smallest_scale = 0.05;

  } // namespace

  Resolution
  PositionForm::resolution(const ConstVector y)
  {
    const auto local    = discretization_.to_local<double>(displacement(y), u_local_);
    const auto &element = discretization_.element();
    double sums[2]      = {0., 0.};
    // The stretch is a polynomial of degree q - 1 in a cell.
    std::vector<double> highest_mode;
    for (unsigned int p = 0; p < element.n; ++p)
      highest_mode.push_back((2. * element.degree - 1.) * element.weights[p] *
                             std::legendre(element.degree - 1, 2. * element.points[p] - 1.));
    for (unsigned int c = 0; c < discretization_.n_local_cells(); ++c)
    {
      const double h = discretization_.cell_size()[c];
      double mode = 0., strain = 0., smallest = std::numeric_limits<double>::infinity();
      for (unsigned int p = 0; p < element.n; ++p)
      {
        const double e = sampler_.strain(local, c, h, p + 1);
        mode += highest_mode[p] * e;
        strain += element.weights[p] * e * e;
        smallest = std::min(smallest, 1. + e);
      }
      sums[0] += h / (2. * element.degree - 1.) * (mode / smallest) * (mode / smallest);
      sums[1] += h * strain;
    }
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, discretization_.communicator());
    return {sums[0], sums[1]};
  }

  std::vector<double>
  PositionForm::error_indicators(const double t, const ConstVector y, const ConstVector v)
  {
    const auto &element   = discretization_.element();
    const auto &to_points = element.integrate_points; // [quadrature point][friction point]
    const unsigned int n = element.n, n_cells = discretization_.n_local_cells();
    const bool is_plain = scene_.is_plain();
    if (!is_plain)
    {
      if (!quadrature_sampler_)
        quadrature_sampler_ = std::make_unique<GeneralSampler>(*this, element.points);
      quadrature_sampler_->sample(t, y, v);
    }
    const std::vector<double> &m = is_plain ? stress_at(t) : quadrature_sampler_->force().m;
    friction(t, y, v, friction_at_);
    const std::vector<double> &weights = element.weights;

    // N* at the left end of the own cells.
    double own = 0., balance = 0.;
    for (unsigned int c = 0; c < n_cells; ++c)
      for (unsigned int i = 0; i < n; ++i)
        own += discretization_.cell_size()[c] * weights[i] * friction_at_[c * n + i];
    if (discretization_.n_ranks() > 1)
    {
      MPI_Exscan(&own, &balance, 1, MPI_DOUBLE, MPI_SUM, discretization_.communicator());
      if (discretization_.rank() == 0)
        balance = 0.;
    }

    const auto local = discretization_.to_local<double>(displacement(y), u_local_);
    std::vector<double> indicators(n_cells, 0.);
    for (unsigned int c = 0; c < n_cells; ++c)
    {
      const double h    = discretization_.cell_size()[c];
      const double *g_v = &friction_at_[c * n];
      for (unsigned int p = 0; p < n; ++p)
      {
        double N = balance;
        for (unsigned int i = 0; i < n; ++i)
          N += h * to_points[p * n + i] * g_v[i];
        const double e = sampler_.strain(local, c, h, p + 1);
        const double k = is_plain ? scene_.body.elastic_modulus : quadrature_sampler_->force().k[c * n + p];
        const double d = (N - equation::body_force(e, m[c * n + p], k)) / k;
        const double w = std::max(1. + e, smallest_scale);
        // An error of the stretch changes the friction by w g'/g times as much.
        double g = 0., w_dg = 0.;
        scene_.friction->values_and_log_derivatives({&w, 1}, {&g, 1}, {&w_dg, 1});
        const double relative = d / w * std::max(1., std::abs(w_dg / g));
        indicators[c] += h * element.weights[p] * relative * relative;
      }
      for (unsigned int i = 0; i < n; ++i)
        balance += h * weights[i] * g_v[i];
    }
    return indicators;
  }

  double
  PositionForm::root_mean_square(const ConstVector y) const
  {
    double sum = 0.;
    for (const double value : displacement(y))
      sum += value * value;
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, discretization_.communicator());
    return std::sqrt(sum / static_cast<double>(discretization_.n_unknowns()));
  }

  void
  PositionForm::friction(const double t, const ConstVector u, const ConstVector v, std::vector<double> &g_v)
  {
    const CellInput in = input(t, u, v);
    const auto &e      = discretization_.element();
    std::vector<double> w(e.n), g(e.n);
    g_v.resize(static_cast<std::size_t>(in.n_cells) * e.n);
    for (unsigned int c = 0; c < in.n_cells; ++c)
    {
      for (unsigned int p = 0; p < e.n; ++p)
      {
        w[p] = 1.;
        for (unsigned int i = 0; i < e.n; ++i)
          w[p] += e.derivatives[p * e.n + i] / in.cell_size[c] * in.u[c * e.degree + i];
      }
      scene_.friction->values(w, g);
      for (unsigned int p = 0; p < e.n; ++p)
      {
        double velocity = 0.;
        for (unsigned int i = 0; i < e.n; ++i)
          velocity += e.values[p * e.n + i] * in.v[c * e.degree + i];
        g_v[c * e.n + p] = g[p] * velocity;
      }
    }
  }
} // namespace crawler
