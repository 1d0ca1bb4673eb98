// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/discretization/log_stretch_form.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  LogStretchForm::LogStretchForm(const Scene &scene, const Discretization &discretization)
    : Assembler(scene, discretization, discretization.points(discretization.element().stretch_points))
    , q_(discretization.element().degree)
    , kernels_(log_cell_kernels(q_))
    , jacobian_(discretization)
    , factors_(static_cast<std::size_t>(discretization.n_local_cells()) * log_factors(q_))
  {
  }

  LogCellInput
  LogStretchForm::log_input(const double t, const ConstVector y, const ConstVector y_dot)
  {
    LogCellInput in;
    in.cells     = input(t, displacement(y), y_dot.empty() ? y_dot : displacement(y_dot));
    in.log_w     = log_stretch(y).data();
    in.log_w_dot = y_dot.size() == n_owned() ? log_stretch(y_dot).data() : nullptr;
    return in;
  }

  bool
  LogStretchForm::residual(const double t, const ConstVector y, const ConstVector y_dot, const Vector F)
  {
    const LogCellInput in = log_input(t, y, y_dot);
    node_local_.assign(discretization_.n_local(), 0.);
    kernels_.residual(in, node_local_.data(), F.data() + discretization_.n_owned());
    discretization_.add_to_owned(node_local_, F.first(discretization_.n_owned()));
    return true;
  }

  bool
  LogStretchForm::setup_jacobian(const double t, const ConstVector y, const ConstVector y_dot, const double sigma)
  {
    const bool ok =
      kernels_.jacobian(log_input(t, y, y_dot), sigma, jacobian_.blocks().data(), factors_.data());
    int all_ok = jacobian_.factorize() && ok;
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &all_ok, 1, MPI_INT, MPI_MIN, discretization_.communicator());
    return all_ok != 0;
  }

  void
  LogStretchForm::solve_with_jacobian(const ConstVector b, const Vector x)
  {
    const CellInput cells = geometry();
    const std::size_t n   = discretization_.n_owned();
    node_local_.assign(discretization_.n_local(), 0.);
    kernels_.reduce(cells, factors_.data(), b.data() + n, node_local_.data());
    const Vector u = x.first(n);
    mass_.resize(n);
    discretization_.add_to_owned(node_local_, mass_);
    for (std::size_t i = 0; i < n; ++i)
      u[i] = b[i] + mass_[i];
    jacobian_.solve(u, u);
    if (x.data() != b.data())
      std::copy(b.begin() + static_cast<std::ptrdiff_t>(n), b.end(), x.begin() + static_cast<std::ptrdiff_t>(n));
    kernels_.recover(cells, factors_.data(), discretization_.to_local(u, u_local_buffer_).data(), x.data() + n);
  }

  void
  LogStretchForm::jacobian_vmult(const ConstVector x, const Vector y)
  {
    const std::size_t n = discretization_.n_owned();
    node_local_.assign(discretization_.n_local(), 0.);
    std::fill(y.begin(), y.end(), 0.);
    kernels_.multiply(geometry(),
                      factors_.data(),
                      discretization_.to_local(x.first(n), u_local_buffer_).data(),
                      x.data() + n,
                      node_local_.data(),
                      y.data() + n);
    discretization_.add_to_owned(node_local_, y.first(n));
  }

  /// The friction matrix is diagonal here.
  bool
  LogStretchForm::velocity(const double t, const ConstVector y, const Vector v)
  {
    const LogCellInput in = log_input(t, y, {});
    const std::size_t n   = discretization_.n_owned();
    node_local_.assign(discretization_.n_local(), 0.);
    kernels_.residual(in, node_local_.data(), nullptr);
    discretization_.add_to_owned(node_local_, v);
    node_local_.assign(discretization_.n_local(), 0.);
    kernels_.mass(in, node_local_.data());
    mass_.resize(n);
    discretization_.add_to_owned(node_local_, mass_);
    int ok = 1;
    for (std::size_t i = 0; i < n; ++i)
    {
      v[i] /= -mass_[i];
      ok = ok != 0 && std::isfinite(v[i]);
    }
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &ok, 1, MPI_INT, MPI_MIN, discretization_.communicator());
    return ok != 0;
  }

  CellIntegrals
  LogStretchForm::integrals(const double t, const ConstVector y, const ConstVector v)
  {
    CellIntegrals sum;
    kernels_.integrals(log_input(t, y, v), sum);
    sum_over_ranks(sum);
    return sum;
  }

  const std::vector<double> &
  LogStretchForm::friction_weights() const
  {
    return discretization_.element().node_weights;
  }

  const std::vector<double> &
  LogStretchForm::friction_integration() const
  {
    return discretization_.element().integrate_nodes;
  }

  void
  LogStretchForm::friction(const double t, const ConstVector y, const ConstVector v, std::vector<double> &g_v)
  {
    const LogCellInput in = log_input(t, y, v);
    const auto &e         = discretization_.element();
    std::vector<double> w(e.n), g(e.n);
    g_v.resize(static_cast<std::size_t>(in.cells.n_cells) * e.n);
    for (unsigned int c = 0; c < in.cells.n_cells; ++c)
    {
      for (unsigned int i = 0; i < e.n; ++i)
      {
        double sum = 0.;
        for (unsigned int p = 0; p < q_; ++p)
          sum += e.stretch_to_nodes[i * q_ + p] * in.log_w[c * q_ + p];
        w[i] = std::exp(sum);
      }
      scene_.friction->values(w, g);
      for (unsigned int i = 0; i < e.n; ++i)
        g_v[c * e.n + i] = g[i] * in.cells.v[c * q_ + i];
    }
  }
} // namespace crawler
