// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/stop_signal.h>

#include <csignal>

namespace crawler
{
  namespace
  {
    volatile std::sig_atomic_t arrived = 0;

    void
    note(int number)
    {
      arrived = 1;
      std::signal(number, SIG_DFL);
    }
  } // namespace

  StopSignal::StopSignal()
  {
    arrived = 0;
    sigaction(SIGINT, nullptr, &before_interrupt_);
    sigaction(SIGTERM, nullptr, &before_termination_);
    std::signal(SIGINT, note);
    std::signal(SIGTERM, note);
  }

  StopSignal::~StopSignal()
  {
    sigaction(SIGINT, &before_interrupt_, nullptr);
    sigaction(SIGTERM, &before_termination_, nullptr);
  }

  bool
  StopSignal::arrived_anywhere(MPI_Comm communicator) const
  {
    int any = arrived;
    if (size_of(communicator) > 1)
      MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, communicator);
    return any != 0;
  }
} // namespace crawler
