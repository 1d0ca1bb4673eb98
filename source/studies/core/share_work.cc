// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/work_queue.h>
#include <crawler/studies/core/share_work.h>
#include <crawler/studies/core/study.h>

#include <fmt/format.h>

namespace crawler
{
  bool
  share_work(MPI_Comm communicator, const SharedWork &work, Log &log)
  {
    bool is_whole = true;
    std::string problem;
    {
      WorkQueue queue(communicator, work.n_parts);
      StudyProgress progress(log, work.n_points, work.points);
      const auto show_progress = [&]() {
        if (rank_of(communicator) != 0 || !progress.is_due())
          return;
        const auto all = queue.so_far();
        progress.report(all.done, all.failed > 0 ? fmt::format(", {} not finished", all.failed) : "");
      };
      const auto stops = [&]() {
        queue.serve();
        show_progress();
        return work.interrupted();
      };
      const auto see = [&](const unsigned long n, const unsigned long failed) {
        queue.done(n, failed);
        show_progress();
      };
      try
      {
        while (const auto number = queue.next())
          if (!work.compute(*number, stops, see))
          {
            is_whole = false;
            break;
          }
      }
      catch (const FileError &error)
      {
        problem = error.what();
      }
      if (!is_whole || !problem.empty())
        queue.close();
    }
    throw_on_all_ranks(communicator, problem);
    return on_all_ranks(communicator, is_whole);
  }

  void
  throw_on_all_ranks(MPI_Comm communicator, const std::string &problem)
  {
    const auto problems = gather(problem, communicator);
    on_first_rank(communicator, [&]() {
      for (const std::string &one : problems)
        if (!one.empty())
          throw FileError(one + "; the rows that were written are there, and --resume makes the rest");
      return "";
    });
  }

  bool
  on_all_ranks(MPI_Comm communicator, const bool here)
  {
    int all = here;
    MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, communicator);
    return all != 0;
  }
} // namespace crawler
