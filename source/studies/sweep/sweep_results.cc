// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/row_file.h>
#include <crawler/base/versions.h>
#include <crawler/studies/core/table_csv.h>
#include <crawler/studies/sweep/sweep_results.h>
#include <crawler/studies/sweep/sweep_rows.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace crawler
{
  namespace fs = std::filesystem;

  namespace
  {
    void
    count(const Table &table, SweepCounts &counts)
    {
      for (const Column &column : table)
      {
        const auto *texts = std::get_if<std::vector<std::string>>(&column.values);
        if (texts == nullptr || (column.name != "status" && column.name != "reason"))
          continue;
        for (const std::string &text : *texts)
          if (column.name == "status")
            ++counts.statuses[text.empty() ? "missing" : text];
          else if (!text.empty())
            ++counts.reasons[text];
      }
    }

    /// The sum over all ranks, on rank 0.
    SweepCounts
    sum(MPI_Comm communicator, const SweepCounts &counts)
    {
      SweepCounts all;
      all.n_points              = counts.n_points;
      const nlohmann::json mine = {counts.statuses, counts.reasons};
      for (const std::string &text :
           gather(mine.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace), communicator))
      {
        const auto json = nlohmann::json::parse(text);
        for (const auto &[name, n] : json[0].items())
          all.statuses[name] += n.get<unsigned long>();
        for (const auto &[name, n] : json[1].items())
          all.reasons[name] += n.get<unsigned long>();
      }
      return all;
    }
  } // namespace

  SweepCounts
  write_results_csv(MPI_Comm communicator, const fs::path &folder)
  {
    SweepCounts counts;
    counts.n_points = RowReader(communicator, folder / sweep_file, sweep_group).n_rows();
    write_table_csv(communicator, folder / sweep_file, sweep_group, folder / "results.csv", [&](const Table &part) {
      count(part, counts);
    });
    return sum(communicator, counts);
  }

  unsigned long
  n_computed(const SweepCounts &counts, const SweepEnd &end)
  {
    const auto missing = counts.statuses.find("missing");
    return counts.n_points - end.n_before - (missing == counts.statuses.end() ? 0 : missing->second);
  }

  std::string
  sweep_json(const SweepCounts &counts, const SweepEnd &end)
  {
    const nlohmann::ordered_json json = {
      {"status", end.status},
      {"reason", end.reason.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(end.reason)},
      {"points", counts.n_points},
      {"computed", n_computed(counts, end)},
      {"statuses", counts.statuses},
      {"reasons", counts.reasons},
      {"seconds", end.seconds},
      {"ranks", end.n_ranks},
      {"versions", versions()},
      {"command_line", end.command_line}};
    return json.dump(2, ' ', /*ensure_ascii=*/false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  }
} // namespace crawler
