// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <deque>
#include <functional>
#include <string>

namespace crawler
{
  /// Texts for rank 0 from all ranks, which go on with their work meanwhile.
  class Mailbox
  {
  public:
    using Keep = std::function<void(const std::string &text)>;

    /// Collective, and so is the destructor, which drops what has not been taken.
    explicit Mailbox(MPI_Comm communicator);
    ~Mailbox();
    Mailbox(const Mailbox &) = delete;

    /// Sends bytes from this rank; waits until rank 0 has taken the text before, which therefore looks into the mailbox
    /// as long as others may send.
    void
    send(std::string text);

    /// Hands what has come to @p keep, on rank 0. Throws what that throws.
    void
    take(const Keep &keep);

    /// The same of all that any rank has sent (collective). @p keep must not throw.
    void
    take_all(const Keep &keep);

  private:
    MPI_Comm communicator_;
    std::deque<std::string> own_; ///< of rank 0
    std::string sent_;            ///< by another rank
    MPI_Request request_ = MPI_REQUEST_NULL;
  };
} // namespace crawler
