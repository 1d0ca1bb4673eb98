// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/versions.h>
#include <crawler/studies/atlas/atlas_results.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    /// JSON has no number for what is not known; null stands for it.
    double
    number(const Json &json)
    {
      return json.is_null() ? AtlasRun::unknown : json.get<double>();
    }

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

    /// The column whose value at each point @p value tells.
    template <typename Function>
    Column
    column(const std::string &name,
           const std::string &unit,
           const std::string &description,
           const std::vector<AtlasPoint> &points,
           const Function &value)
    {
      std::vector<std::decay_t<decltype(value(points[0]))>> values;
      for (const AtlasPoint &point : points)
        values.push_back(value(point));
      return {name, unit, description, std::move(values)};
    }

    std::string
    explanation(const AtlasPoint &point)
    {
      return point.verdict.explanation.empty() ? point.runs[AtlasPoint::automatic].message : point.verdict.explanation;
    }

    std::string
    axis_in_words(const Axis &axis)
    {
      return fmt::format(
        "{} ({} values, {} to {})", axis.entry, axis.values.size(), axis.values.front(), axis.values.back());
    }
  } // namespace

  std::string
  pack(const std::vector<AtlasPoint> &points)
  {
    Json list = Json::array();
    for (const AtlasPoint &point : points)
    {
      Json runs = Json::array();
      for (const AtlasRun &run : point.runs)
      {
        Json one = {run.status, run.reason, run.message};
        for (const RunNumber &entry : run_numbers)
          one.push_back(run.*entry.member);
        runs.push_back(one);
      }
      list.push_back({point.index,
                      point.first,
                      point.second,
                      point.outcome,
                      static_cast<int>(point.verdict.kind),
                      point.verdict.explanation,
                      runs});
    }
    return list.dump(-1, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace);
  }

  std::vector<AtlasPoint>
  unpack(const std::string &text)
  {
    std::vector<AtlasPoint> points;
    for (const Json &json : Json::parse(text))
    {
      AtlasPoint point;
      point.index   = json[0];
      point.first   = json[1];
      point.second  = json[2];
      point.outcome = json[3];
      point.verdict = {static_cast<Verdict::Kind>(json[4].get<int>()), json[5]};
      for (std::size_t i = 0; i < point.runs.size(); ++i)
      {
        AtlasRun &run = point.runs[i];
        std::size_t j = 0;
        for (std::string *word : {&run.status, &run.reason, &run.message})
          *word = json[6][i][j++];
        for (const RunNumber &entry : run_numbers)
          run.*entry.member = number(json[6][i][j++]);
      }
      points.push_back(point);
    }
    return points;
  }

  Table
  atlas_table(const std::vector<AtlasPoint> &points, const AtlasAxes &axes)
  {
    Table table;
    const auto add =
      [&](const std::string &name, const std::string &unit, const std::string &description, const auto &value) {
        table.push_back(column(name, unit, description, points, value));
      };
    add("index", "1", "number of the point; the second axis varies fastest", [](const AtlasPoint &point) {
      return static_cast<double>(point.index);
    });
    add(axes.first.entry, axes.first_unit, "value on the first axis", [](const AtlasPoint &point) {
      return point.first;
    });
    add(axes.second.entry, axes.second_unit, "value on the second axis", [](const AtlasPoint &point) {
      return point.second;
    });
    add("outcome", "", "name of the point in the picture", [](const AtlasPoint &point) { return point.outcome; });
    add("verdict", "", "agree, unchecked or silent wrong answer", [](const AtlasPoint &point) {
      return point.verdict.in_words();
    });
    add("explanation", "", "of a wrong answer, or of what \"crawler run\" says if it does not finish", explanation);
    for (std::size_t i = 0; i < AtlasPoint::n_runs; ++i)
    {
      const std::string run = std::string(AtlasPoint::run_names[i]) + " ";
      add(run + "status",
          "",
          "finished, inverted, failed, stopped or refused; empty if this run was not asked for",
          [i](const AtlasPoint &point) { return point.runs[i].status; });
      add(run + "reason", "", "name of what went wrong", [i](const AtlasPoint &point) { return point.runs[i].reason; });
      for (const RunNumber &entry : run_numbers)
        add(run + entry.name, entry.unit, entry.description, [i, &entry](const AtlasPoint &point) {
          return point.runs[i].*entry.member;
        });
    }
    return table;
  }

  AtlasSummary
  summarize(const std::vector<AtlasPoint> &points, const AtlasAxes &axes)
  {
    AtlasSummary summary;
    summary.points = axes.n_points();
    for (const AtlasPoint &point : points)
    {
      const AtlasRun &run = point.runs[AtlasPoint::automatic];
      summary.finished += run.status == "finished";
      summary.inverted += run.status == "inverted";
      summary.failed += run.status == "failed";
      summary.stopped += run.status == "stopped";
      summary.refused += run.status == "refused";
      if (!run.reason.empty())
        ++summary.reasons[run.reason];
      summary.checked += point.verdict.kind != Verdict::unchecked;
      summary.silent_wrong_answers += point.verdict.kind == Verdict::silent_wrong_answer;
      for (const AtlasRun &one : point.runs)
      {
        const double ratio = one.measured_error / (one.promised_error + point.runs[AtlasPoint::refined].promised_error);
        summary.largest_error_ratio = std::fmax(summary.largest_error_ratio, ratio); // passes over what is not known
      }
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
      "{} "
      "rank{}.",
      axis_in_words(axes.first),
      axis_in_words(axes.second),
      summary.points,
      summary.computed() == summary.points ? "" : fmt::format(" ({} computed)", summary.computed()),
      summary.finished,
      summary.inverted,
      summary.failed,
      summary.stopped,
      summary.refused,
      reasons.empty() ? "" : fmt::format(" ({})", fmt::join(reasons, ", ")),
      summary.checked,
      summary.silent_wrong_answers,
      std::isnan(summary.largest_error_ratio)
        ? ""
        : fmt::format("The largest measured error is {:.2g} of the reported one. ", summary.largest_error_ratio),
      seconds,
      n_ranks,
      n_ranks == 1 ? "" : "s");
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
                       {"finished", summary.finished},
                       {"inverted", summary.inverted},
                       {"failed", summary.failed},
                       {"stopped", summary.stopped},
                       {"refused", summary.refused},
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
