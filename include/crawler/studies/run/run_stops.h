// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/communication.h>
#include <crawler/base/stop_signal.h>

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>

namespace crawler
{
  /// Name of the file in the output folder whose presence asks the run to stop.
  inline const std::string stop_file_name = "stop";

  /// Limit in words for the user; also of runs without files.
  inline std::string
  by_wall_time_limit(const double limit)
  {
    return fmt::format("by Time/Wall time limit, {:g} s,", limit);
  }

  /// Reasons to stop a run that could go on: a signal, its wall time, or a file that asks for it.
  class RunStops
  {
  public:
    /// @p limit of the wall time [s] since @p start (base/clock.h), if there is one; @p file as above.
    RunStops(const StopSignal &signal, std::optional<double> limit, double start, std::filesystem::path file);

    /// Returns true, from then on, once the run is to stop on any rank (collective).
    bool
    arrived_anywhere(MPI_Comm communicator)
    {
      return is_true_anywhere(arrived(), communicator);
    }

    /// Reason: "signal", "time_limit" or "stop_file"; and in words, "by ...".
    const char *
    reason() const;
    std::string
    in_words() const;

  private:
    bool
    arrived();

    const StopSignal &signal_;
    const std::optional<double> limit_;
    const double start_;
    const std::filesystem::path file_;
    double next_look_    = 0.; ///< time of the next look for the file
    bool is_out_of_time_ = false, is_asked_ = false;
  };
} // namespace crawler
