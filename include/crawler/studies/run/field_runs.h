// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/form.h>
#include <crawler/studies/run/run_in_memory.h>

#include <functional>
#include <string>
#include <vector>

namespace crawler
{
  /**
   * Runs of a parameter file with other numbers, of which only the fields at some times and places are wanted, as a fit
   * compares them with data. The file is read once, and a run has no estimate of its error, no gait and no energies: it
   * takes a third of the time of a run in memory, or less if it has the numerics of a similar one.
   */
  class FieldRuns
  {
  public:
    /// @p paths: entries with other numbers. Throws InputError, as read_input() does.
    FieldRuns(ParameterFile file, std::vector<std::string> paths);
    FieldRuns(const FieldRuns &) = delete;

    /**
     * Run with other @p numbers, in the sequence of the entries. If @p is_similar it has the level and numerics of the
     * last run that was not, so that their differences are smooth; fields_wanted() is asked for the length of the body.
     * @p start is called before the first run on a mesh. Throws InputError.
     */
    RunInMemory
    run(const std::vector<double> &numbers,
        bool is_similar,
        const std::function<WantedFields(const Scene &)> &fields_wanted,
        const std::function<void()> &start,
        const std::function<bool()> &interrupted);

  private:
    /// Takes the numbers into the scene of the input.
    void
    take(const std::vector<double> &numbers);

    const std::vector<std::string> paths_;
    Form form_;
    Input input_;
    std::optional<ModelChoice> model_; ///< of the last run that was not similar to another one
    std::optional<NumericsChoice> numerics_;
  };
} // namespace crawler
