// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/base/versions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/sensitivities.h>
#include <crawler/studies/sweep/sweep_rows.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace crawler
{
  namespace
  {
    constexpr unsigned int word_width = 24, reason_width = 32, message_width = 256;

    bool
    are_uncertain(const std::vector<SensitivityEntry> &entries)
    {
      return std::ranges::any_of(entries, [](const SensitivityEntry &one) { return one.deviation > 0.; });
    }

    constexpr std::size_t max_wrong_answers = 10;

    void
    count(const Table &table, SweepCounts &counts)
    {
      using Texts   = std::vector<std::string>;
      using Numbers = std::vector<double>;
      for (const auto &[name, unit, description, values] : table)
        if (name == "status")
          for (const std::string &text : std::get<Texts>(values))
            ++counts.statuses[text.empty() ? "missing" : text];
        else if (name == "reason" || name == "verdict")
        {
          for (const std::string &text : std::get<Texts>(values))
            if (!text.empty())
              ++(name == "reason" ? counts.reasons : counts.verdicts)[text];
        }
        else if (name == "explanation")
        {
          const auto &texts = std::get<Texts>(values);
          const auto &index = std::get<Numbers>(table.front().values);
          for (std::size_t i = 0; i < texts.size() && counts.wrong_answers.size() < max_wrong_answers; ++i)
            if (!texts[i].empty())
              counts.wrong_answers.emplace(index[i], texts[i]);
        }
        else if (name.ends_with("error ratio"))
          for (const double ratio : std::get<Numbers>(values))
            counts.largest_error_ratio = std::fmax(counts.largest_error_ratio, ratio);
    }
  } // namespace

  std::vector<RowFile::Column>
  sweep_columns(const SweepPoints &points)
  {
    std::vector<RowFile::Column> columns = axis_columns(points.design(), points.declarations());
    for (const ResultEntry &entry : result_table())
      if (!entry.of_process)
        columns.push_back({entry.key, entry.unit, entry.meaning, entry.is_word ? word_width : 0});
    for (const SensitivityEntry &entry : points.sensitivities())
      for (const std::string number : differentiated_numbers)
      {
        const std::string key =
          fmt::format("sensitivities.{}.{}", entry.path, number == "displacement" ? "" : number + ".");
        const std::string unit = entry_of(number).unit + " per unit of the entry";
        columns.push_back({key + "value", unit, fmt::format("d({})/d({})", number, entry.path), 0});
        columns.push_back({key + "error", unit, "bound of the error of this derivative", 0});
      }
    if (are_uncertain(points.sensitivities()))
      for (const std::string number : differentiated_numbers)
        columns.push_back({"uncertainty." + number,
                           entry_of(number).unit,
                           "standard deviation of " + number + " from that of the uncertain entries",
                           0});
    if (points.sweep().cross_check)
      std::ranges::move(checked_columns(), std::back_inserter(columns));
    columns.push_back({"seconds", "s", "wall time of the point; points that were computed side by side share it", 0});
    columns.push_back({"reason", "", "name of what went wrong", reason_width});
    columns.push_back({"message", "", "what went wrong, in a sentence", message_width});
    columns.push_back({"status", "", "finished, inverted, failed or stopped; empty: not computed yet", word_width});
    return columns;
  }

  RowFile::Row
  sweep_row(const Task &task, const std::vector<SensitivityEntry> &sensitivities, const RowFile::Row &checked)
  {
    const PointStatus status = status_of(task);
    RowFile::Row row;
    for (const ResultEntry &entry : result_table())
      if (!entry.of_process)
        row.push_back(value_in_row(task, entry));
    const SimulationResult &result = task.computed.result;
    for (const SensitivityEntry &entry : sensitivities)
      for (const std::string number : differentiated_numbers)
      {
        const auto one   = std::ranges::find(result.sensitivities, entry.path, &EntrySensitivity::entry);
        const auto known = one != result.sensitivities.end() ? one->of(number) : std::nullopt;
        row.insert(row.end(), {known ? known->value : NAN, known ? known->error : NAN});
      }
    if (are_uncertain(sensitivities))
      for (const std::string number : differentiated_numbers)
        row.emplace_back(result.standard_deviation(number).value_or(NAN));
    row.insert(row.end(), checked.begin(), checked.end());
    row.insert(row.end(), {task.seconds, status.reason, shortened(status.message, message_width), status.status});
    return row;
  }

  SweepCounts
  write_results_csv(MPI_Comm communicator,
                    const std::filesystem::path &folder,
                    const std::string &file,
                    const std::string &group)
  {
    constexpr unsigned long together = 4096; // rows in memory
    const auto path                  = folder / file;
    write_table_csv(communicator, path, group);
    SweepCounts counts;
    on_first_rank(communicator, [&]() {
      const RowReader table(MPI_COMM_SELF, path, group);
      counts.n_points = table.n_rows();
      for (unsigned long first = 0; first < counts.n_points; first += together)
        count(table.read(first, std::min(together, counts.n_points - first)), counts);
    });
    return counts;
  }

  unsigned long
  SweepCounts::number_of(const Verdict::Kind kind) const
  {
    const auto found = verdicts.find(word_of(kind));
    return found == verdicts.end() ? 0 : found->second;
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
    nlohmann::ordered_json json = {
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
    if (!counts.verdicts.empty())
      json["cross_check"] = {{"checked", counts.checked()},
                             {"silent_wrong_answers", counts.number_of(Verdict::silent_wrong_answer)},
                             {"largest_error_ratio", counts.largest_error_ratio}};
    return json.dump(2, ' ', /*ensure_ascii=*/false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  }
} // namespace crawler
