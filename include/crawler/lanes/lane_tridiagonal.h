// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/lane_mesh.h>
#include <crawler/lanes/pack.h>

#include <cstddef>

/// Tridiagonal systems of the Radau methods for one body (included by lane_stretch.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Tridiagonal matrices K + g M with a real g and with the complex ones of all pairs. All are eliminated together and
  /// from both ends to the middle: these chains of operations do not wait for each other.
  template <typename Pack, int pairs>
  class LaneTridiagonal
  {
  public:
    using Number = Complex<Pack>;

    /// Entries of K and M below, on and above the diagonal.
    struct Row
    {
      Pack K[3], M[3];
    };

    explicit LaneTridiagonal(const int n)
      : n_(n)
      , middle_(n / 2)
    {
    }

    void
    lay_out(LaneMemory &memory)
    {
      const std::size_t n = n_;
      memory.pieces(n, rows_, real_);
      for (Factors<Number> *&factors : complex_)
        memory.pieces(n, factors);
    }

    Row &
    row(const int j)
    {
      return rows_[j];
    }

    /// Factorizes the rows; M is the identity unless @p has_M.
    void
    factorize(const LaneShifts<Pack, pairs> &shifts, const bool has_M)
    {
      for (int j = 0; j < n_; ++j)
      {
        real_[j] = shifted(rows_[j], shifts.real, has_M);
        for (int p = 0; p < pairs; ++p)
          complex_[p][j] = shifted(rows_[j], shifts.complex[p], has_M);
      }
      to_the_middle([this](const int from, const int to) {
        eliminate(real_[from], real_[to], to > from);
        for (int p = 0; p < pairs; ++p)
          eliminate(complex_[p][from], complex_[p][to], to > from);
      });
      real_[middle_].pivot = 1. / real_[middle_].pivot;
      for (int p = 0; p < pairs; ++p)
        complex_[p][middle_].pivot = 1. / complex_[p][middle_].pivot;
    }

    /// @p y: right-hand sides of all pairs, @p stride apart; null: the real system alone.
    void
    solve(Pack *x, Number *y, const int stride) const
    {
      const int n_pairs = y != nullptr ? pairs : 0;
      to_the_middle([&](const int from, const int to) {
        x[to] -= (to > from ? real_[to].before : real_[to].after) * x[from];
        for (int p = 0; p < n_pairs; ++p)
        {
          const Factors<Number> &row = complex_[p][to];
          y[p * stride + to] -= (to > from ? row.before : row.after) * y[p * stride + from];
        }
      });
      x[middle_] *= real_[middle_].pivot;
      for (int p = 0; p < n_pairs; ++p)
        y[p * stride + middle_] *= complex_[p][middle_].pivot;
      const auto substitute = [&](const int at, const int next) {
        x[at] = x[at] * real_[at].pivot - (next > at ? real_[at].after : real_[at].before) * x[next];
        for (int p = 0; p < n_pairs; ++p)
        {
          const Factors<Number> &row = complex_[p][at];
          Number own                 = row.pivot * y[p * stride + at];
          own -= (next > at ? row.after : row.before) * y[p * stride + next];
          y[p * stride + at] = own;
        }
      };
      for (int i = 1; middle_ - i >= 0 || middle_ + i < n_; ++i)
      {
        if (middle_ - i >= 0)
          substitute(middle_ - i, middle_ - i + 1);
        if (middle_ + i < n_)
          substitute(middle_ + i, middle_ + i - 1);
      }
    }

  private:
    /// Row and then its factors: multiples of the row before and of the row after on the way to the middle, and
    /// 1/pivot; for the way back the factor needed then, times the pivot.
    template <typename Type>
    struct Factors
    {
      Type before, pivot, after;
    };

    static Factors<Pack>
    shifted(const Row &row, const Pack &shift, const bool has_M)
    {
      if (has_M)
        return {row.K[0] + shift * row.M[0], row.K[1] + shift * row.M[1], row.K[2] + shift * row.M[2]};
      return {row.K[0], row.K[1] + shift, row.K[2]};
    }

    static Factors<Number>
    shifted(const Row &row, const Number &shift, const bool has_M)
    {
      if (has_M)
        return {{row.K[0] + shift.re * row.M[0], shift.im * row.M[0]},
                {row.K[1] + shift.re * row.M[1], shift.im * row.M[1]},
                {row.K[2] + shift.re * row.M[2], shift.im * row.M[2]}};
      return {{row.K[0], Pack{}}, {row.K[1] + shift.re, shift.im}, {row.K[2], Pack{}}};
    }

    /// Eliminates a row from the next one towards the middle, which is behind it (@p down) or before it.
    template <typename Type>
    static void
    eliminate(Factors<Type> &row, Factors<Type> &next, const bool down)
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

    const int n_, middle_;
    Row *rows_;
    Factors<Pack> *real_;
    Factors<Number> *complex_[pairs];
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
