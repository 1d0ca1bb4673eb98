// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_mesh.h>
#include <crawler/lanes/one_cell.h>

#include <cstddef>

/// Cells of one body in the lanes of a pack (included by lane_kernel_table.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  using Cells = CRAWLER_PACK;

  /// Pack of cells in the place of numbers of one cell.
  template <typename Number>
  struct CellsOf;
  template <>
  struct CellsOf<double>
  {
    using Type = Cells;
  };
  template <>
  struct CellsOf<Complex<double>>
  {
    using Type = Complex<Cells>;
  };

  /// Some neighbouring cells of one body, one in each lane. Lanes beyond the last cell of the mesh repeat it, and
  /// nothing is written from them.
  struct CellGroup
  {
    static constexpr int width = PackTraits<Cells>::size;
    using Number               = double;
    using Value                = Cells;
    template <typename Type>
    using Of = typename CellsOf<Type>::Type;

    const int first, n; ///< number of the first cell, and of cells

    CellGroup(const int first, const int n_cells)
      : first(first)
      , n(n_cells - first < width ? n_cells - first : width)
    {
    }

    /// Number of the cell of each lane.
    Cells
    numbers() const
    {
      Cells result;
      for (int l = 0; l < width; ++l)
        result[l] = first + (l < n ? l : n - 1);
      return result;
    }

    /// Element @p i of what @p values has @p stride of for each cell.
    Cells
    load(const double *values, const int stride, const int i) const
    {
      values += first * stride + i;
      Cells result;
      if (n == width)
        for (int l = 0; l < width; ++l)
          result[l] = values[l * stride];
      else
        for (int l = 0; l < width; ++l)
          result[l] = values[(l < n ? l : n - 1) * stride];
      return result;
    }
    Complex<Cells>
    load(const Complex<double> *values, const int stride, const int i) const
    {
      const double *parts = &values->re;
      return {load(parts, 2 * stride, 2 * i), load(parts, 2 * stride, 2 * i + 1)};
    }

    void
    store(const Cells &some, double *values, const int stride, const int i) const
    {
      values += first * stride + i;
      if (n == width)
        for (int l = 0; l < width; ++l)
          values[l * stride] = some[l];
      else
        for (int l = 0; l < n; ++l)
          values[l * stride] = some[l];
    }
    void
    store(const Complex<Cells> &some, Complex<double> *values, const int stride, const int i) const
    {
      double *parts = &values->re;
      store(some.re, parts, 2 * stride, 2 * i);
      store(some.im, parts, 2 * stride, 2 * i + 1);
    }

    /// Sums at the first nodes, which are the last ones of the cells before, from @p F and the sums at the last nodes.
    Cells
    sums_of_left(const double *F, const int stride, const Cells &last) const
    {
      Cells sums;
      sums[0] = first == 0 ? 0. : F[first * stride];
      for (int l = 1; l < width; ++l)
        sums[l] = last[l - 1];
      return sums;
    }

    static double
    of_lane(const Cells &value, const int l)
    {
      return value[l];
    }

    /// Number or friction law of a body for its cells.
    static Cells
    in_all_lanes(const double one)
    {
      return broadcast<Cells>(one);
    }
    static LaneFriction<Cells>
    in_all_lanes(const LaneFriction<double> &one)
    {
      LaneFriction<Cells> all;
      const auto mask = [](const bool is) { return broadcast<Cells>(is) > 0.; };
      all.a           = broadcast<Cells>(one.a);
      all.whole       = mask(one.whole);
      all.negative    = mask(one.negative);
      for (int b = 0; b < one.max_bits; ++b)
        all.bits[b] = mask(one.bits[b]);
      all.any_whole = one.any_whole;
      all.any_other = one.any_other;
      all.n_bits    = one.n_bits;
      return all;
    }

    /// Extremes among all cells; of equal stretches the first one counts.
    static LaneExtremes<double>
    over_lanes(const LaneExtremes<Cells> &all)
    {
      LaneExtremes<double> result;
      for (int l = 0; l < width; ++l)
      {
        const double low = all.least[l], high = all.most[l];
        if (low < result.least || (low == result.least && all.min_at[l] < result.min_at))
        {
          result.least  = low;
          result.min_at = all.min_at[l];
        }
        if (high > result.most || (high == result.most && all.max_at[l] < result.max_at))
        {
          result.most   = high;
          result.max_at = all.max_at[l];
        }
      }
      return result;
    }
    /// Smallest of the numbers of all cells.
    static double
    over_lanes(const Cells &all)
    {
      double result = HUGE_VAL;
      for (int l = 0; l < width; ++l)
        result = smaller(all[l], result);
      return result;
    }

    /// Elements of an array that has @p stride of them for each cell, the first @p n; null if there is no array.
    template <int n>
    struct Elements
    {
      Cells values[n];
      const Cells *begin;

      Elements(const CellGroup &group, const double *all, const int stride)
        : begin(all != nullptr ? values : nullptr)
      {
        for (int i = 0; all != nullptr && i < n; ++i)
          values[i] = group.load(all, stride, i);
      }
    };

    /// Elements of an array that are changed, from @p begin to before @p end at a time.
    template <typename Type, int stride>
    struct Nodes
    {
      Of<Type> values[stride + 1];

      Nodes(const CellGroup &group, Type *all)
        : group_(group)
        , all_(all)
      {
      }
      void
      load(const int begin, const int end)
      {
        for (int i = begin; i < end; ++i)
          values[i] = group_.load(all_, stride, i);
      }
      void
      store(const int begin, const int end)
      {
        for (int i = begin; i < end; ++i)
          group_.store(values[i], all_, stride, i);
      }

    private:
      const CellGroup &group_;
      Type *const all_;
    };

    /// PointLaws of the cells, as far as they are @p wanted.
    template <int n, unsigned int wanted>
    struct Laws
    {
      static constexpr std::size_t first = 0;
      Cells values[9][n];
      PointLaws<Cells> laws{};

      Laws(const PointLaws<double> &all, const CellGroup &group)
      {
        if constexpr ((wanted & Wanted::forces) != 0)
        {
          laws.N = load(all.N, group, 0);
          laws.f = load(all.f, group, 1);
        }
        if constexpr ((wanted & Wanted::slopes) != 0)
        {
          laws.f_u    = load(all.f_u, group, 2);
          laws.f_v    = load(all.f_v, group, 3);
          laws.w_f_w  = load(all.w_f_w, group, 4);
          laws.N_w    = load(all.N_w, group, 5);
          laws.N_rate = load(all.N_rate, group, 6);
        }
        if constexpr ((wanted & Wanted::energies) != 0)
        {
          laws.k = load(all.k, group, 7);
          laws.m = load(all.m, group, 8);
        }
      }

      Cells *
      load(const double *from, const CellGroup &group, const int i)
      {
        for (int p = 0; from != nullptr && p < n; ++p)
          values[i][p] = group.load(from, n, p);
        return from != nullptr ? values[i] : nullptr;
      }
    };
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
