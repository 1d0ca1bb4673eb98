// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/core/compute_similar.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/sweep/sweep_rows.h>
#include <crawler/studies/sweep/sweep_worker.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  SweepWorker::SweepWorker(SweepPoints &points,
                           const std::vector<bool> &done,
                           RowFile &file,
                           const std::function<bool()> &interrupted)
    : points_(points)
    , done_(done)
    , file_(file)
    , interrupted_(interrupted)
  {
  }

  bool
  SweepWorker::compute(const SweepBlock &block, const std::function<void(unsigned long n, unsigned long failed)> &see)
  {
    std::vector<bool> missing(block.size);
    for (unsigned long i = 0; i < block.size; ++i)
      missing[i] = !done_[block.first + i];
    if (std::none_of(missing.begin(), missing.end(), [](const bool is) { return is; }))
      return true;
    std::vector<Task> tasks(block.size);
    for (unsigned long i = 0; i < block.size; ++i)
    {
      tasks[i].parameters = points_.parameters(block.first + i);
      tasks[i].gait       = true;
    }
    const double limit          = tasks.front().parameters.sweep.point_time_limit.value_or(HUGE_VAL);
    const std::vector<bool> one = compute_similar(tasks, missing, limit, interrupted_);
    if (interrupted_())
      return false;
    write(block, tasks, one, see);
    for (unsigned long i = 0; i < block.size; ++i)
      missing[i] = missing[i] && !one[i];

    // The rest a few at a time, or one by one where one takes long: what is finished shall be on the disk soon. With a
    // time limit for each, no point may use up that of its neighbours.
    const unsigned long most_together = std::isfinite(limit) ? 1 : 8;
    constexpr double long_time        = 1.; // seconds
    unsigned long together            = most_together;
    for (unsigned long i = 0; i < block.size;)
    {
      std::vector<unsigned long> some;
      for (; i < block.size && some.size() < together; ++i)
        if (missing[i])
          some.push_back(i);
      if (some.empty())
        break;
      std::vector<Task> few(some.size());
      for (std::size_t j = 0; j < some.size(); ++j)
      {
        few[j].parameters = tasks[some[j]].parameters;
        few[j].gait       = true;
      }
      const double before = now();
      compute_all(few, limit, interrupted_);
      if (interrupted_())
        return false;
      together = (now() - before) / static_cast<double>(some.size()) > long_time ? 1 : most_together;
      std::vector<bool> ready(block.size, false);
      for (std::size_t j = 0; j < some.size(); ++j)
      {
        ready[some[j]] = true;
        tasks[some[j]] = std::move(few[j]);
      }
      write(block, tasks, ready, see);
    }
    return true;
  }

  void
  SweepWorker::write(const SweepBlock &block,
                     const std::vector<Task> &tasks,
                     const std::vector<bool> &ready,
                     const std::function<void(unsigned long n, unsigned long failed)> &see)
  {
    std::vector<RowFile::Row> rows;
    unsigned long n = 0, failed = 0;
    for (unsigned long i = 0; i <= block.size; ++i)
    {
      if (i < block.size && ready[i])
      {
        rows.push_back(sweep_row(tasks[i]));
        ++n;
        failed += status_of(tasks[i]).status != "finished";
        continue;
      }
      file_.write(block.first + i - rows.size(), rows);
      rows.clear();
    }
    if (n > 0)
      see(n, failed);
  }
} // namespace crawler
