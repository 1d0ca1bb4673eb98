// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/point_laws.h>
#include <crawler/lanes/lane_friction.h>
#include <crawler/lanes/pack.h>

/// Cells of one body in the lanes of a pack (included by group_kernels.h).
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

  /// Some neighbouring cells of a mesh, one in each lane. Lanes beyond the last cell of the mesh repeat it, and nothing
  /// is written from them.
  struct CellGroup
  {
    static constexpr int width = PackTraits<Cells>::size;

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
  };

  /// Friction law of a body for its cells.
  inline LaneFriction<Cells>
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

  /// Parts of the laws of general bodies that a kernel uses.
  struct Wanted
  {
    static constexpr unsigned int forces = 1, slopes = 2, energies = 4;
  };

  /// PointLaws of a group of cells.
  template <int n, unsigned int wanted>
  struct GroupLaws
  {
    Cells values[9][n];
    PointLaws<Cells> laws{};

    GroupLaws(const PointLaws<double> &all, const CellGroup &group)
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

  /// Values at the nodes of the cells of a group; null if there are none.
  template <int q>
  struct Nodal
  {
    static constexpr int n = q + 1;
    Cells values[n];
    const Cells *begin;

    Nodal(const CellGroup &group, const double *all)
      : begin(all != nullptr ? values : nullptr)
    {
      for (int i = 0; all != nullptr && i < n; ++i)
        values[i] = group.load(all, q, i);
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
