// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/mesh/block_tridiagonal_kernels.h>
#include <crawler/mesh/block_tridiagonal_matrix.h>

#include <algorithm>

namespace crawler
{
  namespace
  {
    /// Number of doubles in a number.
    template <typename Number>
    constexpr int doubles_in = sizeof(Number) / sizeof(double);
  } // namespace

  template <typename Number>
  BlockTridiagonalMatrix<Number>::BlockTridiagonalMatrix(const Discretization &discretization)
    : discretization_(&discretization)
  {
    const std::size_t n_cells = discretization.n_local_cells(), n = discretization.element.n;
    blocks.resize(n_cells * n * n);
    schur_.resize(n_cells * 4);
    for (auto *array : {&inverse_, &row_zero_, &column_zero_, &next_, &below_})
      array->resize(n_cells + 1);
    reduced_.resize(4 * discretization.n_active_ranks);
    reduced_rhs_.resize(discretization.n_active_ranks + 1);
  }

  template <>
  void
  BlockTridiagonalMatrix<double>::multiply(const std::span<const double> x, const std::span<double> y) const
  {
    const auto &d    = *discretization_;
    const auto local = d.to_local(x, x_local_);
    local_.assign(d.n_local(), 0.);
    block_tridiagonal_kernels<double>(d.element.degree)
      .multiply(d.n_local_cells(), blocks.data(), local.data(), local_.data());
    d.add_to_owned(local_, y);
  }

  template <typename Number>
  bool
  BlockTridiagonalMatrix<Number>::factorize()
  {
    const auto &d        = *discretization_;
    const unsigned int n = d.n_local_cells();
    factors_             = blocks;
    bool ok = block_tridiagonal_kernels<Number>(d.element.degree).condense(n, factors_.data(), schur_.data());

    Number corner = 1., row = 0., column = 0., diagonal = 1.; // of a rank without cells
    if (n > 0)
    {
      // Node i couples to node 0 (row_zero, column_zero), and to node i+1 (next above, below under the diagonal).
      corner   = schur_[0];
      row      = schur_[1]; // A[0][i] for i = 1
      column   = schur_[2]; // A[i][0]
      diagonal = schur_[3];
      for (unsigned int i = 1; i < n; ++i)
      {
        const Number *S = &schur_[4 * i];
        diagonal += S[0];
        ok                   = ok && diagonal != 0. && is_finite(diagonal);
        const Number inverse = 1. / diagonal;
        inverse_[i]          = inverse;
        row_zero_[i]         = row * inverse;
        column_zero_[i]      = column * inverse;
        next_[i]             = S[1] * inverse;
        below_[i]            = S[2] * inverse;
        corner -= row_zero_[i] * column;
        diagonal              = S[3] - below_[i] * S[1];
        const Number next_row = -row_zero_[i] * S[1];
        column                = -below_[i] * column;
        row                   = next_row;
      }
    }
    const unsigned int ranks = d.n_active_ranks;
    if (d.n_ranks == 1)
    {
      reduced_ = {corner, row, column, diagonal};
      return ok && is_finite(corner) && is_finite(diagonal);
    }
    // Ranks without cells send numbers that are not read.
    Number sent[5] = {corner, row, column, diagonal, ok ? Number(1.) : Number(0.)};
    std::vector<Number> all(5 * d.n_ranks);
    MPI_Allgather(
      sent, 5 * doubles_in<Number>, MPI_DOUBLE, all.data(), 5 * doubles_in<Number>, MPI_DOUBLE, d.communicator);
    for (unsigned int r = 0; r < ranks; ++r)
    {
      std::copy(&all[5 * r], &all[5 * r] + 4, reduced_.begin() + 4 * r);
      ok = ok && all[5 * r + 4] == 1. && is_finite(all[5 * r]) && is_finite(all[5 * r + 3]);
    }
    return ok;
  }

  /// Solves the system of the shared nodes 0 ... ranks, the same on every rank: returns the values at the first and
  /// last node of the own cells, from their remaining right-hand sides.
  template <typename Number>
  std::pair<Number, Number>
  BlockTridiagonalMatrix<Number>::solve_shared(const Number first, const Number last) const
  {
    const auto &d            = *discretization_;
    const unsigned int ranks = d.n_active_ranks;
    if (ranks == 1)
    {
      const Number *S = reduced_.data();
      // Elimination of the first node; the sum of both rows keeps the digits when the friction term is small.
      const Number factor = S[2] / S[0];
      const Number x_last = (last - factor * first) / (S[3] - factor * S[1]);
      return {(first - S[1] * x_last) / S[0], x_last};
    }
    const Number sent[2] = {first, last};
    std::vector<Number> all(2 * d.n_ranks), diagonal(ranks + 1, 0.);
    MPI_Allgather(
      sent, 2 * doubles_in<Number>, MPI_DOUBLE, all.data(), 2 * doubles_in<Number>, MPI_DOUBLE, d.communicator);
    std::fill(reduced_rhs_.begin(), reduced_rhs_.end(), 0.);
    for (unsigned int r = 0; r < ranks; ++r)
    {
      reduced_rhs_[r] += all[2 * r];
      reduced_rhs_[r + 1] += all[2 * r + 1];
      diagonal[r] += reduced_[4 * r];
      diagonal[r + 1] += reduced_[4 * r + 3];
    }
    for (unsigned int r = 0; r < ranks; ++r)
    {
      const Number factor = reduced_[4 * r + 2] / diagonal[r];
      diagonal[r + 1] -= factor * reduced_[4 * r + 1];
      reduced_rhs_[r + 1] -= factor * reduced_rhs_[r];
    }
    reduced_rhs_[ranks] /= diagonal[ranks];
    for (unsigned int r = ranks; r-- > 0;)
      reduced_rhs_[r] = (reduced_rhs_[r] - reduced_[4 * r + 1] * reduced_rhs_[r + 1]) / diagonal[r];
    if (d.n_local_cells() == 0)
      return {0., 0.};
    return {reduced_rhs_[d.rank], reduced_rhs_[d.rank + 1]};
  }

  template <typename Number>
  void
  BlockTridiagonalMatrix<Number>::solve(const std::span<const Number> b, const std::span<Number> x) const
  {
    const auto &d        = *discretization_;
    const auto &kernels  = block_tridiagonal_kernels<Number>(d.element.degree);
    const unsigned int n = d.n_local_cells(), q = d.element.degree, ranks = d.n_active_ranks;
    const bool shared_first = d.has_left_neighbour();

    // Work on the local array; the right-hand side of a shared node stays with its owner.
    const bool direct = ranks == 1;
    if (direct)
    {
      if (x.data() != b.data())
        std::copy(b.begin(), b.end(), x.begin());
    }
    else
    {
      local_.resize(d.n_local());
      if (n > 0)
      {
        local_[0] = 0.;
        std::copy(b.begin(), b.end(), local_.begin() + (shared_first ? 1 : 0));
      }
    }
    Number *y = direct ? x.data() : local_.data();

    kernels.forward(n, factors_.data(), y);
    Number first = n > 0 ? y[0] : 0.;
    for (unsigned int i = 1; i < n; ++i)
    {
      const Number r = y[i * q];
      first -= row_zero_[i] * r;
      y[(i + 1) * q] -= below_[i] * r;
    }
    const Number last = n > 0 ? y[static_cast<std::size_t>(n) * q] : 0.;

    const auto [x_first, x_last] = solve_shared(first, last);
    if (n == 0)
      return;

    y[0]                               = x_first;
    y[static_cast<std::size_t>(n) * q] = x_last;
    for (unsigned int i = n - 1; i >= 1; --i)
      y[i * q] = y[i * q] * inverse_[i] - column_zero_[i] * x_first - next_[i] * y[(i + 1) * q];
    kernels.backward(n, factors_.data(), y);
    if (!direct)
      std::copy(local_.begin() + (shared_first ? 1 : 0), local_.end(), x.begin());
  }

  template class BlockTridiagonalMatrix<double>;
  template class BlockTridiagonalMatrix<std::complex<double>>;
} // namespace crawler
