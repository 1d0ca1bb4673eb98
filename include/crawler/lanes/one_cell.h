// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/point_laws.h>
#include <crawler/lanes/pack.h>

#include <cstddef>

/// Cells that the kernels compute together, if these are one of each body (included by lane_kernel_table.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Parts of the laws of general bodies that a kernel uses.
  struct Wanted
  {
    static constexpr unsigned int forces = 1, slopes = 2, energies = 4;
  };

  /// One cell of each body of a pack. An array has Numbers, the kernels compute with Values.
  template <typename Pack>
  struct OneCell
  {
    static constexpr int width = 1, n = 1;
    using Number = Pack;
    using Value  = Pack;
    template <typename Type>
    using Of = Type;

    const int first; ///< number of the cell

    OneCell(const int first, const int)
      : first(first)
    {
    }

    Pack
    numbers() const
    {
      return broadcast<Pack>(first);
    }

    template <typename Type>
    Type
    load(const Type *values, const int stride, const int i) const
    {
      return values[first * stride + i];
    }

    template <typename Type>
    void
    store(const Type &value, Type *values, const int stride, const int i) const
    {
      values[first * stride + i] = value;
    }

    template <typename Type>
    static const Type &
    of_lane(const Type &value, const int)
    {
      return value;
    }
    template <typename Type>
    static const Type &
    in_all_lanes(const Type &value)
    {
      return value;
    }
    template <typename Type>
    static const Type &
    over_lanes(const Type &value)
    {
      return value;
    }

    template <int n>
    struct Elements
    {
      const Pack *begin;

      Elements(const OneCell &cell, const Pack *all, const int stride)
        : begin(all != nullptr ? all + cell.first * stride : nullptr)
      {
      }
    };

    template <typename Type, int stride>
    struct Nodes
    {
      Type *const values;

      Nodes(const OneCell &cell, Type *all)
        : values(all + cell.first * stride)
      {
      }
      void
      load(const int, const int)
      {
      }
      void
      store(const int, const int)
      {
      }
    };

    template <int n, unsigned int>
    struct Laws
    {
      const PointLaws<Pack> &laws;
      std::size_t first;

      Laws(const PointLaws<Pack> &all, const OneCell &cell)
        : laws(all)
        , first(static_cast<std::size_t>(cell.first) * n)
      {
      }
    };
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
