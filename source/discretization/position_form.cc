// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/discretization/position_form.h>

#include <algorithm>

namespace crawler
{
  PositionForm::PositionForm(const Scene &scene, const Discretization &discretization)
    : Assembler(scene, discretization, discretization.points(discretization.element().points))
    , kernels_(cell_kernels(discretization.element().degree))
    , jacobian_(discretization)
  {
  }

  long
  PositionForm::add_residual(double, ConstVector, const CellInput &in, double *F)
  {
    return kernels_.residual(in, F);
  }

  void
  PositionForm::jacobian_blocks(double, ConstVector, const CellInput &in, const double sigma, double *blocks)
  {
    kernels_.jacobian(in, sigma, blocks);
  }

  void
  PositionForm::mass_blocks(double, ConstVector, const CellInput &in, double *blocks)
  {
    kernels_.mass(in, blocks);
  }

  bool
  PositionForm::residual(const double t, const ConstVector u, const ConstVector v, const Vector F)
  {
    const CellInput in = input(t, u, v);
    const bool one     = discretization_.n_active_ranks() == 1;
    double *data       = F.data();
    if (one)
      std::fill(F.begin(), F.end(), 0.);
    else
    {
      F_local_.assign(discretization_.n_local(), 0.);
      data = F_local_.data();
    }
    const long bad = add_residual(t, u, in, data);
    if (!one)
      discretization_.add_to_owned<double>(F_local_, F);

    StretchAt found{std::numeric_limits<double>::infinity(), 0.};
    if (bad >= 0)
    {
      const auto &element      = discretization_.element();
      const unsigned int cell  = static_cast<unsigned int>(bad) / element.n,
                         point = static_cast<unsigned int>(bad) % element.n;
      const double h           = discretization_.cell_size()[cell];
      double w                 = 1.;
      for (unsigned int i = 0; i < element.n; ++i)
        w += element.derivatives[point * element.n + i] / h * in.u[cell * element.degree + i];
      found = {w, discretization_.cell_left()[cell] + h * element.points[point]};
    }
    int any = bad >= 0;
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, discretization_.communicator());
    if (any == 0)
      return true;
    bad_stretch_ = smallest_of_ranks(found);
    return false;
  }

  void
  PositionForm::jacobian(
    const double t, const ConstVector u, const ConstVector v, const double sigma, ChainMatrix<double> &A)
  {
    jacobian_blocks(t, u, input(t, u, v), sigma, A.blocks().data());
  }

  bool
  PositionForm::setup_jacobian(const double t, const ConstVector u, const ConstVector v, const double sigma)
  {
    jacobian(t, u, v, sigma, jacobian_);
    return jacobian_.factorize();
  }

  void
  PositionForm::solve_with_jacobian(const ConstVector b, const Vector x)
  {
    jacobian_.solve(b, x);
  }

  void
  PositionForm::jacobian_vmult(const ConstVector x, const Vector y)
  {
    jacobian_.multiply(x, y);
  }

  bool
  PositionForm::setup_complex_jacobians(const double t,
                                        const ConstVector u,
                                        const ConstVector v,
                                        const std::span<const Complex> sigma)
  {
    setup_stage(0, t, u, v);
    bool ok = true;
    for (std::size_t i = 0; i < sigma.size(); ++i)
    {
      if (complex_jacobians_.size() <= i)
        complex_jacobians_.emplace_back(discretization_);
      const auto &by_u = stages_[0].by_u.blocks(), &by_v = stages_[0].by_v.blocks();
      auto &blocks = complex_jacobians_[i].blocks();
      for (std::size_t j = 0; j < blocks.size(); ++j)
        blocks[j] = by_u[j] + sigma[i] * by_v[j];
      ok = complex_jacobians_[i].factorize() && ok;
    }
    return ok;
  }

  void
  PositionForm::solve_with_complex_jacobian(const unsigned int i,
                                            const std::span<const Complex> b,
                                            const std::span<Complex> x)
  {
    complex_jacobians_[i].solve(b, x);
  }

  void
  PositionForm::setup_stage(const unsigned int stage, const double t, const ConstVector u, const ConstVector v)
  {
    while (stages_.size() <= stage)
      stages_.push_back({ChainMatrix<double>(discretization_), ChainMatrix<double>(discretization_)});
    const CellInput in = input(t, u, v);
    jacobian_blocks(t, u, in, 0., stages_[stage].by_u.blocks().data());
    mass_blocks(t, u, in, stages_[stage].by_v.blocks().data());
  }

  void
  PositionForm::stage_vmult(const unsigned int stage, const ConstVector x, const ConstVector x_dot, const Vector result)
  {
    stages_[stage].by_u.multiply(x, result);
    product_.resize(result.size());
    stages_[stage].by_v.multiply(x_dot, product_);
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] += product_[i];
  }

  bool
  PositionForm::velocity(const double t, const ConstVector u, const Vector v)
  {
    if (!mass_)
      mass_ = std::make_unique<ChainMatrix<double>>(discretization_);
    if (!residual(t, u, {}, v))
      return false;
    for (double &value : v)
      value = -value;
    mass_blocks(t, u, input(t, u, {}), mass_->blocks().data());
    if (!mass_->factorize())
      return false;
    mass_->solve(v, v);
    return true;
  }

  CellIntegrals
  PositionForm::integrals(const double t, const ConstVector u, const ConstVector v)
  {
    CellIntegrals sum;
    kernels_.integrals(input(t, u, v), sum);
    sum_over_ranks(sum);
    return sum;
  }

  const std::vector<double> &
  PositionForm::friction_weights() const
  {
    return discretization_.element().weights;
  }

  const std::vector<double> &
  PositionForm::friction_integration() const
  {
    return discretization_.element().integrate_points;
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
