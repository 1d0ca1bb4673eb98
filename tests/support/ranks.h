// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <type_traits>

namespace crawler::test
{
  /// Sum, or other reduction by @p operation, of the numbers of all ranks (collective).
  template <typename Number>
  Number
  over_ranks(Number own, MPI_Op operation = MPI_SUM)
  {
    const MPI_Datatype type = std::is_same_v<Number, double>         ? MPI_DOUBLE
                              : std::is_same_v<Number, unsigned int> ? MPI_UNSIGNED
                                                                     : MPI_INT;
    static_assert(sizeof(Number) == sizeof(int) || std::is_same_v<Number, double>);
    MPI_Allreduce(MPI_IN_PLACE, &own, 1, type, operation, MPI_COMM_WORLD);
    return own;
  }
} // namespace crawler::test
