// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#ifdef __SANITIZE_ADDRESS__
#  include <sanitizer/lsan_interface.h>

/// What the runtime of MPI keeps to the end of a program on several ranks.
extern "C" const char *
__lsan_default_suppressions()
{
  return "leak:libpmix\nleak:libopen-pal\nleak:libopen-rte\nleak:libmpi\n";
}
#endif

/// Starts MPI and PETSc for all tests of a program; only rank 0 prints, and all ranks fail together.
/// Leaks are looked for in what the tests allocate. Start and end of MPI are left out: it loads and unloads modules,
/// and what these keep would look like leaks of unknown origin.
int
main(int argc, char **argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  int one = 1; // PETSc need not see GoogleTest's options
#ifdef __SANITIZE_ADDRESS__
  __lsan_disable();
#endif
  const dealii::Utilities::MPI::MPI_InitFinalize guard(one, argv, 1);
#ifdef __SANITIZE_ADDRESS__
  __lsan_enable();
#endif
  auto &listeners = ::testing::UnitTest::GetInstance()->listeners();
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    delete listeners.Release(listeners.default_result_printer());
  const int failed = RUN_ALL_TESTS();
#ifdef __SANITIZE_ADDRESS__
  __lsan_do_leak_check();
#endif
  return static_cast<int>(dealii::Utilities::MPI::max(failed, MPI_COMM_WORLD));
}
