// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/studies/sweep/point_table.h>
#include <crawler/studies/sweep/run_values.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  const ResultEntry &
  entry_of(const std::string &key)
  {
    return *std::ranges::find(result_table(), key, &ResultEntry::key);
  }

  RowFile::Value
  value_in_row(const Task &task, const ResultEntry &entry)
  {
    const SimulationResult &result = task.computed.result;
    const ResultValue value = task.error || result.time.status == Status::none ? ResultValue() : entry.value_in(result);
    if (entry.is_word)
      return std::get<std::string>(value.index() == 0 ? ResultValue(std::string()) : value);
    if (const auto *number = std::get_if<double>(&value))
      return std::isfinite(*number) ? *number : std::numeric_limits<double>::quiet_NaN();
    if (const auto *count = std::get_if<unsigned long>(&value))
      return static_cast<double>(*count);
    return std::numeric_limits<double>::quiet_NaN();
  }

  PointStatus
  status_of(const Task &task)
  {
    if (task.error)
      try
      {
        std::rethrow_exception(task.error);
      }
      catch (const InputError &error)
      {
        return {"failed", "refused", error.what()};
      }
    if (task.is_out_of_time)
      return {
        "stopped",
        time_limit_reason,
        task.computed.result.time.status == Status::finished
          ? "it took longer than Sweep/Time limit per point while its errors were measured; the run itself is complete"
          : "it took longer than Sweep/Time limit per point"};
    const TimeOutcome &time = task.computed.result.time;
    return time.status == Status::finished ? PointStatus{word_of(time.status), "", ""}
                                           : PointStatus{word_of(time.status), time.reason, time.message};
  }
} // namespace crawler
