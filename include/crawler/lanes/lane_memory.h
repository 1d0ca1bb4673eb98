// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/instruction_set.h>

#include <cstddef>

/// Memory of the fused engine (included by radau_lanes.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// True if one of the lanes has this flag.
  template <typename Lane, int n>
  inline bool
  any(const Lane (&lanes)[n], const bool Lane::*flag)
  {
    for (const Lane &lane : lanes)
      if (lane.*flag)
        return true;
    return false;
  }

  /// Pieces of a memory, one after the other; without memory only their sizes are summed.
  class LaneMemory
  {
  public:
    explicit LaneMemory(double *memory)
      : memory_(memory)
    {
    }

    /// Places arrays of @p n elements, each at a multiple of 64 bytes.
    template <typename... Types>
    void
    pieces(const std::size_t n, Types *&...pointers)
    {
      (place(n, pointers), ...);
    }

    std::size_t
    size() const
    {
      return size_;
    }

  private:
    template <typename Type>
    void
    place(const std::size_t n, Type *&pointer)
    {
      pointer = memory_ != nullptr ? reinterpret_cast<Type *>(memory_ + size_) : nullptr;
      size_ += (n * sizeof(Type) / sizeof(double) + 7) / 8 * 8;
    }

    double *memory_;
    std::size_t size_ = 0;
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
