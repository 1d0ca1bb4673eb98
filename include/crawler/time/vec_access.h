// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <petscvec.h>

#include <span>
#include <type_traits>

namespace crawler
{
  /// Access to the own part of a Vec, during its lifetime; only to read if Value is const.
  template <typename Value>
  class VecAccess
  {
  public:
    explicit VecAccess(Vec vec)
      : vec_(vec)
    {
      PetscInt n = 0;
      VecGetLocalSize(vec, &n);
      if constexpr (std::is_const_v<Value>)
        VecGetArrayRead(vec, &data_);
      else
        VecGetArray(vec, &data_);
      span = {data_, static_cast<std::size_t>(n)};
    }
    ~VecAccess()
    {
      if constexpr (std::is_const_v<Value>)
        VecRestoreArrayRead(vec_, &data_);
      else
        VecRestoreArray(vec_, &data_);
    }
    std::span<Value> span;

  private:
    Vec vec_;
    Value *data_ = nullptr;
  };

  using ReadAccess  = VecAccess<const double>;
  using WriteAccess = VecAccess<double>;
} // namespace crawler
