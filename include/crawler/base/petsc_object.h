// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/petsc_failure.h>

#include <petscts.h>

#include <memory>
#include <string>
#include <type_traits>

namespace crawler
{
  /// Throws PetscFailure with PETSc's own words if @p code is an error.
  inline void
  petsc(const PetscErrorCode code)
  {
    if (code == 0)
      return;
    const char *text = nullptr;
    PetscErrorMessage(code, &text, nullptr);
    throw PetscFailure(code, text != nullptr ? text : "without a message", code == PETSC_ERR_MEM);
  }

  /// Keeps the messages of PETSc's errors instead of printing them with their stack, during its lifetime.
  class PetscErrorWords
  {
  public:
    PetscErrorWords()
    {
      PetscPushErrorHandler(keep, this);
    }
    PetscErrorWords(const PetscErrorWords &) = delete;
    ~PetscErrorWords()
    {
      PetscPopErrorHandler();
    }
    std::string text;

  private:
    static PetscErrorCode
    keep(MPI_Comm,
         int,
         const char *,
         const char *,
         PetscErrorCode code,
         PetscErrorType type,
         const char *message,
         void *context)
    {
      if (type == PETSC_ERROR_INITIAL && message != nullptr)
        static_cast<PetscErrorWords *>(context)->text = message;
      return code;
    }
  };

  /// Destroys one reference to a PETSc object.
  template <typename Handle>
  struct PetscDestroy
  {
    void
    operator()(Handle handle) const
    {
      auto *object = reinterpret_cast<PetscObject>(handle);
      PetscObjectDestroy(&object);
    }
  };

  /// Owns a reference to a PETSc object (Vec, Mat, TS, ...).
  template <typename Handle>
  using PetscOwner = std::unique_ptr<std::remove_pointer_t<Handle>, PetscDestroy<Handle>>;
} // namespace crawler
