// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/clock.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/sensitivities.h>
#include <crawler/studies/sweep/cross_check.h>
#include <crawler/studies/sweep/sweep_blocks.h>
#include <crawler/studies/sweep/sweep_rows.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace crawler
{
  namespace
  {
    /// True if neighbours on this axis are similar scenes, which take similar effort.
    bool
    is_smooth(const SweepAxis &axis)
    {
      return !axis.is_file() && axis.entry != "Accuracy" && axis.entry != "Time/End time" &&
             std::ranges::all_of(axis.values, [](const std::string &value) { return to_number(value).has_value(); });
    }

    /// Unknowns times steps of the run; 0 on levels without a mesh, infinite where unknown.
    double
    work_of(const Task &task)
    {
      const SimulationResult &result = task.computed.result;
      if (task.error || result.time.status != Status::finished)
        return HUGE_VAL;
      return static_cast<double>(result.process.mesh.n_unknowns) * result.time.steps;
    }

    /// Result in place of the answer at a point that killed its process twice.
    Task
    crashed_task()
    {
      Task task;
      TimeOutcome &time = task.computed.result.time;
      time.status       = Status::failed;
      time.reason       = "crashed";
      time.message      = crash_message;
      return task;
    }

    /// Writes the rows of these points, consecutive ones together.
    template <typename Point>
    void
    write_rows(const std::vector<Point> &points,
               const std::vector<SensitivityEntry> &sensitivities,
               const SweepWork::WriteRows &write,
               const std::function<void(unsigned long n, unsigned long failed)> &see)
    {
      std::vector<RowFile::Row> rows;
      unsigned long failed = 0;
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        rows.push_back(sweep_row(points[i].task, sensitivities, points[i].checked));
        failed += status_of(points[i].task).status != "finished";
        if (i + 1 < points.size() && points[i + 1].number == points[i].number + 1)
          continue;
        write(points[i].number + 1 - rows.size(), rows);
        rows.clear();
      }
      if (!points.empty())
        see(points.size(), failed);
    }
  } // namespace

  std::vector<unsigned long>
  spread_out(const unsigned long n)
  {
    auto stride = static_cast<unsigned long>(std::ceil(0.618034 * n)); // near the golden section, and coprime to n
    while (std::gcd(stride, n) > 1)
      ++stride;
    std::vector<unsigned long> list;
    for (unsigned long i = 0; i < n; ++i)
      list.push_back(i * stride % n);
    return list;
  }

  std::vector<SweepBlock>
  sweep_blocks(const SweepDesign &design)
  {
    const std::size_t n_axes = design.axes().size();
    unsigned long row = 1, rows = design.run_length() > 1 ? design.run_length() : design.n_points(); // rows of a run
    if (design.run_length() > 1 && rows <= largest_block / 2 && n_axes > 1 && is_smooth(design.axes()[n_axes - 2]))
    {
      row  = rows;
      rows = design.axes()[n_axes - 2].values.size();
    }
    const unsigned long rows_of_block = largest_block / row, parts = (rows + rows_of_block - 1) / rows_of_block;
    std::vector<SweepBlock> blocks;
    for (unsigned long start = 0; start < design.n_points(); start += rows * row)
      for (unsigned long part = 0; part < parts; ++part) // equal ones
      {
        const unsigned long from = rows * part / parts, to = rows * (part + 1) / parts;
        blocks.push_back({start + from * row, (to - from) * row});
      }
    return blocks;
  }

  std::vector<SweepBlock>
  sweep_blocks_in_order(SweepPoints &points)
  {
    const SweepDesign &design = points.design();
    const auto blocks         = sweep_blocks(design);
    auto order                = spread_out(blocks.size());
    if (design.varies("Time/End time") || design.varies("Accuracy") || design.varies(SweepAxis::file))
    {
      std::vector<double> expected;
      for (const SweepBlock &block : blocks)
      {
        const Parameters &p = points.parameters(block.first);
        expected.push_back(p.time.end_time * std::log10(1. / p.accuracy) * static_cast<double>(block.size));
      }
      std::ranges::stable_sort(order, std::greater(), [&](const unsigned long number) { return expected[number]; });
    }
    std::vector<SweepBlock> list;
    for (const unsigned long number : order)
      list.push_back(blocks[number]);
    return list;
  }

  struct SweepWork::Point
  {
    unsigned long number;
    Task task;
    RowFile::Row checked = {}; ///< row of a cross-check
  };

  SweepWork::SweepWork(SweepPoints &points, const unsigned int n_ranks, CrashNote *const note)
    : points_(points)
    , blocks_(sweep_blocks_in_order(points))
    , parts_of_block_([&]() {
      // Each rank that takes a part must measure the numerics its block shares. Points of a cross-check take long.
      constexpr unsigned long most = 64, max_if_alone = 8;
      const unsigned long parts_per_rank = points.sweep().cross_check ? 8 : 4;
      const unsigned long n              = points.design().n_points(),
                          largest        = std::ranges::max(blocks_, {}, &SweepBlock::size).size;
      const unsigned long together =
        std::clamp(n / (parts_per_rank * n_ranks), 1ul, SweepNumerics::are_shared(points) ? most : max_if_alone);
      return (largest + together - 1) / together;
    }())
    , time_limit_(points.sweep().point_time_limit.value_or(HUGE_VAL))
    , numerics_(points)
    , note_(note)
  {
  }

  std::vector<unsigned long>
  SweepWork::part(const unsigned long number) const
  {
    const SweepBlock block   = block_of(number);
    const unsigned long part = number % parts_of_block_;
    std::vector<unsigned long> points;
    if (points_.sweep().cross_check) // neighbours, which take similarly long, go to different ranks
      for (unsigned long i = part; i < block.size; i += parts_of_block_)
        points.push_back(block.first + i);
    else
      for (unsigned long i = block.size * part / parts_of_block_; i < block.size * (part + 1) / parts_of_block_; ++i)
        points.push_back(block.first + i);
    return points;
  }

  std::vector<SweepWork::Point>
  SweepWork::compute_shared(const SweepBlock &block,
                            const std::vector<unsigned long> &points,
                            const std::function<bool()> &interrupted)
  {
    std::vector<Point> answers;
    for (std::size_t from = 0, to = 0; from < points.size(); from = to)
    {
      const double start = now();
      const auto shared =
        numerics_.at(block, points[from], [&]() { return now() - start <= time_limit_ && !interrupted(); });
      while (to < points.size() && points[to] < shared.points.first + shared.points.size)
        ++to;
      if (shared.choice == nullptr || interrupted())
        continue;
      std::vector<Task> tasks;
      std::vector<double> sizes;
      for (std::size_t i = from; i < to; ++i)
      {
        tasks.push_back(numerics_.task(points[i]));
        sizes.push_back(numerics_.size_at(shared, points[i]));
      }
      const std::vector<bool> computed = compute_similar(tasks, *shared.choice, sizes, time_limit_, interrupted);
      for (std::size_t i = from; i < to; ++i)
        if (computed[i - from])
          answers.push_back({points[i], std::move(tasks[i - from])});
    }
    return answers;
  }

  void
  SweepWork::differentiate(std::vector<Point> &points, const std::function<bool()> &interrupted)
  {
    if (points_.sensitivities().empty())
      return;
    for (Point &point : points)
    {
      Task &task = point.task;
      if (interrupted())
        return;
      if (task.error || task.computed.result.time.status != Status::finished)
        continue;
      const double start = now();
      find_sensitivities(points_.form(point.number),
                         *task.scene,
                         points_.sensitivities(),
                         task.computed.choice,
                         task.computed.result,
                         [&]() { return now() - start <= time_limit_ && !interrupted(); });
      task.seconds += now() - start;
    }
  }

  void
  SweepWork::check(std::vector<Point> &points, const std::function<bool()> &interrupted) const
  {
    if (!points_.sweep().cross_check)
      return;
    std::vector<const Task *> tasks;
    for (const Point &point : points)
      tasks.push_back(&point.task);
    std::vector<RowFile::Row> rows = checked_values(tasks, interrupted);
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i].checked = std::move(rows[i]);
  }

  bool
  SweepWork::compute(const unsigned long number,
                     const std::vector<bool> &done,
                     const WriteRows &write,
                     const std::function<bool()> &interrupted,
                     const std::function<void(unsigned long n, unsigned long failed)> &see)
  {
    std::vector<unsigned long> missing, last; // last: points at which a process died once
    std::vector<Point> given_up;
    for (const unsigned long point : part(number))
      if (const std::string name = fmt::format("{}", point); done[point])
        continue;
      else if (note_ != nullptr && note_->is_given_up(name))
        given_up.push_back({point, crashed_task()});
      else
        (note_ != nullptr && note_->crashes_at(name) > 0 ? last : missing).push_back(point);
    check(given_up, interrupted);
    const auto at_work_on = [this](const std::span<const unsigned long> points) {
      if (note_ != nullptr)
        note_->at_work_on(fmt::format("{}", fmt::join(points, " ")));
    };
    write_rows(given_up, points_.sensitivities(), write, see);
    at_work_on(missing);
    auto shared = compute_shared(block_of(number), missing, interrupted);
    differentiate(shared, interrupted);
    if (interrupted())
      return false;
    write_rows(shared, points_.sensitivities(), write, see);
    for (const Point &point : shared)
      std::erase(missing, point.number);

    // Remaining points are computed a few at a time, or one by one where one takes much work, so that finished ones are
    // soon on the disk. With a time limit for each, none may use up that of its neighbours.
    const std::size_t max_together = std::isfinite(time_limit_) ? 1 : 8;
    constexpr double much          = 1e6; // unknowns times steps
    std::size_t together           = max_together;
    const std::size_t alone        = missing.size(); // number of the first point to compute alone
    missing.insert(missing.end(), last.begin(), last.end());
    for (std::size_t from = 0, to = 0; from < missing.size(); from = to)
    {
      to = from < alone ? std::min(from + together, alone) : from + 1;
      at_work_on(std::span(missing).subspan(from, to - from));
      std::vector<Task> few;
      for (std::size_t i = from; i < to; ++i)
        few.push_back(numerics_.task(missing[i]));
      compute_all(few, time_limit_, interrupted);
      if (interrupted())
        return false;
      together = std::ranges::any_of(few, [&](const Task &one) { return work_of(one) > much; }) ? 1 : max_together;
      std::vector<Point> ready;
      for (std::size_t i = from; i < to; ++i)
        ready.push_back({missing[i], std::move(few[i - from])});
      differentiate(ready, interrupted);
      check(ready, interrupted);
      if (interrupted())
        return false;
      write_rows(ready, points_.sensitivities(), write, see);
    }
    at_work_on({});
    return true;
  }
} // namespace crawler
