// SPDX-License-Identifier: LGPL-2.1-or-later
//
// A deal.II program that does nothing: what the start-up of crawler is measured against (contrib/startup.py).
#include <deal.II/base/mpi.h>

int
main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize guard(argc, argv, 1);
  return 0;
}
