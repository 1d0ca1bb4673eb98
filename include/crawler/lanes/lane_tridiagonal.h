// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/pack.h>

#include <cstddef>

/// Tridiagonal systems of the Radau methods (included by lane_systems.h and lane_stretch.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Tridiagonal matrices, a real one and the complex ones of all pairs. All are eliminated together and from both ends
  /// to the middle: these chains of operations do not wait for each other.
  template <typename Pack, int pairs>
  class LaneTridiagonal
  {
  public:
    using Number = Complex<Pack>;

    /// Row: its entries below, on and above the diagonal. Once factorized: multiples of the row before and of the row
    /// after on the way to the middle, and 1/pivot; for the way back the factor needed then, times the pivot.
    template <typename Type>
    struct Row
    {
      Type before, pivot, after;
    };

    /// @p n rows; their unknowns are @p stride apart in the vectors.
    explicit LaneTridiagonal(const int n, const int stride = 1)
      : n_(n)
      , middle_(n / 2)
      , stride_(stride)
    {
    }

    void
    lay_out(LaneMemory &memory)
    {
      const std::size_t n = n_;
      memory.pieces(n, real);
      for (Row<Number> *&rows : complex)
        memory.pieces(n, rows);
    }

    /// Factorizes the real matrix and the first @p n_pairs complex ones.
    void
    factorize(const int n_pairs) const
    {
      to_the_middle([&](const int from, const int to) {
        eliminate(real[from], real[to], to > from);
        for (int p = 0; p < n_pairs; ++p)
          eliminate(complex[p][from], complex[p][to], to > from);
      });
      real[middle_].pivot = 1. / real[middle_].pivot;
      for (int p = 0; p < n_pairs; ++p)
        complex[p][middle_].pivot = 1. / complex[p][middle_].pivot;
    }

    /// @p y: right-hand sides of all pairs, @p distance apart; null: the real system alone.
    void
    solve(Pack *x, Number *y, const int distance) const
    {
      const int n_pairs = y != nullptr ? pairs : 0;
      const auto in_all = [&](const auto &use) {
        use(real, x);
        for (int p = 0; p < n_pairs; ++p)
          use(complex[p], y + p * distance);
      };
      to_the_middle([&](const int from, const int to) {
        in_all([=, q = stride_](const auto *rows, auto *right) {
          right[to * q] -= (to > from ? rows[to].before : rows[to].after) * right[from * q];
        });
      });
      in_all([m = middle_, q = stride_](const auto *rows, auto *right) { right[m * q] *= rows[m].pivot; });
      const auto substitute = [&](const int at, const int next) {
        in_all([=, q = stride_](const auto *rows, auto *right) {
          auto own = rows[at].pivot * right[at * q];
          own -= (next > at ? rows[at].after : rows[at].before) * right[next * q];
          right[at * q] = own;
        });
      };
      for (int i = 1; middle_ - i >= 0 || middle_ + i < n_; ++i)
      {
        if (middle_ - i >= 0)
          substitute(middle_ - i, middle_ - i + 1);
        if (middle_ + i < n_)
          substitute(middle_ + i, middle_ + i - 1);
      }
    }

    Row<Pack> *real;             ///< to be written before factorize()
    Row<Number> *complex[pairs]; ///< the same

  private:
    /// Eliminates a row from the next one towards the middle, which is behind it (@p down) or before it.
    template <typename Type>
    static void
    eliminate(Row<Type> &row, Row<Type> &next, const bool down)
    {
      Type &to_next = down ? row.after : row.before, &to_row = down ? next.before : next.after;
      row.pivot = 1. / row.pivot;
      to_next   = to_next * row.pivot;
      next.pivot -= to_row * to_next;
      to_row = to_row * row.pivot;
    }

    /// Applies @p step to the rows from the first and from the last one to the middle, in turns.
    template <typename Step>
    void
    to_the_middle(const Step &step) const
    {
      for (int i = 0; i < middle_ || n_ - 1 - i > middle_; ++i)
      {
        if (i < middle_)
          step(i, i + 1);
        if (n_ - 1 - i > middle_)
          step(n_ - 1 - i, n_ - 2 - i);
      }
    }

    const int n_, middle_, stride_;
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
