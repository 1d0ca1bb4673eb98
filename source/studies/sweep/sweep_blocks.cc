// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/core/compute.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/sweep/sweep_blocks.h>
#include <crawler/studies/sweep/sweep_rows.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace crawler
{
  SweepBlocks::SweepBlocks(const SweepDesign &design)
    : run_length_(design.run_length() > 1 ? design.run_length() : design.n_points())
  {
    constexpr unsigned long most = 64, least_blocks = 256;
    const unsigned long size = std::clamp(design.n_points() / least_blocks, 1ul, most);
    // Equal parts of each run along the last axis.
    n_runs_       = design.n_points() / run_length_;
    parts_of_run_ = (run_length_ + size - 1) / size;
  }

  unsigned long
  SweepBlocks::size() const
  {
    return n_runs_ * parts_of_run_;
  }

  SweepBlock
  SweepBlocks::operator[](const unsigned long number) const
  {
    const unsigned long part = number % parts_of_run_, start = number / parts_of_run_ * run_length_;
    const unsigned long from = run_length_ * part / parts_of_run_, to = run_length_ * (part + 1) / parts_of_run_;
    return {start + from, to - from};
  }

  SweepOrder::SweepOrder(const SweepBlocks &blocks, SweepPoints &points)
    : size_(blocks.size())
    , stride_(golden_stride(size_))
  {
    const SweepDesign &design = points.design();
    if (!design.varies("Time/End time") && !design.varies("Accuracy") && !design.varies(SweepAxis::file))
      return;
    std::vector<std::pair<double, unsigned long>> list;
    for (unsigned long i = 0; i < size_; ++i)
    {
      const unsigned long number = i * stride_ % size_;
      const SweepBlock block     = blocks[number];
      const Parameters &p        = points.parameters(block.first);
      list.emplace_back(p.time.end_time * std::log10(1. / p.accuracy) * static_cast<double>(block.size), number);
    }
    std::stable_sort(list.begin(), list.end(), [](const auto &a, const auto &b) { return a.first > b.first; });
    for (const auto &[expected, number] : list)
      sorted_.push_back(number);
  }

  unsigned long
  SweepOrder::operator[](const unsigned long i) const
  {
    return sorted_.empty() ? i * stride_ % size_ : sorted_[i];
  }

  namespace
  {
    /// The rows of the tasks that are @p ready, those in succession at once.
    void
    write(const SweepBlock &block,
          const std::vector<Task> &tasks,
          const std::vector<bool> &ready,
          RowFile &file,
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
        file.write(block.first + i - rows.size(), rows);
        rows.clear();
      }
      if (n > 0)
        see(n, failed);
    }
  } // namespace

  bool
  compute_block(const SweepBlock &block,
                SweepPoints &points,
                const std::vector<bool> &done,
                RowFile &file,
                const std::function<bool()> &interrupted,
                const std::function<void(unsigned long n, unsigned long failed)> &see)
  {
    std::vector<bool> missing(block.size);
    for (unsigned long i = 0; i < block.size; ++i)
      missing[i] = !done[block.first + i];
    if (std::none_of(missing.begin(), missing.end(), [](const bool is) { return is; }))
      return true;
    std::vector<Task> tasks(block.size);
    for (unsigned long i = 0; i < block.size; ++i)
    {
      tasks[i].parameters = points.parameters(block.first + i);
      tasks[i].gait       = true;
    }
    const double limit          = tasks.front().parameters.sweep.point_time_limit.value_or(HUGE_VAL);
    const std::vector<bool> one = compute_similar(tasks, missing, limit, interrupted);
    if (interrupted())
      return false;
    write(block, tasks, one, file, see);
    for (unsigned long i = 0; i < block.size; ++i)
      missing[i] = missing[i] && !one[i];

    // The rest a few at a time, or one by one where one takes long: what is finished shall be on the disk soon. With a
    // time limit for each, no one may use up that of its neighbours.
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
      compute_all(few, limit, interrupted);
      if (interrupted())
        return false;
      together = (now() - before) / static_cast<double>(some.size()) > long_time ? 1 : most_together;
      std::vector<bool> ready(block.size, false);
      for (std::size_t j = 0; j < some.size(); ++j)
      {
        ready[some[j]] = true;
        tasks[some[j]] = std::move(few[j]);
      }
      write(block, tasks, ready, file, see);
    }
    return true;
  }
} // namespace crawler
