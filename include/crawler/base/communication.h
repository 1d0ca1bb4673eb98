// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>

#include <mpi.h>

#include <functional>
#include <string>
#include <vector>

namespace crawler
{
  /// Number of this process, and of all.
  unsigned int
  rank_of(MPI_Comm communicator);
  unsigned int
  size_of(MPI_Comm communicator);

  /// Is it so on any rank? (collective)
  bool
  is_true_anywhere(bool is_true, MPI_Comm communicator);

  /// The text of rank 0, on all ranks.
  std::string
  broadcast(const std::string &text, MPI_Comm communicator);

  /// The texts of all ranks in their order, on rank 0; nothing on the others (collective).
  std::vector<std::string>
  gather(const std::string &text, MPI_Comm communicator);

  /// The numbers of all ranks, one after another in their order, on rank 0; nothing on the others (collective).
  std::vector<double>
  gather(const std::vector<double> &numbers, MPI_Comm communicator);

  /**
   * Runs @p action on rank 0 only and returns its text on all ranks. An InputError or FileError that it throws is
   * thrown on all ranks, so that the failure of one cannot hang the others.
   */
  std::string
  on_first_rank(MPI_Comm communicator, const std::function<std::string()> &action);

  /// The same of an exit code: rank 0 says how all ranks end.
  ExitCode
  exit_code_of_first_rank(MPI_Comm communicator, const std::function<ExitCode()> &action);

  /// Sends bytes to rank 0 from another rank, and waits until they are taken there.
  void
  send_to_first_rank(const std::string &text, MPI_Comm communicator);

  /// Hands to @p keep, on rank 0, what other ranks are sending. Throws what that throws.
  void
  take_from_others(MPI_Comm communicator, const std::function<void(const std::string &)> &keep);

  /**
   * Open MPI in a process that no launcher has started runs a daemon and looks for networks, which takes longer than
   * most runs. While this object lives, when MPI is initialized, it does neither; what the user has set in the
   * environment stays. Where a launcher is seen, only the slow access to counters is excluded.
   */
  class QuickStart
  {
  public:
    QuickStart();
    ~QuickStart();
    QuickStart(const QuickStart &) = delete;

  private:
    std::vector<const char *> set_; ///< variables that programs started by this one do not inherit
  };
} // namespace crawler
