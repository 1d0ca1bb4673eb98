// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <petscts.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace crawler
{
  /// Throws std::runtime_error with PETSc's own words if @p code is an error.
  inline void
  petsc(const PetscErrorCode code)
  {
    if (code == 0)
      return;
    const char *text = nullptr;
    PetscErrorMessage(code, &text, nullptr);
    throw std::runtime_error("PETSc error " + std::to_string(code) + ": " +
                             (text != nullptr ? text : "without a message"));
  }

  /// Destroys one reference to a PETSc object.
  template <typename Handle>
  struct PetscDestroy
  {
    void
    operator()(Handle handle) const
    {
      auto object = reinterpret_cast<PetscObject>(handle);
      PetscObjectDestroy(&object);
    }
  };

  /// Owns a reference to a PETSc object (Vec, Mat, TS, ...).
  template <typename Handle>
  using PetscOwner = std::unique_ptr<std::remove_pointer_t<Handle>, PetscDestroy<Handle>>;
} // namespace crawler
