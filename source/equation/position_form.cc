// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/parabola.h>
#include <crawler/equation/newton_velocity.h>
#include <crawler/equation/position_form.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Entry of the rank with the smallest key, on all ranks.
    StretchAt
    reduce_minimum(const StretchAt own, const double sign, const Discretization &discretization)
    {
      const unsigned int size = discretization.n_ranks;
      if (size == 1)
        return own;
      const double sent[2] = {own.value, own.s};
      std::vector<double> all(2 * size);
      MPI_Allgather(sent, 2, MPI_DOUBLE, all.data(), 2, MPI_DOUBLE, discretization.communicator);
      StretchAt best{all[0], all[1]};
      for (unsigned int r = 1; r < size; ++r)
        if (sign * all[2 * r] < sign * best.value || (std::isnan(all[2 * r]) && !std::isnan(best.value)))
          best = {all[2 * r], all[2 * r + 1]};
      return best;
    }
  } // namespace

  PositionForm::PositionForm(const Scene &scene, const Discretization &discretization)
    : Assembler(scene, discretization)
    , kernels_(cell_kernels(discretization.element.degree))
    , jacobian_(discretization)
    , stress_(scene.active_stress->at(discretization.points(discretization.element.points)))
    , stresses_(1)
  {
    if (scene.is_plain())
      return;
    const auto points = discretization.points(discretization.element.points);
    const std::vector<double> zero(points.size());
    general_.emplace(
      General{{scene, points}, {scene, points}, {scene, discretization, points}, zero, zero, zero, zero, zero, {}});
  }

  CellInput
  PositionForm::input(const double t, const ConstVector u, const ConstVector v)
  {
    return {discretization.n_local_cells(),
            discretization.cell_size.data(),
            &discretization.element,
            scene.friction.get(),
            scene.body.elastic_modulus,
            discretization.to_local(u, u_local_).data(),
            v.data() == nullptr ? nullptr : discretization.to_local(v, v_local_).data(),
            stress_at(t).data()};
  }

  const std::vector<double> &
  PositionForm::stress_at(const double t)
  {
    auto found =
      std::find_if(stresses_.begin(), stresses_.end(), [t](const StressAtTime &stress) { return stress.time == t; });
    if (found == stresses_.end())
    {
      found          = stresses_.begin() + oldest_stress_;
      oldest_stress_ = (oldest_stress_ + 1) % stresses_.size();
      found->m.resize(static_cast<std::size_t>(discretization.n_local_cells()) * discretization.element.n);
      stress_->values(t, found->m);
      found->time = t;
    }
    return found->m;
  }

  void
  PositionForm::keep_stresses(const unsigned int n_times)
  {
    stresses_.resize(n_times);
    oldest_stress_ = 0;
  }

  void
  PositionForm::forget_stresses()
  {
    for (StressAtTime &stress : stresses_)
      stress.time = std::numeric_limits<double>::quiet_NaN();
  }

  StretchRange
  PositionForm::stretch_range(const ConstVector y)
  {
    const auto local          = discretization.to_local(displacement(y), u_local_);
    const auto &element       = discretization.element;
    const unsigned int n      = element.n;
    constexpr double infinity = std::numeric_limits<double>::infinity();

    const auto place      = [&](const unsigned int i) { return element.sample_places[i]; };
    const auto stretch_at = [&](const unsigned int c, const unsigned int i) {
      return 1. + discretization.slope(local, c, &element.sample_derivatives[i * n]);
    };

    struct Found
    {
      double w;
      unsigned int cell, i;
    };
    Found smallest{infinity, 0, 0}, largest{-infinity, 0, 0};
    for (unsigned int c = 0; c < discretization.n_local_cells(); ++c)
      for (unsigned int i = 0; i < n + 2; ++i)
      {
        const double w = stretch_at(c, i);
        if (w < smallest.w || (std::isnan(w) && !std::isnan(smallest.w)))
          smallest = {w, c, i};
        if (w > largest.w)
          largest = {w, c, i};
      }

    // Parabola through the neighbours: inside a cell it comes closer to the extreme than the sample.
    const auto sharpened = [&](const Found &found) {
      double x = place(found.i), w = found.w;
      if (discretization.n_local_cells() == 0)
        return StretchAt{w, 0.};
      if (found.i > 0 && found.i <= n && std::isfinite(w))
      {
        const auto [vertex_x, vertex_w] = parabola_vertex(place(found.i - 1),
                                                          stretch_at(found.cell, found.i - 1),
                                                          x,
                                                          w,
                                                          place(found.i + 1),
                                                          stretch_at(found.cell, found.i + 1));
        if (w <= 0. || vertex_w > 0.)
        {
          x = vertex_x;
          w = vertex_w;
        }
      }
      return StretchAt{w, discretization.cell_left[found.cell] + discretization.cell_size[found.cell] * x};
    };
    return {reduce_minimum(sharpened(smallest), 1., discretization),
            reduce_minimum(sharpened(largest), -1., discretization)};
  }

  void
  PositionForm::set_initial_state(const Vector y)
  {
    std::fill(y.begin(), y.end(), 0.);
    const auto &initial = scene.profiles.initial_stretch;
    if (!initial)
      return;
    // Displacement u: the integral of w - 1, from node to node by a Gauss formula, minus its mean.
    const auto &element  = discretization.element;
    const auto &formula  = reference_element(ReferenceElement::highest_degree);
    const unsigned int n = element.n;
    std::vector<double> u(discretization.n_unknowns(), 0.), places(formula.n), w(formula.n);
    double mean = 0.;
    for (std::size_t c = 0; c < discretization.n_cells(); ++c)
    {
      const Cell &cell = discretization.cells[c];
      for (unsigned int i = 0; i < n; ++i)
      {
        double &here = u[c * element.degree + i];
        if (i > 0)
        {
          const double from = cell.left + cell.size * element.nodes[i - 1],
                       size = cell.size * (element.nodes[i] - element.nodes[i - 1]);
          for (unsigned int p = 0; p < formula.n; ++p)
            places[p] = from + size * formula.points[p];
          initial->values(places, w);
          here = u[c * element.degree + i - 1];
          for (unsigned int p = 0; p < formula.n; ++p)
            here += size * formula.weights[p] * (w[p] - 1.);
        }
        mean += cell.size * element.node_weights[i] * here;
      }
    }
    const auto owned = discretization.owned_part(u);
    for (std::size_t i = 0; i < owned.size(); ++i)
      y[i] = owned[i] - mean / discretization.length;
  }

  long
  PositionForm::evaluate_laws(const double t, const ConstVector u, CellInput &in)
  {
    if (!general_)
      return -1;
    [[maybe_unused]] auto &[friction, force, elsewhere, e, w, u_at, v_at, rate, laws, of_jacobian] = *general_;
    kernels_.states(in, u_at.data(), v_at.data(), e.data(), rate.data());
    long bad = -1;
    for (std::size_t i = 0; i < e.size(); ++i)
    {
      w[i] = 1. + e[i];
      if (bad < 0 && !(w[i] > 0.))
        bad = static_cast<long>(i);
    }
    elsewhere.evaluate(t, u, history);
    if (bad >= 0)
      return bad;
    force.evaluate(t, e, {w, rate, elsewhere.near, elsewhere.delayed}, in.m);
    bad = friction.evaluate(u_at, v_at, w);
    if (bad >= 0)
      describe_bad_law_ = friction.describe(bad);
    else
      bad = look_at_friction(w, friction.g);
    laws    = {force.N.data(),
               friction.f.data(),
            scene.ground.profile ? friction.f_u.data() : nullptr,
               friction.f_v.data(),
               friction.w_f_w.data(),
               force.by_w.data(),
            force.by_rate.empty() ? nullptr : force.by_rate.data(),
               force.k.data(),
               force.m.data()};
    in.laws = &laws;
    return bad;
  }

  void
  PositionForm::add_far(const std::vector<double> &by_near, const ConstVector x, const Vector result) const
  {
    if (solves_exactly())
      return;
    const ReferenceElement &element = discretization.element;
    const unsigned int n = element.n, q = element.degree;
    std::vector<double> change(by_near.size()), local(discretization.n_local(), 0.), owned(result.size());
    general_->elsewhere.near_strain(x, change);
    for (std::size_t c = 0; c < discretization.n_local_cells(); ++c)
      for (unsigned int p = 0; p < n; ++p)
        for (unsigned int i = 0; i < n; ++i)
          local[c * q + i] +=
            element.weights[p] * by_near[c * n + p] * change[c * n + p] * element.derivatives[p * n + i];
    discretization.add_to_owned(local, owned);
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] += owned[i];
  }

  bool
  PositionForm::solves_exactly() const
  {
    return !scene.feels_elsewhere();
  }

  bool
  PositionForm::residual(const double t, const ConstVector u, const ConstVector v, const Vector F)
  {
    CellInput in   = input(t, u, v);
    const bool one = discretization.n_active_ranks == 1;
    double *data   = F.data();
    if (one)
      std::fill(F.begin(), F.end(), 0.);
    else
    {
      F_local_.assign(discretization.n_local(), 0.);
      data = F_local_.data();
    }
    long bad = evaluate_laws(t, u, in);
    if (bad < 0)
      bad = kernels_.residual(in, data);
    if (!one)
      discretization.add_to_owned(F_local_, F);
    return !is_true_anywhere(bad >= 0, discretization.communicator);
  }

  void
  PositionForm::jacobian(const double t,
                         const ConstVector u,
                         const ConstVector v,
                         const double by_u,
                         const double by_v,
                         BlockTridiagonalMatrix<double> &A)
  {
    CellInput in = input(t, u, v);
    evaluate_laws(t, u, in);
    kernels_.blocks(in, by_u, by_v, A.blocks.data());
  }

  bool
  PositionForm::setup_jacobian(const double t, const ConstVector u, const ConstVector v, const double sigma)
  {
    jacobian(t, u, v, 1., sigma, jacobian_);
    if (general_)
      general_->jacobian_by_near = general_->force.by_near;
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
    if (general_)
      add_far(general_->jacobian_by_near, x, y);
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
        complex_jacobians_.emplace_back(discretization);
      const auto &by_u = stages_[0].by_u.blocks, &by_v = stages_[0].by_v.blocks;
      auto &blocks = complex_jacobians_[i].blocks;
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
      stages_.push_back(
        {BlockTridiagonalMatrix<double>(discretization), BlockTridiagonalMatrix<double>(discretization), {}});
    jacobian(t, u, v, 1., 0., stages_[stage].by_u);
    jacobian(t, u, v, 0., 1., stages_[stage].by_v);
    if (general_)
      stages_[stage].by_near = general_->force.by_near;
  }

  void
  PositionForm::stage_vmult(const unsigned int stage, const ConstVector x, const ConstVector x_dot, const Vector result)
  {
    stages_[stage].by_u.multiply(x, result);
    product_.resize(result.size());
    stages_[stage].by_v.multiply(x_dot, product_);
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] += product_[i];
    add_far(stages_[stage].by_near, x, result);
  }

  bool
  PositionForm::velocity(const double t, const ConstVector u, const Vector v)
  {
    if (general_)
    {
      std::fill(v.begin(), v.end(), 0.);
      return newton_velocity(
        discretization,
        v,
        [&](const ConstVector at, const Vector F) { return residual(t, u, at, F); },
        [&](const ConstVector at, const Vector change) { return solve_with_mass(t, u, at, change); });
    }
    if (!residual(t, u, {}, v))
      return false;
    for (double &value : v)
      value = -value;
    return solve_with_mass(t, u, {}, v);
  }

  bool
  PositionForm::solve_with_mass(const double t, const ConstVector u, const ConstVector v, const Vector x)
  {
    if (!mass_)
      mass_ = std::make_unique<BlockTridiagonalMatrix<double>>(discretization);
    jacobian(t, u, v, 0., 1., *mass_);
    if (!mass_->factorize())
      return false;
    mass_->solve(x, x);
    return true;
  }

  CellIntegrals
  PositionForm::integrals(const double t, const ConstVector u, const ConstVector v)
  {
    CellIntegrals sum;
    CellInput in = input(t, u, v);
    evaluate_laws(t, u, in);
    kernels_.integrals(in, sum);
    static_assert(sizeof(sum) % sizeof(double) == 0);
    discretization.sum_over_ranks({reinterpret_cast<double *>(&sum), sizeof(sum) / sizeof(double)});
    return sum;
  }
} // namespace crawler
