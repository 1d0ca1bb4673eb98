// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <petscvec.h>

#include <span>

namespace crawler
{
  /// Read access to the own part of a Vec, during its lifetime.
  class ReadAccess
  {
  public:
    explicit ReadAccess(Vec vec)
      : vec_(vec)
    {
      PetscInt n = 0;
      VecGetLocalSize(vec, &n);
      VecGetArrayRead(vec, &data_);
      span = {data_, static_cast<std::size_t>(n)};
    }
    ~ReadAccess()
    {
      VecRestoreArrayRead(vec_, &data_);
    }
    std::span<const double> span;

  private:
    Vec vec_;
    const double *data_ = nullptr;
  };

  /// Write access to the own part of a Vec, during its lifetime.
  class WriteAccess
  {
  public:
    explicit WriteAccess(Vec vec)
      : vec_(vec)
    {
      PetscInt n = 0;
      VecGetLocalSize(vec, &n);
      VecGetArray(vec, &data_);
      span = {data_, static_cast<std::size_t>(n)};
    }
    ~WriteAccess()
    {
      VecRestoreArray(vec_, &data_);
    }
    std::span<double> span;

  private:
    Vec vec_;
    double *data_ = nullptr;
  };
} // namespace crawler
