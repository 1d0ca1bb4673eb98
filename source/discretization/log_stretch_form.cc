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
  {
  }

  template <typename Number>
  LogStretchForm::Eliminated<Number>::Eliminated(const Discretization &discretization)
    : matrix(discretization)
    , factors(static_cast<std::size_t>(discretization.n_local_cells()) *
              log_factors<Number>(discretization.element().degree))
  {
  }

  std::vector<double>
  LogStretchForm::weights() const
  {
    // The error of log w that counts as much as an error of 1 in the displacement; the velocity follows from the rest.
    constexpr double log_weight = 10., velocity_weight = 1e10;
    const std::size_t n = discretization_.n_owned();
    std::vector<double> result(n_owned(), log_weight);
    std::fill_n(result.begin(), n, 1.);
    std::fill_n(result.rbegin(), n, velocity_weight);
    return result;
  }

  void
  LogStretchForm::make_consistent(const double t, const Vector y)
  {
    velocity(t, y, velocities(y));
  }

  LogCellInput
  LogStretchForm::log_input(const double t, const ConstVector y, const ConstVector v)
  {
    LogCellInput in{input(t, displacement(y), v), log_stretch(y).data(), nullptr, {}};
    const unsigned int n = discretization_.n_local_cells();
    if (q_ > 1 || n == 0 || discretization_.n_active_ranks() == 1)
      return in;
    const int rank = static_cast<int>(discretization_.rank()), tag = 0;
    const int left  = discretization_.has_left_neighbour() ? rank - 1 : MPI_PROC_NULL;
    const int right = discretization_.has_right_neighbour() ? rank + 1 : MPI_PROC_NULL;
    const LogCellInput::Beside first{in.cells.cell_size[0], in.log_w[0]},
      last{in.cells.cell_size[n - 1], in.log_w[n - 1]};
    const auto exchange = [&](const auto &sent, const int to, auto &received, const int from)
    {
      MPI_Sendrecv(&sent,
                   2,
                   MPI_DOUBLE,
                   to,
                   tag,
                   &received,
                   2,
                   MPI_DOUBLE,
                   from,
                   tag,
                   discretization_.communicator(),
                   MPI_STATUS_IGNORE);
    };
    exchange(first, left, in.beside[1], right);
    exchange(last, right, in.beside[0], left);
    return in;
  }

  bool
  LogStretchForm::residual(const double t, const ConstVector y, const ConstVector y_dot, const Vector F)
  {
    const std::size_t n = discretization_.n_owned();
    LogCellInput in     = log_input(t, y, velocities(y));
    in.log_w_dot        = log_stretch(y_dot).data();
    node_local_.assign(discretization_.n_local(), 0.);
    kernels_.residual(in, node_local_.data(), F.data() + n);
    discretization_.add_to_owned<double>(node_local_, velocities(F));
    const auto v = velocities(y);
    for (std::size_t i = 0; i < n; ++i)
      F[i] = y_dot[i] - v[i];
    return true;
  }

  template <typename Number>
  bool
  LogStretchForm::setup(Eliminated<Number> &jacobian,
                        const LogCellInput &in,
                        const LogLaws *laws,
                        const Number sigma) const
  {
    jacobian.sigma          = sigma;
    const auto &elimination = log_elimination<Number>(q_);
    auto &blocks            = jacobian.matrix.blocks();
    bool ok                 = false;
    if (laws == nullptr)
      ok = elimination.jacobian(in, sigma, blocks.data(), jacobian.factors.data());
    else
    {
      ok = elimination.general_jacobian(in, *laws, sigma, blocks.data(), jacobian.factors.data());
      keep_laws(jacobian, *laws);
      // u follows from the velocity: sigma u = v.
      const auto &e = *in.cells.element;
      for (std::size_t c = 0; c < in.cells.n_cells; ++c)
        for (unsigned int i = 0; i < e.n; ++i)
          blocks[(c * e.n + i) * e.n + i] +=
            in.cells.cell_size[c] * e.node_weights[i] * laws->by_u[c * e.n + i] / sigma;
    }
    int all_ok = jacobian.matrix.factorize() && ok;
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &all_ok, 1, MPI_INT, MPI_MIN, discretization_.communicator());
    return all_ok != 0;
  }

  template <typename Number>
  void
  LogStretchForm::keep_laws(Eliminated<Number> &jacobian, const LogLaws &laws) const
  {
    const auto &e = discretization_.element();
    std::vector<double> local(discretization_.n_local(), 0.);
    for (std::size_t c = 0; c < discretization_.n_local_cells(); ++c)
      for (unsigned int i = 0; i < e.n; ++i)
        local[c * q_ + i] += discretization_.cell_size()[c] * e.node_weights[i] * laws.by_u[c * e.n + i];
    jacobian.by_u.resize(discretization_.n_owned());
    discretization_.add_to_owned<double>(local, jacobian.by_u);
    jacobian.laws = laws;
  }

  /// What factors do not have: the place on the ground, the rate of the stretch and the stretch nearby.
  void
  LogStretchForm::add_general(const Eliminated<double> &jacobian, const ConstVector x, const Vector y) const
  {
    const auto &e       = discretization_.element();
    const LogLaws &laws = *jacobian.laws;
    std::vector<double> local(discretization_.n_local(), 0.), near(laws.by_near.size()), buffer;
    const auto v = discretization_.to_local<double>(velocities(x), buffer);
    if (!near.empty() || discretization_.n_ranks() > 1)
      change_of_near(laws, x, near);
    for (std::size_t c = 0; c < discretization_.n_local_cells(); ++c)
      for (unsigned int p = 0; p < q_; ++p)
      {
        const double *D = &e.stretch_derivatives[p * e.n];
        double force    = near.empty() ? 0. : laws.by_near[c * q_ + p] * near[c * q_ + p];
        if (!laws.by_rate.empty())
          for (unsigned int i = 0; i < e.n; ++i)
            force += laws.by_rate[c * q_ + p] * D[i] / discretization_.cell_size()[c] * v[c * q_ + i];
        for (unsigned int i = 0; i < e.n; ++i)
          local[c * q_ + i] += e.stretch_weights[p] * force * D[i];
      }
    std::vector<double> owned(discretization_.n_owned());
    discretization_.add_to_owned<double>(local, owned);
    const Vector F = velocities(y);
    for (std::size_t i = 0; i < owned.size(); ++i)
      F[i] += owned[i] + jacobian.by_u[i] * x[i];
  }

  template <typename Number>
  void
  LogStretchForm::solve(Eliminated<Number> &jacobian, const std::span<const Number> b, const std::span<Number> x) const
  {
    const auto &elimination = log_elimination<Number>(q_);
    const CellInput cells   = geometry();
    const std::size_t n     = discretization_.n_owned();
    if (x.data() != b.data())
      std::copy(b.begin(), b.end(), x.begin());
    const std::span<Number> v = velocities(x);
    jacobian.node_local.assign(discretization_.n_local(), 0.);
    elimination.reduce(cells, jacobian.factors.data(), x.data() + n, jacobian.node_local.data());
    jacobian.nodes.resize(n);
    discretization_.add_to_owned<Number>(jacobian.node_local, jacobian.nodes);
    for (std::size_t i = 0; i < n; ++i)
      v[i] += jacobian.nodes[i];
    for (std::size_t i = 0; i < jacobian.by_u.size(); ++i)
      v[i] -= jacobian.by_u[i] * x[i] / jacobian.sigma;
    jacobian.matrix.solve(v, v);
    elimination.recover(
      cells, jacobian.factors.data(), discretization_.to_local<Number>(v, jacobian.local_buffer).data(), x.data() + n);
    for (std::size_t i = 0; i < n; ++i)
      x[i] = (x[i] + v[i]) / jacobian.sigma;
  }

  bool
  LogStretchForm::setup_jacobian(const double t, const ConstVector y, const ConstVector, const double sigma)
  {
    const LogCellInput in = log_input(t, y, velocities(y));
    return setup(jacobian_, in, laws_at(t, y, in), sigma);
  }

  void
  LogStretchForm::solve_with_jacobian(const ConstVector b, const Vector x)
  {
    solve(jacobian_, b, x);
  }

  void
  LogStretchForm::multiply(const Eliminated<double> &jacobian, const ConstVector x, const Vector y)
  {
    const std::size_t n = discretization_.n_owned();
    node_local_.assign(discretization_.n_local(), 0.);
    std::fill(y.begin(), y.end(), 0.);
    kernels_.multiply(geometry(),
                      jacobian.factors.data(),
                      discretization_.to_local<double>(velocities(x), local_buffer_).data(),
                      x.data() + n,
                      node_local_.data(),
                      y.data() + n);
    discretization_.add_to_owned<double>(node_local_, velocities(y));
    if (jacobian.laws)
      add_general(jacobian, x, y);
  }

  void
  LogStretchForm::jacobian_vmult(const ConstVector x, const Vector y)
  {
    multiply(jacobian_, x, y);
    const auto v = velocities(x);
    for (std::size_t i = 0; i < v.size(); ++i)
      y[i] = jacobian_.sigma * x[i] - v[i];
  }

  bool
  LogStretchForm::setup_complex_jacobians(const double t,
                                          const ConstVector y,
                                          const ConstVector,
                                          const std::span<const Complex> sigma)
  {
    const LogCellInput in = log_input(t, y, velocities(y));
    const LogLaws *laws   = laws_at(t, y, in);
    bool ok               = true;
    for (std::size_t i = 0; i < sigma.size(); ++i)
    {
      if (complex_jacobians_.size() <= i)
        complex_jacobians_.emplace_back(discretization_);
      ok = setup(complex_jacobians_[i], in, laws, sigma[i]) && ok;
    }
    return ok;
  }

  void
  LogStretchForm::solve_with_complex_jacobian(const unsigned int i,
                                              const std::span<const Complex> b,
                                              const std::span<Complex> x)
  {
    solve(complex_jacobians_[i], b, x);
  }

  void
  LogStretchForm::setup_stage(const unsigned int stage, const double t, const ConstVector y, const ConstVector)
  {
    while (stages_.size() <= stage)
      stages_.emplace_back(discretization_);
    auto &kept            = stages_[stage];
    const LogCellInput in = log_input(t, y, velocities(y));
    const LogLaws *laws   = laws_at(t, y, in);
    if (laws == nullptr)
      log_elimination<double>(q_).jacobian(in, 0., kept.matrix.blocks().data(), kept.factors.data());
    else
    {
      log_elimination<double>(q_).general_jacobian(in, *laws, 0., kept.matrix.blocks().data(), kept.factors.data());
      keep_laws(kept, *laws);
    }
  }

  /// dF/dy' is the identity for u and log w, and 0 for the balance of forces.
  void
  LogStretchForm::stage_vmult(const unsigned int stage,
                              const ConstVector x,
                              const ConstVector x_dot,
                              const Vector result)
  {
    multiply(stages_[stage], x, result);
    const auto v = velocities(x);
    for (std::size_t i = 0; i < v.size(); ++i)
      result[i] = x_dot[i] - v[i];
    for (std::size_t i = v.size(); i + v.size() < result.size(); ++i)
      result[i] += x_dot[i];
  }

  /// The friction matrix is diagonal here, and positive: the signs of the velocity are those of the forces.
  bool
  LogStretchForm::velocity(const double t, const ConstVector y, const Vector v)
  {
    LogCellInput in     = log_input(t, y, {});
    const std::size_t n = discretization_.n_owned();
    node_local_.assign(discretization_.n_local(), 0.);
    kernels_.residual(in, node_local_.data(), nullptr);
    discretization_.add_to_owned<double>(node_local_, v);
    for (double &force : v)
      force = -force;
    in.cells.v = discretization_.to_local<double>(v, local_buffer_).data();
    node_local_.assign(discretization_.n_local(), 0.);
    kernels_.mass(in, node_local_.data());
    nodes_.resize(n);
    discretization_.add_to_owned<double>(node_local_, nodes_);
    int ok = 1;
    for (std::size_t i = 0; i < n; ++i)
    {
      v[i] /= nodes_[i];
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
    g_v.resize(static_cast<std::size_t>(in.cells.n_cells) * e.n);
    std::vector<double> derivatives(g_v.size());
    kernels_.friction(in, g_v.data(), derivatives.data());
    for (unsigned int c = 0; c < in.cells.n_cells; ++c)
      for (unsigned int i = 0; i < e.n; ++i)
        g_v[c * e.n + i] *= in.cells.v[c * q_ + i];
  }
} // namespace crawler
