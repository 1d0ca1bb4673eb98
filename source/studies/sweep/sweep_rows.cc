// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/run/summary.h>
#include <crawler/studies/sweep/point_table.h>
#include <crawler/studies/sweep/sweep_rows.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <map>

namespace crawler
{
  const std::string sweep_file = "results.h5", sweep_group = "results";

  namespace
  {
    using Json = nlohmann::ordered_json;

    constexpr double not_known        = std::numeric_limits<double>::quiet_NaN();
    constexpr unsigned int word_width = 24, reason_width = 32, message_width = 256;

    /// What is said of the process, not of the point, or has a column of its own.
    bool
    is_left_out(const std::string &key)
    {
      for (const char *other :
           {"status", "reason", "message", "seconds", "versions", "command_line", "ranks", "cells_shared"})
        if (key == other)
          return true;
      return false;
    }

    /// Calls @p see with each value that has no parts and its name, dots for nesting.
    template <typename Function>
    void
    for_each_value(const Json &json, const std::string &prefix, const Function &see)
    {
      for (const auto &[key, value] : json.items())
      {
        if (prefix.empty() && is_left_out(key))
          continue;
        const std::string name = prefix.empty() ? key : prefix + "." + key;
        if (value.is_object())
          for_each_value(value, name, see);
        else
          see(name, value);
      }
    }

    /// A summary in which everything is known.
    Json
    full_summary()
    {
      SimulationResult result;
      result.displacement = 0.;
      result.integrator   = "radau 9";
      result.engine       = "fused";
      result.error        = DisplacementError{0., 0., 0., 0.};
      result.errors.emplace();
      result.energy_balance  = EnergyBalance{};
      result.inversion       = SimulationResult::Extreme{};
      result.inversion_error = 0.;
      result.cycles          = Cycles{1., 1, 1, 0.};
      result.gait            = Gait{1., true, 1., 1., StretchWave{1., 1.}, EnergyBalance{}};
      result.gait_efficiency = 1.;
      result.mesh            = SimulationResult::Mesh{1, 1, 1, false};
      return summary_of(result, Parameters());
    }

    /// Units of the keys, as in doc/user_guide.md.
    std::string
    unit_of_key(const std::string &key)
    {
      const std::string error = "errors.";
      if (key.starts_with(error))
        return unit_of_key(key.substr(error.size()));
      static const std::map<std::string, std::string> units = {{"displacement", "length"},
                                                               {"displacement_error.total", "length"},
                                                               {"displacement_error.space", "length"},
                                                               {"displacement_error.time", "length"},
                                                               {"displacement_error.model", "length"},
                                                               {"end_time", "time"},
                                                               {"cycles.period", "time"},
                                                               {"cycles.error", "length"},
                                                               {"stress_power", "force length"},
                                                               {"dissipation", "force length"},
                                                               {"elastic_energy", "force length"},
                                                               {"paper_energy", "force length"},
                                                               {"positive_power", "force length"},
                                                               {"inversion.error", "time"},
                                                               {"inversion.s_first", "length"},
                                                               {"inversion.s_last", "length"},
                                                               {"gait.period", "time"},
                                                               {"gait.frequency", "1/time"},
                                                               {"gait.displacement", "length"},
                                                               {"gait.speed", "length/time"},
                                                               {"gait.cost_of_transport.stress_power", "force"},
                                                               {"gait.cost_of_transport.positive_power", "force"},
                                                               {"gait.cost_of_transport.paper_energy", "force"},
                                                               {"gait.cost_of_transport.dissipation", "force"},
                                                               {"gait.wave.speed", "length/time"}};
      if (key.ends_with(".s"))
        return "length";
      if (key.ends_with(".t"))
        return "time";
      const auto found = units.find(key);
      return found == units.end() ? "1" : found->second;
    }

    RowFile::Value
    value_of(const Json &json, const bool is_text)
    {
      if (is_text)
        return json.is_string() ? json.get<std::string>() : std::string();
      if (json.is_boolean())
        return json.get<bool>() ? 1. : 0.;
      return json.is_number() ? json.get<double>() : not_known;
    }
  } // namespace

  std::vector<RowFile::Column>
  sweep_columns(const SweepDesign &design, const Declarations &declarations)
  {
    std::vector<RowFile::Column> columns = axis_columns(design, declarations);
    for_each_value(full_summary(), "", [&](const std::string &key, const Json &value) {
      const bool is_text = value.is_string();
      columns.push_back({key, is_text ? "" : unit_of_key(key), "as in summary.json", is_text ? word_width : 0});
    });
    columns.push_back(
      {"seconds", "s", "wall time of the point; points that were computed side by side share theirs", 0});
    columns.push_back({"reason", "", "name of what went wrong", reason_width});
    columns.push_back({"message", "", "what went wrong, in a sentence", message_width});
    columns.push_back({"status", "", "finished, inverted, failed or stopped; empty: not computed yet", word_width});
    return columns;
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
        task.computed.result.time.status == "finished"
          ? "it took longer than Sweep/Time limit per point when its errors were measured; the run itself is whole"
          : "it took longer than Sweep/Time limit per point"};
    const TimeOutcome &time = task.computed.result.time;
    return time.status == "finished" ? PointStatus{time.status, "", ""}
                                     : PointStatus{time.status, time.reason, time.message};
  }

  RowFile::Row
  sweep_row(const std::vector<RowFile::Column> &columns, const Task &task)
  {
    const PointStatus status = status_of(task);
    RowFile::Row row;
    for (const RowFile::Column &column : columns)
      row.push_back(column.width > 0 ? RowFile::Value(std::string()) : RowFile::Value(not_known));
    const auto column = [&](const std::string &name, std::size_t first) {
      while (first < columns.size() && columns[first].name != name)
        ++first;
      return first;
    };
    // The keys come in the order of the columns; a part that is not known as a whole has none.
    std::size_t next = 0;
    if (!task.error && !task.computed.result.time.status.empty())
      for_each_value(
        summary_of(task.computed.result, task.parameters), "", [&](const std::string &key, const Json &value) {
          const std::size_t found = column(key, next);
          if (found == columns.size())
            return;
          row[found] = value_of(value, columns[found].width > 0);
          next       = found + 1;
        });
    row[column("seconds", next)] = task.seconds;
    row[column("reason", next)]  = status.reason;
    row[column("message", next)] = shortened(status.message, message_width);
    row[column("status", next)]  = status.status;
    return row;
  }
} // namespace crawler
