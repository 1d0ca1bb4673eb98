// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>

#include <mpi.h>

#include <functional>
#include <string>
#include <type_traits>
#include <vector>

namespace crawler
{
  /// Number of this process; below, the number of all processes.
  unsigned int
  rank_of(MPI_Comm communicator);
  unsigned int
  size_of(MPI_Comm communicator);

  /// Returns on all ranks whether @p is_true holds on any of them (collective).
  bool
  is_true_anywhere(bool is_true, MPI_Comm communicator);

  /// Returns the text of rank 0 on all ranks.
  std::string
  broadcast(const std::string &text, MPI_Comm communicator);

  /// Returns on all ranks the text of the first one whose text is not empty, if there is one (collective).
  std::string
  first_text(const std::string &text, MPI_Comm communicator);

  /// Returns on rank 0 the texts of all ranks in rank order, on the others nothing (collective).
  std::vector<std::string>
  gather(const std::string &text, MPI_Comm communicator);

  /// Returns on rank 0 the numbers of all ranks, concatenated in rank order, on the others nothing (collective).
  std::vector<double>
  gather(const std::vector<double> &numbers, MPI_Comm communicator);

  /**
   * Runs @p action on rank 0 only and returns its text on all ranks. An InputError or FileError that it throws is
   * thrown on all ranks, so that the failure of one cannot hang the others.
   */
  std::string
  on_first_rank(MPI_Comm communicator, const std::function<std::string()> &action);

  /// Version for an action that returns nothing.
  template <typename Action>
  requires std::is_void_v<std::invoke_result_t<Action>>
  void
  on_first_rank(MPI_Comm communicator, const Action &action)
  {
    on_first_rank(communicator, [&]() {
      action();
      return std::string();
    });
  }

  /// Version for an exit code: rank 0 decides how all ranks end.
  ExitCode
  exit_code_of_first_rank(MPI_Comm communicator, const std::function<ExitCode()> &action);

  /// Sends bytes from another rank to rank 0, and waits until they are received.
  void
  send_to_first_rank(const std::string &text, MPI_Comm communicator);

  /// Passes what other ranks are sending to @p keep, on rank 0. Throws what @p keep throws.
  void
  take_from_others(MPI_Comm communicator, const std::function<void(const std::string &)> &keep);

  /**
   * Speeds up MPI_Init: in a process without a launcher Open MPI starts a daemon and looks for networks, which takes
   * longer than most runs. If MPI is initialized while this object lives, it does neither; settings in the user's
   * environment stay. Under a launcher only the slow access to counters is excluded.
   */
  class QuickStart
  {
  public:
    QuickStart();
    ~QuickStart();
    QuickStart(const QuickStart &) = delete;

  private:
    std::vector<const char *> set_; ///< variables to be removed again, so that child processes do not inherit them
  };
} // namespace crawler
