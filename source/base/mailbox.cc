// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/mailbox.h>

#include <chrono>
#include <thread>
#include <utility>

namespace crawler
{
  namespace
  {
    constexpr int owner = 0, letter = 0; // rank and tag

    void
    wait_for(MPI_Request &request, const std::function<void()> &meanwhile)
    {
      for (int is_done = 0;;)
      {
        meanwhile();
        MPI_Test(&request, &is_done, MPI_STATUS_IGNORE);
        if (is_done != 0)
          return;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
  } // namespace

  Mailbox::Mailbox(MPI_Comm communicator)
  {
    MPI_Comm_dup(communicator, &communicator_);
  }

  Mailbox::~Mailbox()
  {
    take_all([](const std::string &) {});
    MPI_Comm_free(&communicator_);
  }

  void
  Mailbox::send(std::string text)
  {
    if (rank_of(communicator_) == owner)
    {
      own_.push_back(std::move(text));
      return;
    }
    wait_for(request_, []() {});
    sent_ = std::move(text);
    MPI_Issend(sent_.data(), static_cast<int>(sent_.size()), MPI_BYTE, owner, letter, communicator_, &request_);
  }

  void
  Mailbox::take(const Keep &keep)
  {
    while (!own_.empty())
    {
      const std::string text = std::move(own_.front());
      own_.pop_front();
      keep(text);
    }
    if (rank_of(communicator_) != owner || size_of(communicator_) == 1)
      return;
    int is_there = 0;
    MPI_Status status;
    while (MPI_Iprobe(MPI_ANY_SOURCE, letter, communicator_, &is_there, &status), is_there != 0)
    {
      int size = 0;
      MPI_Get_count(&status, MPI_BYTE, &size);
      std::string text(static_cast<std::size_t>(size), '\0');
      MPI_Recv(text.data(), size, MPI_BYTE, status.MPI_SOURCE, letter, communicator_, MPI_STATUS_IGNORE);
      keep(text);
    }
  }

  void
  Mailbox::take_all(const Keep &keep)
  {
    wait_for(request_, []() {}); // what is sent has then been taken
    MPI_Request all_are_here;
    MPI_Ibarrier(communicator_, &all_are_here);
    wait_for(all_are_here, [&]() { take(keep); });
  }
} // namespace crawler
