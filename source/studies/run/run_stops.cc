// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/clock.h>
#include <crawler/studies/run/run_stops.h>

#include <utility>

namespace crawler
{

  namespace
  {
    constexpr double between_looks = 0.5; ///< interval between looks for the file [s]
  }

  RunStops::RunStops(const StopSignal &signal,
                     const std::optional<double> limit,
                     const double start,
                     std::filesystem::path file)
    : signal_(signal)
    , limit_(limit)
    , start_(start)
    , file_(std::move(file))
    , next_look_(start + between_looks)
  {
  }

  bool
  RunStops::arrived()
  {
    if (signal_.arrived() || is_out_of_time_ || is_asked_)
      return true;
    const double time = now();
    is_out_of_time_   = limit_ && time - start_ >= *limit_;
    if (time >= next_look_)
    {
      std::error_code error;
      is_asked_  = std::filesystem::exists(file_, error);
      next_look_ = time + between_looks;
    }
    return is_out_of_time_ || is_asked_;
  }

  const char *
  RunStops::reason() const
  {
    return is_asked_ ? "stop_file" : is_out_of_time_ ? "time_limit" : "signal";
  }

  std::string
  RunStops::in_words() const
  {
    return is_asked_         ? "by the file \"" + file_.string() + "\""
           : is_out_of_time_ ? by_wall_time_limit(*limit_)
                             : "by a signal";
  }
} // namespace crawler
