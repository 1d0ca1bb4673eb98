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

    /// Places an array at a multiple of 64 bytes.
    template <typename Type>
    void
    piece(Type *&pointer, const std::size_t n)
    {
      pointer = memory_ != nullptr ? reinterpret_cast<Type *>(memory_ + size_) : nullptr;
      size_ += (n * sizeof(Type) / sizeof(double) + 7) / 8 * 8;
    }

    std::size_t
    size() const
    {
      return size_;
    }

  private:
    double *memory_;
    std::size_t size_ = 0;
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
