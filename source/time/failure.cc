// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/petsc_failure.h>
#include <crawler/time/failure.h>

#include <filesystem>
#include <new>

namespace crawler
{
  TimeOutcome
  failure_of(const std::exception_ptr &error)
  {
    TimeOutcome outcome;
    outcome.status           = Status::failed;
    const auto out_of_memory = [&]() {
      outcome.reason  = "out_of_memory";
      outcome.message = "out of memory";
    };
    try
    {
      std::rethrow_exception(error);
    }
    catch (const InputError &)
    {
      throw;
    }
    catch (const FileError &)
    {
      throw;
    }
    catch (const std::filesystem::filesystem_error &problem)
    {
      throw FileError(in_words(problem));
    }
    catch (const NonfiniteStress &problem)
    {
      outcome.reason  = "nonfinite";
      outcome.message = problem.what();
    }
    catch (const PetscFailure &problem)
    {
      outcome.reason  = "petsc_error";
      outcome.message = problem.what();
      if (problem.is_out_of_memory)
        out_of_memory();
    }
    catch (const std::bad_alloc &)
    {
      out_of_memory();
    }
    catch (const std::exception &problem)
    {
      outcome.reason  = "exception";
      outcome.message = problem.what();
    }
    catch (...)
    {
      outcome.reason  = "exception";
      outcome.message = "an exception without a message";
    }
    return outcome;
  }
} // namespace crawler
