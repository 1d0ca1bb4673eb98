/* SPDX-License-Identifier: LGPL-2.1-or-later */
#pragma once

/**
 * MPI for one process, as far as the rooms of a run use it: the process is rank 0 of 1, all others' data are its own.
 * (PETSc's mpiuni is the same for its own calls.)
 */
#include <cstddef>
#include <cstdlib>
#include <cstring>

using MPI_Comm     = int;
using MPI_Datatype = std::size_t; ///< its bytes
using MPI_Op       = int;
struct MPI_Status
{
  int MPI_SOURCE;
};

constexpr MPI_Comm MPI_COMM_WORLD = 0, MPI_COMM_SELF = 1;
constexpr MPI_Datatype MPI_CHAR = 1, MPI_BYTE = 1, MPI_INT = sizeof(int), MPI_UNSIGNED_LONG = sizeof(unsigned long),
                       MPI_DOUBLE = sizeof(double);
constexpr MPI_Op MPI_SUM = 0, MPI_MAX = 1, MPI_MIN = 2;
constexpr int MPI_PROC_NULL = -1, MPI_ANY_SOURCE = -2;
inline void *const MPI_IN_PLACE            = nullptr;
inline MPI_Status *const MPI_STATUS_IGNORE = nullptr;

inline int
MPI_Comm_rank(MPI_Comm, int *rank)
{
  return *rank = 0;
}
inline int
MPI_Comm_size(MPI_Comm, int *size)
{
  *size = 1;
  return 0;
}
inline int
MPI_Bcast(void *, int, MPI_Datatype, int, MPI_Comm)
{
  return 0;
}
inline int
MPI_Allreduce(const void *from, void *to, int n, MPI_Datatype bytes, MPI_Op, MPI_Comm)
{
  if (from != MPI_IN_PLACE)
    std::memcpy(to, from, static_cast<std::size_t>(n) * bytes);
  return 0;
}
/// What the ranks before this one have: nothing, so the receiver's value stays.
inline int
MPI_Exscan(const void *, void *, int, MPI_Datatype, MPI_Op, MPI_Comm)
{
  return 0;
}
inline int
MPI_Allgather(const void *from, int n, MPI_Datatype bytes, void *to, int, MPI_Datatype, MPI_Comm)
{
  std::memcpy(to, from, static_cast<std::size_t>(n) * bytes);
  return 0;
}
inline int
MPI_Allgatherv(
  const void *from, int n, MPI_Datatype bytes, void *to, const int *, const int *, MPI_Datatype, MPI_Comm communicator)
{
  return MPI_Allgather(from, n, bytes, to, n, bytes, communicator);
}
inline int
MPI_Gather(const void *from, int n, MPI_Datatype bytes, void *to, int, MPI_Datatype, int, MPI_Comm communicator)
{
  return MPI_Allgather(from, n, bytes, to, n, bytes, communicator);
}
inline int
MPI_Gatherv(const void *from,
            int n,
            MPI_Datatype bytes,
            void *to,
            const int *,
            const int *,
            MPI_Datatype,
            int,
            MPI_Comm communicator)
{
  return MPI_Allgather(from, n, bytes, to, n, bytes, communicator);
}
/// With the neighbours along the body, of which there is none.
inline int
MPI_Sendrecv(const void *, int, MPI_Datatype, int, int, void *, int, MPI_Datatype, int, int, MPI_Comm, MPI_Status *)
{
  return 0;
}
/// Letters of other ranks: there are none, so nothing is sent or taken.
inline int
MPI_Iprobe(int, int, MPI_Comm, int *is_there, MPI_Status *)
{
  return *is_there = 0;
}
inline int
MPI_Ssend(const void *, int, MPI_Datatype, int, int, MPI_Comm)
{
  std::abort();
}
inline int
MPI_Get_count(const MPI_Status *, MPI_Datatype, int *)
{
  std::abort();
}
inline int
MPI_Recv(void *, int, MPI_Datatype, int, int, MPI_Comm, MPI_Status *)
{
  std::abort();
}
