// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>

#include <concepts>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /**
   * What is known of the runs that make an answer, one after the other: results of those that have ended, and the state
   * of the one that goes on. An answer is made in the same way each time, so a later process takes its runs from here
   * until it comes to the one that was broken off, and goes on within it. Every rank has one; one of them writes.
   */
  class RunJournal
  {
  public:
    using Write = std::function<bool(const std::string &bytes)>; ///< false: it could not be kept yet

    /// @p write keeps all that is known; it is called after each @p interval [s] of wall time, and at stop(). Empty: of
    /// a rank that writes nothing.
    RunJournal(double interval, Write write);

    /// Goes on with what was written. Throws FileError if that was not by this program.
    void
    load(std::string bytes);

    /// The next run begins, with all that decides on it as bytes: its result, if it is known. If another run was here
    /// before, what was known of this one and those after it is forgotten.
    std::optional<SimulationResult>
    begin(std::string identity);

    /// The state in which the run that has begun was left; null if it starts.
    const std::string *
    state() const
    {
      return state_ && !state_->empty() ? &*state_ : nullptr;
    }

    bool
    writes() const
    {
      return write_ && !is_closed_;
    }

    /// Is it time for a state?
    bool
    is_due() const;

    /// The state of the run that has begun; written at once.
    void
    keep(std::string state);

    /// The end of the run that has begun.
    void
    end(const SimulationResult &result);

    /// Writes what is known, without a state.
    void
    write();

    /// Nothing is written any more: the runs are being stopped.
    void
    close()
    {
      is_closed_ = true;
    }

    /// Has anything been written by this process or by one before?
    bool
    was_written() const
    {
      return was_written_;
    }

  private:
    struct Entry
    {
      std::string identity;
      SimulationResult result;

      void
      exchange(Archive &archive);
    };

    const double interval_;
    const Write write_;
    double begin_, last_, cost_ = 0.; ///< of the latest write [s]
    std::vector<Entry> ended_;
    std::size_t n_begun_ = 0; ///< runs of this process
    std::string identity_;    ///< of the run that goes on
    std::optional<std::string> state_;
    bool is_closed_ = false, was_written_ = false;
  };

  /// Asked after every step whether a run may go on; with a journal, if there is one. Without a question the answer is
  /// always yes.
  class KeepGoing
  {
  public:
    KeepGoing() = default;

    template <typename Question>
    requires(std::is_invocable_r_v<bool, Question &> && !std::same_as<Question, KeepGoing>) // NOLINTNEXTLINE
      KeepGoing(Question question, RunJournal *journal = nullptr)
      : question_(std::move(question))
      , journal_(journal)
    {
    }

    explicit operator bool() const
    {
      return static_cast<bool>(question_);
    }
    bool
    operator()() const
    {
      return !question_ || question_();
    }
    RunJournal *
    journal() const
    {
      return journal_;
    }

  private:
    std::function<bool()> question_;
    RunJournal *journal_ = nullptr;
  };
} // namespace crawler
