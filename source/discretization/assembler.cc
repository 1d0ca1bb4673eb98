// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/parabola.h>
#include <crawler/discretization/assembler.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    /// The entry of the rank with the smallest key, on all ranks.
    StretchAt
    reduce_minimum(const StretchAt own, const double sign, const Discretization &discretization)
    {
      const unsigned int size = discretization.n_ranks();
      if (size == 1)
        return own;
      const double sent[2] = {own.value, own.s};
      std::vector<double> all(2 * size);
      MPI_Allgather(sent, 2, MPI_DOUBLE, all.data(), 2, MPI_DOUBLE, discretization.communicator());
      StretchAt best{all[0], all[1]};
      for (unsigned int r = 1; r < size; ++r)
        if (sign * all[2 * r] < sign * best.value || (std::isnan(all[2 * r]) && !std::isnan(best.value)))
          best = {all[2 * r], all[2 * r + 1]};
      return best;
    }
  } // namespace

  Assembler::Assembler(const Scene &scene, const Discretization &discretization)
    : scene_(scene)
    , discretization_(discretization)
    , kernels_(cell_kernels(discretization.element().degree))
    , stress_(scene.active_stress->at(discretization.quadrature_points()))
    , end_stress_(scene.active_stress->at({0., scene.body.length}))
    , m_(discretization.n_local_cells() * discretization.element().n)
    , m_time_(std::numeric_limits<double>::quiet_NaN())
  {
    // The stretch is a polynomial of degree q - 1 in a cell.
    const auto &element = discretization.element();
    for (unsigned int p = 0; p < element.n; ++p)
      highest_mode_.push_back((2. * element.degree - 1.) * element.weights[p] *
                              std::legendre(element.degree - 1, 2. * element.points[p] - 1.));
  }

  CellInput
  Assembler::input(const double t, const std::span<const double> u, const std::span<const double> v)
  {
    if (t != m_time_)
    {
      stress_->values(t, m_);
      m_time_ = t;
    }
    const auto local_u = discretization_.to_local(u, u_local_);
    const auto local_v = v.data() == nullptr ? v : discretization_.to_local(v, v_local_);
    return {discretization_.n_local_cells(),
            discretization_.cell_size().data(),
            &discretization_.element(),
            scene_.friction.get(),
            scene_.body.elastic_modulus,
            local_u.data(),
            local_v.data(),
            m_.data()};
  }

  bool
  Assembler::residual(const double t,
                      const std::span<const double> u,
                      const std::span<const double> v,
                      const std::span<double> F)
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
    const long bad = kernels_.residual(in, data);
    if (!one)
      discretization_.add_to_owned(F_local_, F);

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
    bad_stretch_ = reduce_minimum(found, 1., discretization_);
    return false;
  }

  void
  Assembler::jacobian(const double t,
                      const std::span<const double> u,
                      const std::span<const double> v,
                      const double sigma,
                      ChainMatrix &A)
  {
    kernels_.jacobian(input(t, u, v), sigma, A.blocks().data());
  }

  bool
  Assembler::velocity(const double t, const std::span<const double> u, const std::span<double> v)
  {
    if (!mass_)
      mass_ = std::make_unique<ChainMatrix>(discretization_);
    if (!residual(t, u, {}, v))
      return false;
    for (double &value : v)
      value = -value;
    kernels_.mass(input(t, u, {}), mass_->blocks().data());
    if (!mass_->factorize())
      return false;
    mass_->solve(v, v);
    return true;
  }

  CellIntegrals
  Assembler::integrals(const double t, const std::span<const double> u, const std::span<const double> v)
  {
    CellIntegrals sum;
    kernels_.integrals(input(t, u, v), sum);
    static_assert(sizeof(CellIntegrals) % sizeof(double) == 0);
    if (discretization_.n_ranks() == 1)
      return sum;
    MPI_Allreduce(
      MPI_IN_PLACE, &sum, sizeof(CellIntegrals) / sizeof(double), MPI_DOUBLE, MPI_SUM, discretization_.communicator());
    return sum;
  }

  StretchRange
  Assembler::stretch_range(const std::span<const double> u)
  {
    const auto local    = discretization_.to_local(u, u_local_);
    const auto &element = discretization_.element();
    const unsigned n = element.n, q = element.degree;
    constexpr double infinity = std::numeric_limits<double>::infinity();

    // Where the stretch is looked at in a cell, from left to right.
    const auto place = [&](const unsigned int i)
    {
      return i == 0 ? 0. : i == n + 1 ? 1. : element.points[i - 1];
    };
    const auto stretch_at = [&](const unsigned int c, const unsigned int i)
    {
      const double *derivatives = i == 0       ? element.left_derivatives.data()
                                  : i == n + 1 ? element.right_derivatives.data()
                                               : &element.derivatives[(i - 1) * n];
      double w                  = 0.;
      for (unsigned int j = 0; j < n; ++j)
        w += derivatives[j] * local[c * q + j];
      return 1. + w / discretization_.cell_size()[c];
    };

    struct Found
    {
      double w;
      unsigned int cell, i;
    };
    Found smallest{infinity, 0, 0}, largest{-infinity, 0, 0};
    for (unsigned int c = 0; c < discretization_.n_local_cells(); ++c)
      for (unsigned int i = 0; i < n + 2; ++i)
      {
        const double w = stretch_at(c, i);
        if (w < smallest.w || (std::isnan(w) && !std::isnan(smallest.w)))
          smallest = {w, c, i};
        if (w > largest.w)
          largest = {w, c, i};
      }

    // Inside a cell the parabola through the neighbours comes closer to the extreme than the sample.
    const auto sharpened = [&](const Found &found)
    {
      double x = place(found.i), w = found.w;
      if (discretization_.n_local_cells() == 0)
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
      return StretchAt{w, discretization_.cell_left()[found.cell] + discretization_.cell_size()[found.cell] * x};
    };
    return {reduce_minimum(sharpened(smallest), 1., discretization_),
            reduce_minimum(sharpened(largest), -1., discretization_)};
  }

  Resolution
  Assembler::resolution(const std::span<const double> u)
  {
    const auto local    = discretization_.to_local(u, u_local_);
    const auto &element = discretization_.element();
    const unsigned n = element.n, q = element.degree;
    double sums[2] = {0., 0.};
    for (unsigned int c = 0; c < discretization_.n_local_cells(); ++c)
    {
      const double h = discretization_.cell_size()[c];
      double mode = 0., strain = 0., smallest = std::numeric_limits<double>::infinity();
      for (unsigned int p = 0; p < n; ++p)
      {
        double e = 0.;
        for (unsigned int i = 0; i < n; ++i)
          e += element.derivatives[p * n + i] * local[c * q + i];
        e /= h;
        mode += highest_mode_[p] * e;
        strain += element.weights[p] * e * e;
        smallest = std::min(smallest, 1. + e);
      }
      sums[0] += h / (2. * q - 1.) * (mode / smallest) * (mode / smallest);
      sums[1] += h * strain;
    }
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, discretization_.communicator());
    return {sums[0], sums[1]};
  }

  double
  Assembler::root_mean_square(const std::span<const double> u) const
  {
    double sum = 0.;
    for (const double value : u)
      sum += value * value;
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, discretization_.communicator());
    return std::sqrt(sum / static_cast<double>(discretization_.n_unknowns()));
  }

  std::pair<double, double>
  Assembler::end_stress(const double t)
  {
    std::array<double, 2> m{};
    end_stress_->values(t, m);
    return {m[0], m[1]};
  }

  double
  Assembler::end_power(const double t, const std::span<const double> v)
  {
    const auto [m_left, m_right] = end_stress(t);
    double power                 = 0.;
    if (discretization_.rank() == 0)
      power -= m_left * v.front();
    if (discretization_.n_local() > 0 && !discretization_.has_right_neighbour())
      power += m_right * v.back();
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &power, 1, MPI_DOUBLE, MPI_SUM, discretization_.communicator());
    return power;
  }
} // namespace crawler
