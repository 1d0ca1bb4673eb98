// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/sweep/sweep_blocks.h>
#include <crawler/studies/sweep/sweep_check.h>
#include <crawler/studies/sweep/sweep_rows.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    std::string
    size_in_words(const double bytes)
    {
      return bytes < 1e6   ? fmt::format("{:.3g} kB", bytes / 1e3)
             : bytes < 1e9 ? fmt::format("{:.3g} MB", bytes / 1e6)
                           : fmt::format("{:.3g} GB", bytes / 1e9);
    }
  } // namespace

  std::string
  in_words(const SweepDesign &design, const std::string &design_name)
  {
    std::vector<std::string> axes;
    for (const SweepAxis &axis : design.axes())
      axes.push_back(axis.entry +
                     (design_name == "grid"
                        ? fmt::format(" ({} value{})", axis.values.size(), axis.values.size() == 1 ? "" : "s")
                        : ""));
    return fmt::format("{} point{}, {} over {}",
                       design.n_points(),
                       design.n_points() == 1 ? "" : "s",
                       design_name,
                       fmt::join(axes, ", "));
  }

  bool
  check_sweep(MPI_Comm communicator, const ParameterFile &file, Log &log)
  {
    const Assignment *const axes = file.assignment_of("Sweep/Axes");
    if (axes == nullptr || axes->value.empty())
      return false;
    SweepPoints points(communicator, file);
    const SweepDesign &design = points.design();
    std::size_t bytes         = 0;
    for (const RowFile::Column &column : sweep_columns(design, points.declarations()))
      bytes += column.width == 0 ? sizeof(double) : column.width;
    // The time of some blocks, spread over the sweep.
    constexpr unsigned long most_samples = 32;
    constexpr double long_enough         = 2.; // seconds
    const SweepBlocks blocks(design);
    const unsigned long stride = golden_stride(blocks.size());
    const double limit = points.sweep().point_time_limit.value_or(HUGE_VAL), before = now();
    unsigned long n_computed = 0;
    for (unsigned long i = 0; i < std::min(most_samples, blocks.size()) && now() - before < long_enough; ++i)
    {
      const SweepBlock block = blocks[(i + 1) * stride % blocks.size()];
      std::vector<Task> tasks(block.size);
      for (unsigned long j = 0; j < block.size; ++j)
        tasks[j].parameters = points.parameters(block.first + j);
      const auto never = []() { return false; };
      auto done        = compute_similar(tasks, std::vector<bool>(block.size, true), limit, never);
      for (unsigned long j = 0; j < block.size; ++j)
        if (!done[j])
          compute_all({&tasks[j], 1}, limit, never);
      n_computed += block.size;
    }
    const double each = (now() - before) / static_cast<double>(n_computed);
    log.line(fmt::format("Sweep: {}.", in_words(design, points.sweep().design)));
    const double all = each * static_cast<double>(design.n_points());
    log.line(
      fmt::format("  About {} a point (measured on {} of them): {} on one rank{}; results.h5 will have {}, results.csv "
                  "somewhat less.",
                  duration_in_words(each),
                  n_computed,
                  duration_in_words(all),
                  size_of(communicator) > 1
                    ? fmt::format(", {} on {}", duration_in_words(all / size_of(communicator)), size_of(communicator))
                    : "",
                  size_in_words(static_cast<double>(bytes * design.n_points()))));
    log.line(file.name() + " is in order: all swept names and values are admissible. Nothing was written.");
    return true;
  }
} // namespace crawler
