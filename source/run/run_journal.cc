// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/archive.h>
#include <crawler/base/clock.h>
#include <crawler/run/run_journal.h>

#include <algorithm>

namespace crawler
{
  RunJournal::RunJournal(const double interval, Write write)
    : interval_(interval)
    , write_(std::move(write))
    , last_(now())
  {
  }

  void
  RunJournal::load(std::string bytes)
  {
    Archive archive(std::move(bytes));
    archive(ended_, identity_, state_);
    was_written_ = true;
  }

  std::optional<SimulationResult>
  RunJournal::begin(std::string identity)
  {
    const std::size_t i = n_begun_++;
    if (i < ended_.size())
    {
      if (ended_[i].identity == identity)
        return ended_[i].result;
      ended_.resize(i);
      state_.clear();
    }
    else if (identity_ != identity)
      state_.clear();
    identity_ = std::move(identity);
    return std::nullopt;
  }

  bool
  RunJournal::is_due() const
  {
    constexpr double part = 0.05; // of the time, at most
    return writes() && now() - last_ >= std::max(interval_, cost_ / part);
  }

  void
  RunJournal::keep(std::string state)
  {
    state_ = std::move(state);
    write();
  }

  void
  RunJournal::end(const SimulationResult &result)
  {
    if (is_closed_)
      return;
    ended_.push_back({std::move(identity_), result});
    identity_.clear();
    state_.clear();
    if (is_due())
      write();
  }

  void
  RunJournal::write()
  {
    if (!writes())
      return;
    const double begin = now();
    Archive archive;
    archive(ended_, identity_, state_);
    if (!write_(archive.bytes()))
      return;
    last_        = now();
    cost_        = last_ - begin;
    was_written_ = true;
  }
} // namespace crawler
