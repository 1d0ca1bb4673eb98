// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/drivers/compute_similar.h>
#include <crawler/drivers/study.h>
#include <crawler/drivers/sweep_blocks.h>
#include <crawler/drivers/sweep_check.h>
#include <crawler/drivers/sweep_rows.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  std::string
  in_words(const SweepDesign &design, const std::string &design_name)
  {
    std::vector<std::string> axes;
    for (const SweepAxis &axis : design.axes())
      axes.push_back(axis.entry + (design_name == "grid" ? fmt::format(" ({} values)", axis.values.size()) : ""));
    return fmt::format("{} points, {} over {}", design.n_points(), design_name, fmt::join(axes, ", "));
  }

  bool
  check_sweep(MPI_Comm communicator, const ParameterFile &file, Log &log)
  {
    if (std::none_of(file.assignments().begin(),
                     file.assignments().end(),
                     [](const Assignment &assignment)
                     {
                       return assignment.path == "Sweep/Axes" && !assignment.value.empty();
                     }))
      return false;
    SweepPoints points(communicator, file);
    const SweepDesign &design = points.design();
    std::size_t bytes         = 0;
    for (const RowFile::Column &column : sweep_columns(design, points.declarations()))
      bytes += column.width == 0 ? sizeof(double) : column.width;
    // The time of a few blocks, spread over the sweep.
    constexpr unsigned long n_samples = 3;
    const SweepBlocks blocks(design);
    const double before      = now();
    unsigned long n_computed = 0;
    for (unsigned long i = 0; i < std::min<unsigned long>(n_samples, blocks.size()); ++i)
    {
      const SweepBlock block = blocks[i * (blocks.size() - 1) / std::max(n_samples - 1, 1ul)];
      std::vector<Task> tasks(block.size);
      for (unsigned long j = 0; j < block.size; ++j)
        tasks[j].parameters = points.parameters(block.first + j);
      const auto never = []()
      {
        return false;
      };
      auto done = compute_similar(tasks, std::vector<bool>(block.size, true), HUGE_VAL, never);
      for (unsigned long j = 0; j < block.size; ++j)
        if (!done[j])
          compute_all({&tasks[j], 1}, HUGE_VAL, never);
      n_computed += block.size;
    }
    const double each = (now() - before) / static_cast<double>(n_computed);
    log.line(fmt::format("Sweep: {}.", in_words(design, points.sweep().design)));
    log.line(fmt::format(
      "  About {:.2g} s a point (from {} of them): {:.3g} s on one rank{}; results.h5 will have {:.3g} MB.",
      each,
      n_computed,
      each * static_cast<double>(design.n_points()),
      size_of(communicator) > 1 ? fmt::format(", {:.3g} s on {}",
                                              each * static_cast<double>(design.n_points()) / size_of(communicator),
                                              size_of(communicator))
                                : "",
      static_cast<double>(bytes * design.n_points()) / 1e6));
    log.line(file.name() + " is in order: all swept names and values are admissible. Nothing was written.");
    return true;
  }
} // namespace crawler
