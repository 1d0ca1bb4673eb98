// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Part of PositionForm that measures how well the mesh resolves a state (doc/numerics.md, "Error indicator" and
// "Accuracy").
#include <crawler/equation/position_form.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    /// Floor of the stretch for relative errors: an emptied region sticks and pushes no more.
    constexpr double smallest_scale = 0.05;

  } // namespace

  Resolution
  PositionForm::resolution(const ConstVector y)
  {
    const auto local    = discretization.to_local(displacement(y), u_local_);
    const auto &element = discretization.element;
    double sums[2]      = {0., 0.};
    // Stretches are polynomials of degree q - 1 in a cell.
    std::vector<double> highest_mode;
    for (unsigned int p = 0; p < element.n; ++p)
      highest_mode.push_back((2. * element.degree - 1.) * element.weights[p] *
                             std::legendre(element.degree - 1, 2. * element.points[p] - 1.));
    for (unsigned int c = 0; c < discretization.n_local_cells(); ++c)
    {
      const double h = discretization.cell_size[c];
      double mode = 0., strain = 0., smallest = std::numeric_limits<double>::infinity();
      for (unsigned int p = 0; p < element.n; ++p)
      {
        const double e = discretization.slope(local, c, &element.derivatives[p * element.n]);
        mode += highest_mode[p] * e;
        strain += element.weights[p] * e * e;
        smallest = std::min(smallest, 1. + e);
      }
      sums[0] += h / (2. * element.degree - 1.) * (mode / smallest) * (mode / smallest);
      sums[1] += h * strain;
    }
    discretization.sum_over_ranks(sums);
    return {sums[0], sums[1]};
  }

  std::vector<double>
  PositionForm::error_indicators(const double t, const ConstVector y, const ConstVector v)
  {
    const auto &element   = discretization.element;
    const auto &to_points = element.integrate_points; // [quadrature point][friction point]
    const unsigned int n = element.n, n_cells = discretization.n_local_cells();
    CellInput in = input(t, y, v);
    evaluate_laws(t, y, in);
    for (std::vector<double> *field : {&force_, &friction_})
      field->resize(static_cast<std::size_t>(n_cells) * n);
    kernels_.forces(in, force_.data(), friction_.data());
    const std::vector<double> &weights = element.weights;

    // Force N* at the left end of the own cells.
    double own = 0., balance = 0.;
    for (unsigned int c = 0; c < n_cells; ++c)
      for (unsigned int i = 0; i < n; ++i)
        own += discretization.cell_size[c] * weights[i] * friction_[c * n + i];
    if (discretization.n_ranks > 1)
    {
      MPI_Exscan(&own, &balance, 1, MPI_DOUBLE, MPI_SUM, discretization.communicator);
      if (discretization.rank == 0)
        balance = 0.;
    }

    const std::span<const double> local(in.u, discretization.n_local());
    std::vector<double> indicators(n_cells, 0.);
    for (unsigned int c = 0; c < n_cells; ++c)
    {
      const double h    = discretization.cell_size[c];
      const double *g_v = &friction_[c * n];
      for (unsigned int p = 0; p < n; ++p)
      {
        double N = balance;
        for (unsigned int i = 0; i < n; ++i)
          N += h * to_points[p * n + i] * g_v[i];
        const double e = discretization.slope(local, c, &element.derivatives[p * element.n]);
        const double k = in.laws != nullptr ? in.laws->k[c * n + p] : in.k;
        const double d = (N - force_[c * n + p]) / k;
        const double w = std::max(1. + e, smallest_scale);
        // Relative errors of the friction are w g'/g times those of the stretch.
        double g = 0., w_dg = 0.;
        scene.friction->values({&w, 1}, {&g, 1}, {&w_dg, 1});
        const double relative = d / w * std::max(1., std::abs(w_dg / g));
        indicators[c] += h * element.weights[p] * relative * relative;
      }
      for (unsigned int i = 0; i < n; ++i)
        balance += h * weights[i] * g_v[i];
    }
    return indicators;
  }
} // namespace crawler
