// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/plain_numbers.h>
#include <crawler/base/versions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/atlas/atlas_results.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    /// A column of AtlasRun: its name behind that of the run.
    struct RunNumber
    {
      const char *name, *unit, *description;
      double AtlasRun::*member;
    };
    constexpr RunNumber run_numbers[] = {
      {"displacement",
       "length",
       "displacement of the centre of mass at the end time, if finished",
       &AtlasRun::displacement},
      {"promised error", "length", "error of the displacement that Accuracy stands for", &AtlasRun::promised_error},
      {"measured error",
       "length",
       "difference of the displacement to that of the refined run",
       &AtlasRun::measured_error},
      {"inversion s", "length", "where the body inverted", &AtlasRun::inversion_s},
      {"inversion t", "time", "when the body inverted", &AtlasRun::inversion_t},
      {"min stretch", "1", "smallest stretch over body and time", &AtlasRun::min_stretch},
      {"steps", "1", "accepted time steps", &AtlasRun::steps},
      {"seconds", "s", "wall time, choice of the numerics included", &AtlasRun::seconds}};

    /// Another column: texts of at most `width` bytes.
    struct PointText
    {
      const char *name, *description;
      unsigned int width;
      std::string (*value)(const AtlasPoint &);
    };

    std::string
    explanation(const AtlasPoint &point)
    {
      return point.verdict.explanation.empty() ? point.runs[AtlasPoint::automatic].message : point.verdict.explanation;
    }

    const PointText point_texts[] = {
      {"outcome",
       "name of the point in the picture; empty: not computed yet",
       48,
       [](const AtlasPoint &point) { return point.outcome; }},
      {"verdict",
       "agree, unchecked or silent wrong answer",
       24,
       [](const AtlasPoint &point) { return point.verdict.in_words(); }},
      {"explanation", "of a wrong answer, or of what \"crawler run\" says if it does not finish", 256, explanation}};
    constexpr std::pair<const char *, std::string AtlasRun::*> run_texts[] = {{"status", &AtlasRun::status},
                                                                              {"reason", &AtlasRun::reason}};

    std::string
    axis_in_words(const Axis &axis)
    {
      return fmt::format(
        "{} ({} values, {} to {})", axis.entry, axis.values.size(), axis.values.front(), axis.values.back());
    }
  } // namespace

  PointTable
  atlas_table(const SweepPoints &points)
  {
    PointTable table = {"atlas.h5",
                        "atlas",
                        axis_columns(points.design(), points.declarations(), "axis of the atlas"),
                        3,
                        point_texts[0].name,
                        {},
                        0.};
    for (const PointText &text : point_texts)
      table.columns.push_back({text.name, "", text.description, text.width});
    for (const char *name : AtlasPoint::run_names)
    {
      const std::string run = std::string(name) + " ";
      table.columns.push_back({run + "status",
                               "",
                               "finished, inverted, failed, stopped or refused; empty if this run was not asked for",
                               24});
      table.columns.push_back({run + "reason", "", "name of what went wrong", 32});
      for (const RunNumber &entry : run_numbers)
        table.columns.push_back({run + entry.name, entry.unit, entry.description, 0});
      table.reasons_and_seconds.emplace_back(run + "reason", run + "seconds");
    }
    return table;
  }

  RowFile::Row
  atlas_row(const std::vector<RowFile::Column> &columns, const AtlasPoint &point)
  {
    std::map<std::string, RowFile::Value> values;
    for (const PointText &text : point_texts)
      values.emplace(text.name, shortened(text.value(point), text.width));
    for (std::size_t i = 0; i < AtlasPoint::n_runs; ++i)
    {
      const std::string run = std::string(AtlasPoint::run_names[i]) + " ";
      for (const auto &[name, member] : run_texts)
        values.emplace(run + name, point.runs[i].*member);
      for (const RunNumber &entry : run_numbers)
        values.emplace(run + entry.name, point.runs[i].*entry.member);
    }
    RowFile::Row row;
    for (const RowFile::Column &column : columns)
      row.push_back(values.at(column.name));
    return row;
  }

  AtlasSummary
  summarize(const std::filesystem::path &folder, const AtlasAxes &axes)
  {
    constexpr std::size_t most_wrong_answers = 10;
    using Texts                              = std::vector<std::string>;
    using Numbers                            = std::vector<double>;
    const RowReader rows(MPI_COMM_SELF, folder / "atlas.h5", "atlas");
    const auto column = [&](const std::string &name) {
      return rows.read(rows.index_of(name), 0, rows.n_rows()).values;
    };
    const auto texts    = [&](const std::string &name) { return std::get<Texts>(column(name)); };
    const auto numbers  = [&](const std::string &name) { return std::get<Numbers>(column(name)); };
    const Texts outcome = texts("outcome"), status = texts("run status"), reason = texts("run reason"),
                verdict = texts("verdict"), explanation = texts("explanation");
    const Numbers first = numbers(axes.first.entry), second = numbers(axes.second.entry),
                  promised = numbers("refined promised error");
    AtlasSummary summary;
    summary.points = axes.n_points();
    for (std::size_t i = 0; i < outcome.size(); ++i)
    {
      if (outcome[i].empty())
        continue;
      ++summary.statuses[status[i]];
      if (!reason[i].empty())
        ++summary.reasons[reason[i]];
      const bool is_wrong = verdict[i] == Verdict{Verdict::silent_wrong_answer, ""}.in_words();
      summary.checked += verdict[i] != Verdict{}.in_words();
      summary.silent_wrong_answers += is_wrong;
      if (is_wrong && summary.wrong_answers.size() < most_wrong_answers)
        summary.wrong_answers.push_back(fmt::format("{} = {:g}, {} = {:g}: {}",
                                                    split_path(axes.first.entry).back(),
                                                    first[i],
                                                    split_path(axes.second.entry).back(),
                                                    second[i],
                                                    explanation[i]));
    }
    for (const char *name : AtlasPoint::run_names)
    {
      const std::string run  = std::string(name) + " ";
      const Numbers measured = numbers(run + "measured error"), own = numbers(run + "promised error");
      for (std::size_t i = 0; i < outcome.size(); ++i) // fmax passes over what is not known
        summary.largest_error_ratio = std::fmax(summary.largest_error_ratio, measured[i] / (own[i] + promised[i]));
    }
    return summary;
  }

  std::string
  in_words(const AtlasSummary &summary, const AtlasAxes &axes, const double seconds, const unsigned int n_ranks)
  {
    std::vector<std::string> reasons;
    for (const auto &[reason, count] : summary.reasons)
      reasons.push_back(fmt::format("{} {}", reason, count));
    return fmt::format(
      "Atlas over {} and {}: {} points{}, {} finished, {} inverted, {} failed with a name, {} stopped, {} refused{}. "
      "{} points could be cross-checked; {} disagree beyond the reported error (silent wrong answers). {}{:.0f} s on "
      "{}.",
      axis_in_words(axes.first),
      axis_in_words(axes.second),
      summary.points,
      summary.computed() == summary.points ? "" : fmt::format(" ({} computed)", summary.computed()),
      summary.number("finished"),
      summary.number("inverted"),
      summary.number("failed"),
      summary.number("stopped"),
      summary.number("refused"),
      reasons.empty() ? "" : fmt::format(" ({})", fmt::join(reasons, ", ")),
      summary.checked,
      summary.silent_wrong_answers,
      std::isnan(summary.largest_error_ratio)
        ? ""
        : fmt::format("The largest measured error is {:.2g} of the reported one. ", summary.largest_error_ratio),
      seconds,
      counted(n_ranks, "rank"));
  }

  std::string
  atlas_json(const AtlasSummary &summary,
             const AtlasAxes &axes,
             const std::string &status,
             const double seconds,
             const unsigned int n_ranks,
             const std::string &command_line)
  {
    const Json json = {{"status", status},
                       {"first_axis", {{"entry", axes.first.entry}, {"values", axes.first.values.size()}}},
                       {"second_axis", {{"entry", axes.second.entry}, {"values", axes.second.values.size()}}},
                       {"points", summary.points},
                       {"computed", summary.computed()},
                       {"finished", summary.number("finished")},
                       {"inverted", summary.number("inverted")},
                       {"failed", summary.number("failed")},
                       {"stopped", summary.number("stopped")},
                       {"refused", summary.number("refused")},
                       {"reasons", summary.reasons},
                       {"checked", summary.checked},
                       {"silent_wrong_answers", summary.silent_wrong_answers},
                       {"largest_error_ratio", summary.largest_error_ratio},
                       {"inversion_time_tolerance", inversion_time_tolerance},
                       {"seconds", seconds},
                       {"ranks", n_ranks},
                       {"versions", versions()},
                       {"command_line", command_line}};
    return json.dump(2, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace) + "\n";
  }
} // namespace crawler
