// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/pack.h>

#include <cstddef>

/// Systems of the nodes between the cells (included by lane_systems.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Tridiagonal systems of the nodes between the cells, a real one and the complex ones of all pairs. They are gone
  /// through row by row together: their chains of operations do not wait for each other.
  template <typename Pack, int pairs>
  class LaneCorners
  {
  public:
    using Number = Complex<Pack>;

    LaneCorners(const int n_cells, const int q)
      : n_cells_(n_cells)
      , q_(q)
    {
    }

    void
    lay_out(LaneMemory &memory)
    {
      memory.pieces(4 * std::size_t(n_cells_), schur);
      memory.pieces(pairs * 4 * std::size_t(n_cells_), complex_schur);
      real_.lay_out(n_cells_ + 1, memory);
      for (Factors<Number> &one : complex_)
        one.lay_out(n_cells_ + 1, memory);
    }

    /// Factorizes the real matrix and the first @p n_pairs complex ones.
    void
    factorize(const int n_pairs) const
    {
      Pack diagonal;
      Number diagonals[pairs];
      for (int c = 0; c < n_cells_; ++c)
      {
        real_.factorize(c, n_cells_, schur, diagonal);
        for (int j = 0; j < n_pairs; ++j)
          complex_[j].factorize(c, n_cells_, complex_schur + 4 * j * n_cells_, diagonals[j]);
      }
    }

    /// Solves in the vectors of all nodes; @p y: those of @p n_pairs pairs, @p stride apart.
    void
    solve(Pack *x, Number *y, const int n_pairs, const int stride) const
    {
      const auto in_all = [&](const auto &use) {
        use(real_, x);
        for (int j = 0; j < n_pairs; ++j)
          use(complex_[j], y + j * stride);
      };
      const int N = n_cells_, q = q_;
      for (int c = 0; c < N; ++c)
        in_all([c, q](const auto &factors, auto *right) { factors.eliminate(c, q, right); });
      in_all([N, q](const auto &factors, auto *right) { right[N * q] *= factors.pivot[N]; });
      for (int c = N - 1; c >= 0; --c)
        in_all([c, q](const auto &factors, auto *right) { factors.substitute(c, q, right); });
    }

    Pack *schur;           ///< [cell][4] Schur complements, to be written before factorize()
    Number *complex_schur; ///< [pair][cell][4]

  private:
    /// Factors below the diagonal, 1/pivots, upper diagonal.
    template <typename Type>
    struct Factors
    {
      Type *lower, *pivot, *upper;

      void
      lay_out(const std::size_t n, LaneMemory &memory)
      {
        memory.pieces(n, lower, pivot, upper);
      }

      /// Row @p c from the Schur complements; @p diagonal goes on to the next row.
      void
      factorize(const int c, const int n_cells, const Type *schur, Type &diagonal) const
      {
        const Type *S = schur + 4 * c;
        if (c == 0)
          diagonal = S[0];
        pivot[c] = 1. / diagonal;
        upper[c] = S[1];
        lower[c] = S[2] * pivot[c];
        diagonal = S[3];
        diagonal -= lower[c] * upper[c];
        if (c + 1 < n_cells)
          diagonal += S[4];
        else
          pivot[n_cells] = 1. / diagonal;
      }

      void
      eliminate(const int c, const int q, Type *x) const
      {
        x[(c + 1) * q] -= lower[c] * x[c * q];
      }
      void
      substitute(const int c, const int q, Type *x) const
      {
        x[c * q] -= upper[c] * x[(c + 1) * q];
        x[c * q] *= pivot[c];
      }
    };

    const int n_cells_, q_;
    Factors<Pack> real_;
    Factors<Number> complex_[pairs];
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
