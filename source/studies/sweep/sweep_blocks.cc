// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/sweep/sweep_blocks.h>
#include <crawler/studies/sweep/sweep_rows.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace crawler
{
  namespace
  {
    /// Are neighbours on this axis similar scenes, that take similar effort?
    bool
    is_smooth(const SweepAxis &axis)
    {
      return !axis.is_file() && axis.entry != "Accuracy" && axis.entry != "Time/End time" &&
             std::ranges::all_of(axis.values, [](const std::string &value) { return to_number(value).has_value(); });
    }
  } // namespace

  SweepBlocks::SweepBlocks(const SweepDesign &design)
    : row_(1)
    , rows_(design.run_length() > 1 ? design.run_length() : design.n_points())
  {
    const std::size_t n_axes = design.axes().size();
    if (design.run_length() > 1 && rows_ <= most / 2 && n_axes > 1 && is_smooth(design.axes()[n_axes - 2]))
    {
      row_  = rows_;
      rows_ = design.axes()[n_axes - 2].values.size();
    }
    // Equal parts of each run.
    n_runs_                           = design.n_points() / (row_ * rows_);
    const unsigned long rows_of_block = most / row_;
    parts_of_run_                     = (rows_ + rows_of_block - 1) / rows_of_block;
  }

  unsigned long
  SweepBlocks::size() const
  {
    return n_runs_ * parts_of_run_;
  }

  SweepBlock
  SweepBlocks::operator[](const unsigned long number) const
  {
    const unsigned long part = number % parts_of_run_, start = number / parts_of_run_ * rows_ * row_;
    const unsigned long from = rows_ * part / parts_of_run_, to = rows_ * (part + 1) / parts_of_run_;
    return {start + from * row_, (to - from) * row_};
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
    /// A point to compute.
    struct Point
    {
      unsigned long number;
      Task task;
    };

    /// The rows of these points, those in succession at once.
    void
    write(const std::vector<Point> &points,
          RowFile &file,
          const std::function<void(unsigned long n, unsigned long failed)> &see)
    {
      std::vector<RowFile::Row> rows;
      unsigned long failed = 0;
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        rows.push_back(sweep_row(points[i].task));
        failed += status_of(points[i].task).status != "finished";
        if (i + 1 < points.size() && points[i + 1].number == points[i].number + 1)
          continue;
        file.write(points[i].number + 1 - rows.size(), rows);
        rows.clear();
      }
      if (!points.empty())
        see(points.size(), failed);
    }
  } // namespace

  SweepWork::SweepWork(SweepPoints &points, const unsigned int n_ranks)
    : points_(points)
    , blocks_(points.design())
    , order_(blocks_, points)
    , parts_of_block_([&]() {
      constexpr unsigned long parts_per_rank = 16;
      const unsigned long together =
        std::clamp(points.design().n_points() / (parts_per_rank * n_ranks), 1ul, SweepBlocks::most);
      return (SweepBlocks::most + together - 1) / together;
    }())
    , time_limit_(points.sweep().point_time_limit.value_or(HUGE_VAL))
  {
  }

  unsigned long
  SweepWork::n_parts() const
  {
    return blocks_.size() * parts_of_block_;
  }

  SweepBlock
  SweepWork::part(const unsigned long number) const
  {
    const SweepBlock block   = blocks_[order_[number / parts_of_block_]];
    const unsigned long part = number % parts_of_block_;
    const unsigned long from = block.size * part / parts_of_block_, to = block.size * (part + 1) / parts_of_block_;
    return {block.first + from, to - from};
  }

  Task
  SweepWork::task(const unsigned long point) const
  {
    Task one;
    one.parameters = points_.parameters(point);
    one.gait       = true;
    return one;
  }

  const std::optional<NumericsChoice> &
  SweepWork::numerics(const unsigned long part, const std::function<bool()> &interrupted)
  {
    constexpr unsigned long fewest = 6; // so few are not worth three choices
    const unsigned long number     = order_[part / parts_of_block_];
    if (block_ == number)
      return numerics_;
    const SweepBlock block = blocks_[number];
    numerics_.reset();
    block_ = number;
    if (block.size < fewest)
      return numerics_;
    std::vector<Task> examples;
    for (const unsigned long i : {0ul, block.size / 2, block.size - 1})
      examples.push_back(task(block.first + i));
    const double start = now();
    numerics_ = shared_numerics(examples, [&]() { return now() - start <= time_limit_ && !interrupted(); });
    return numerics_;
  }

  unsigned long
  SweepWork::try_out(const unsigned long part)
  {
    const auto never       = []() { return false; };
    const SweepBlock block = this->part(part);
    if (block.size == 0)
      return 0;
    std::vector<Task> tasks;
    for (unsigned long i = 0; i < block.size; ++i)
      tasks.push_back(task(block.first + i));
    std::vector<bool> computed(tasks.size(), false);
    if (const auto &shared = numerics(part, never))
      computed = compute_similar(tasks, *shared, time_limit_, never);
    for (std::size_t i = 0; i < tasks.size(); ++i)
      if (!computed[i])
        compute_all({&tasks[i], 1}, time_limit_, never);
    return tasks.size();
  }

  bool
  SweepWork::compute(const unsigned long number,
                     const std::vector<bool> &done,
                     RowFile &file,
                     const std::function<bool()> &interrupted,
                     const std::function<void(unsigned long n, unsigned long failed)> &see)
  {
    const SweepBlock block = part(number);
    std::vector<unsigned long> missing;
    for (unsigned long point = block.first; point < block.first + block.size; ++point)
      if (!done[point])
        missing.push_back(point);
    if (missing.empty())
      return true;
    if (const auto &shared = numerics(number, interrupted))
    {
      std::vector<Task> tasks;
      for (const unsigned long point : missing)
        tasks.push_back(task(point));
      const std::vector<bool> computed = compute_similar(tasks, *shared, time_limit_, interrupted);
      if (interrupted())
        return false;
      std::vector<Point> ready;
      std::vector<unsigned long> left;
      for (std::size_t i = 0; i < tasks.size(); ++i)
        if (computed[i])
          ready.push_back({missing[i], std::move(tasks[i])});
        else
          left.push_back(missing[i]);
      write(ready, file, see);
      missing = std::move(left);
    }

    // The rest a few at a time, or one by one where one takes long: what is finished shall be on the disk soon. With a
    // time limit for each, no one may use up that of its neighbours.
    const std::size_t most_together = std::isfinite(time_limit_) ? 1 : 8;
    constexpr double long_time      = 1.; // seconds
    std::size_t together            = most_together;
    for (std::size_t from = 0, to = 0; from < missing.size(); from = to)
    {
      to = std::min(from + together, missing.size());
      std::vector<Task> few;
      for (std::size_t i = from; i < to; ++i)
        few.push_back(task(missing[i]));
      const double before = now();
      compute_all(few, time_limit_, interrupted);
      if (interrupted())
        return false;
      together = (now() - before) / static_cast<double>(to - from) > long_time ? 1 : most_together;
      std::vector<Point> ready;
      for (std::size_t i = from; i < to; ++i)
        ready.push_back({missing[i], std::move(few[i - from])});
      write(ready, file, see);
    }
    return true;
  }
} // namespace crawler
