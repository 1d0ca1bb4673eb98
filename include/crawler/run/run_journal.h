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
   * Journal of the runs that make an answer, one after the other: results of those that have ended, and the state of
   * the present one. An answer is made in the same way each time, so a later process takes its runs from here until it
   * comes to the one that was interrupted, and continues it. Every rank has one; one of them writes.
   */
  class RunJournal
  {
  public:
    using Write = std::function<bool(const std::string &bytes)>; ///< returns false if the bytes could not be kept yet

    /// @p write keeps the bytes of the journal; it is called after each @p interval [s] of wall time, and at stop().
    /// Empty on a rank that writes nothing.
    RunJournal(double interval, Write write);

    /// Continues from what was written. Throws FileError if that was not by this program.
    void
    load(std::string bytes);

    /// Begins the next run, identified by all inputs that decide on it as bytes: returns its result, if it is known. If
    /// another run was here before, its entry and all later ones are forgotten.
    std::optional<SimulationResult>
    begin(std::string identity);

    /// State in which the present run was left; null if it starts.
    const std::string *
    state() const
    {
      return state_.empty() ? nullptr : &state_;
    }

    /// True if the next run to begin has ended before, or has a state; unless begin() finds it to be another one.
    bool
    knows_next() const
    {
      return n_begun_ < ended_.size() || !state_.empty();
    }

    bool
    writes() const
    {
      return write_ && !is_closed_;
    }

    /// True if a state is due.
    bool
    is_due() const;

    /// Keeps the state of the present run; written at once.
    void
    keep(std::string state);

    /// Ends the present run.
    void
    end(const SimulationResult &result);

    /// Writes the journal, without a state.
    void
    write();

    /// Stops writing: the runs are being stopped.
    void
    close()
    {
      is_closed_ = true;
    }

    /// True if this process or one before has written anything.
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
      exchange(Archive &archive)
      {
        archive(identity, result);
      }
    };

    const double interval_;
    const Write write_;
    double last_, cost_ = 0.; ///< time and cost of the latest write [s]
    std::vector<Entry> ended_;
    std::size_t n_begun_ = 0; ///< runs of this process
    std::string identity_;    ///< of the present run
    std::string state_;       ///< of the present run; empty if it starts
    bool is_closed_ = false, was_written_ = false;
  };

  /// Question asked after every step, whether a run may go on; with a journal, if there is one. Without a question the
  /// answer is always yes.
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
