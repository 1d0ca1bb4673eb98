// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/discretization/mesh_transfer.h>

#include <cmath>
#include <map>

namespace crawler
{
  namespace
  {
    std::vector<double>
    half(std::vector<double> places, const unsigned int which)
    {
      for (double &x : places)
        x = 0.5 * (x + which);
      return places;
    }

    /// The integral from 0 to x of the Legendre polynomial P_k(2 x - 1).
    double
    integrated_legendre(const unsigned int k, const double x)
    {
      const double z = 2. * x - 1.;
      return k == 0 ? x : (std::legendre(k + 1, z) - std::legendre(k - 1, z)) / (2. * (2. * k + 1.));
    }

    /// y = matrix x, both of one cell.
    void
    apply(const std::vector<double> &matrix,
          const double *x,
          const unsigned int columns,
          double *y,
          const unsigned int rows)
    {
      for (unsigned int i = 0; i < rows; ++i)
      {
        double sum = 0.;
        for (unsigned int j = 0; j < columns; ++j)
          sum += matrix[i * columns + j] * x[j];
        y[i] = sum;
      }
    }

    /// int u ds over the whole mesh.
    double
    integral(const std::vector<double> &u, const std::vector<Cell> &cells, const ReferenceElement &element)
    {
      double sum = 0.;
      for (std::size_t c = 0; c < cells.size(); ++c)
        for (unsigned int i = 0; i < element.n; ++i)
          sum += cells[c].size * element.node_weights[i] * u[c * element.degree + i];
      return sum;
    }
  } // namespace

  MeshTransfer::MeshTransfer(const ReferenceElement &element)
    : element_(element)
  {
    const unsigned int n = element.n, q = element.degree;
    for (const unsigned int which : {0u, 1u})
    {
      u_half_[which]   = interpolation_matrix(element.nodes, half(element.nodes, which));
      log_half_[which] = interpolation_matrix(element.stretch_points, half(element.stretch_points, which));
    }

    // Joining: Legendre coefficients of the stretch, and of log w, over the whole cell.
    u_join_.assign(n * (2 * q + 1), 0.);
    log_join_.assign(q * 2 * q, 0.);
    for (unsigned int i = 0; i < n; ++i)
      u_join_[i * (2 * q + 1)] = 1.; // u at the left end, plus the integral of the stretch
    const std::vector<double> log_at_points = interpolation_matrix(element.stretch_points, element.points);
    for (unsigned int k = 0; k < q; ++k)
      for (const unsigned int which : {0u, 1u})
        for (unsigned int p = 0; p < n; ++p)
        {
          const double x           = 0.5 * (element.points[p] + which);
          const double coefficient = (2. * k + 1.) * 0.5 * element.weights[p] * std::legendre(k, 2. * x - 1.);
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int j = 0; j < n; ++j)
              u_join_[i * (2 * q + 1) + which * q + j] +=
                integrated_legendre(k, element.nodes[i]) * coefficient * 2. * element.derivatives[p * n + j];
          for (unsigned int i = 0; i < q; ++i)
            for (unsigned int j = 0; j < q; ++j)
              log_join_[i * 2 * q + which * q + j] +=
                std::legendre(k, 2. * element.stretch_points[i] - 1.) * coefficient * log_at_points[p * q + j];
        }
  }

  std::vector<double>
  MeshTransfer::transfer(const Assembler &from, const std::span<const double> y, const Assembler &to) const
  {
    const unsigned int n = element_.n, q = element_.degree;
    const bool to_log     = to.formulation() == Formulation::log_stretch,
               was_log    = from.formulation() == Formulation::log_stretch;
    const auto &old_cells = from.discretization().cells(), &new_cells = to.discretization().cells();
    const std::vector<double> u_old = from.discretization().gather(from.displacement(y));
    std::vector<double> log_old     = from.discretization().gather(from.log_stretch(y));
    if (to_log && !was_log)
    {
      log_old.resize(old_cells.size() * q);
      for (std::size_t c = 0; c < old_cells.size(); ++c)
        for (unsigned int p = 0; p < q; ++p)
        {
          double e = 0.;
          for (unsigned int i = 0; i < n; ++i)
            e += element_.stretch_derivatives[p * n + i] * u_old[c * q + i];
          log_old[c * q + p] = std::log1p(e / old_cells[c].size);
        }
    }

    const auto length = [&](const double *log_w, const double h)
    {
      double sum = 0.;
      for (unsigned int p = 0; p < q; ++p)
        sum += h * element_.stretch_weights[p] * std::exp(log_w[p]);
      return sum;
    };
    const auto shift = [&](double *log_w, const unsigned int size, const double by)
    {
      for (unsigned int p = 0; p < size; ++p)
        log_w[p] += by;
    };

    std::vector<double> u(new_cells.size() * q + 1), log_w(to_log ? new_cells.size() * q : 0);
    for (std::size_t c = 0, old = 0; c < new_cells.size();)
    {
      const double *u_of = &u_old[old * q], *log_of = to_log ? &log_old[old * q] : nullptr;
      double *u_to = &u[c * q], *log_to = to_log ? &log_w[c * q] : nullptr;
      const double h = new_cells[c].size;
      if (new_cells[c].level == old_cells[old].level)
      {
        std::copy(u_of, u_of + n, u_to);
        if (to_log)
          std::copy(log_of, log_of + q, log_to);
        ++c;
        ++old;
      }
      else if (new_cells[c].level > old_cells[old].level)
      {
        for (const unsigned int which : {0u, 1u})
        {
          apply(u_half_[which], u_of, n, u_to + which * q, n);
          if (to_log)
            apply(log_half_[which], log_of, q, log_to + which * q, q);
        }
        u_to[0]     = u_of[0];
        u_to[2 * q] = u_of[q];
        if (to_log)
          shift(log_to, 2 * q, std::log(length(log_of, 2. * h) / (length(log_to, h) + length(log_to + q, h))));
        c += 2;
        ++old;
      }
      else
      {
        apply(u_join_, u_of, 2 * q + 1, u_to, n);
        u_to[0] = u_of[0];
        u_to[q] = u_of[2 * q];
        if (to_log)
        {
          apply(log_join_, log_of, 2 * q, log_to, q);
          shift(log_to, q, std::log((length(log_of, 0.5 * h) + length(log_of + q, 0.5 * h)) / length(log_to, h)));
        }
        ++c;
        old += 2;
      }
    }
    const double missing =
      (integral(u_old, old_cells, element_) - integral(u, new_cells, element_)) / to.discretization().length();
    for (double &value : u)
      value += missing;

    // This rank's part.
    const Discretization &d = to.discretization();
    std::vector<double> result;
    result.reserve(to.n_owned());
    const auto first_cell = static_cast<std::ptrdiff_t>(d.first_cell()), cell_q = static_cast<std::ptrdiff_t>(q);
    const auto first_node = u.begin() + first_cell * cell_q + (d.has_left_neighbour() ? 1 : 0);
    result.insert(result.end(), first_node, first_node + static_cast<std::ptrdiff_t>(d.n_owned()));
    if (to_log)
    {
      const auto first_log = log_w.begin() + first_cell * cell_q;
      result.insert(result.end(), first_log, first_log + static_cast<std::ptrdiff_t>(d.n_local_cells()) * cell_q);
    }
    result.resize(to.n_owned(), 0.);
    return result;
  }

  const MeshTransfer &
  mesh_transfer(const unsigned int degree)
  {
    static std::map<unsigned int, const MeshTransfer> transfers;
    return transfers.try_emplace(degree, reference_element(degree)).first->second;
  }
} // namespace crawler
