// SPDX-License-Identifier: LGPL-2.1-or-later
#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

/// Starts MPI and PETSc for all tests of a program; only rank 0 prints, and all ranks fail together.
int
main(int argc, char **argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  int one = 1; // PETSc need not see GoogleTest's options
  const dealii::Utilities::MPI::MPI_InitFinalize guard(one, argv, 1);
  auto &listeners = ::testing::UnitTest::GetInstance()->listeners();
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    delete listeners.Release(listeners.default_result_printer());
  const int failed = RUN_ALL_TESTS();
  return static_cast<int>(dealii::Utilities::MPI::max(failed, MPI_COMM_WORLD));
}
