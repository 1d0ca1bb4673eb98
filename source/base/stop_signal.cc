// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/stop_place.h>
#include <crawler/base/stop_signal.h>

#include <iterator>

namespace crawler
{
  namespace
  {
    volatile std::sig_atomic_t noted = 0;

    void
    note(int number)
    {
      noted = 1;
      std::signal(number, SIG_DFL);
    }
  } // namespace

  StopSignal::StopSignal()
  {
    check_stop_place();
    noted = 0;
    for (std::size_t i = 0; i < std::size(numbers); ++i)
    {
      sigaction(numbers[i], nullptr, &before_[i]);
      std::signal(numbers[i], note);
    }
  }

  StopSignal::~StopSignal()
  {
    for (std::size_t i = 0; i < std::size(numbers); ++i)
      sigaction(numbers[i], &before_[i], nullptr);
  }

  bool
  StopSignal::arrived() const
  {
    reach(StopPlace::step);
    return noted != 0;
  }

  bool
  StopSignal::arrived_anywhere(MPI_Comm communicator) const
  {
    return is_true_anywhere(arrived(), communicator);
  }
} // namespace crawler
