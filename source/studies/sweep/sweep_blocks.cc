// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/core/study.h>
#include <crawler/studies/sweep/sweep_blocks.h>

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
} // namespace crawler
