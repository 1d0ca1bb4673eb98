// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/base/stop_signal.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/atlas/atlas.h>
#include <crawler/studies/atlas/atlas_results.h>
#include <crawler/studies/core/crash_file.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/python.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/core/table_csv.h>
#include <crawler/studies/sweep/point_table.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace crawler
{
  namespace
  {
    /// Reads both axes and looks at all their values. Throws InputError.
    AtlasAxes
    read_axes(const ParameterFile &file)
    {
      Parameters parameters;
      Declarations declarations;
      parameters.count_terms(file);
      parameters.add_parameters(declarations);
      file.apply(declarations);
      const std::string first_name = "Atlas/First axis", second_name = "Atlas/Second axis";
      const auto read = [&](const std::string &text, const std::string &name) {
        const Axis axis = parse_axis(text, name);
        for (const char *section : {"Sweep/", "Atlas/", "Tradeoff/"})
          if (axis.entry.starts_with(section))
            throw InputError(
              fmt::format("\"{}\": \"{}\" cannot vary; an entry of another section is expected", name, axis.entry),
              name);
        require_valid(axis, name, declarations);
        numbers_of(axis, name);
        return axis;
      };
      try
      {
        const AtlasParameters texts = parameters.atlas;
        AtlasAxes axes{read(texts.first_axis, first_name), read(texts.second_axis, second_name)};
        if (axes.first.entry == axes.second.entry)
          throw InputError(fmt::format("\"{}\" is on both axes; two different entries are expected", axes.first.entry),
                           second_name);
        if (parameters.model != Model::nonlinear)
          throw InputError(
            fmt::format("Model is {}, but an atlas compares formulations of the nonlinear model; Model = "
                        "nonlinear is expected",
                        word_of(parameters.model)),
            "Model");
        if (parameters.active_stress.generator == "strain feedback")
          throw InputError("Generator is strain feedback, but an atlas must know the stretch of the ends beforehand; "
                           "another one is expected",
                           "Active stress/Generator");
        return axes;
      }
      catch (const InputError &error)
      {
        throw file.with_place(error);
      }
    }

    /// So many points are computed together: enough to fill the lanes of the fused engine, unless ranks would wait.
    unsigned long
    points_together(const unsigned long n_points, const unsigned int n_ranks)
    {
      constexpr unsigned long most = 8, parts_per_rank = 8;
      return std::clamp(n_points / (parts_per_rank * n_ranks), 1ul, most);
    }

    /// The design of a sweep over both axes.
    SweepParameters
    design_of(const AtlasAxes &axes)
    {
      SweepParameters design;
      design.axes = fmt::format("{} : {}; {} : {}",
                                axes.first.entry,
                                fmt::join(axes.first.values, ", "),
                                axes.second.entry,
                                fmt::join(axes.second.values, ", "));
      return design;
    }

    /// The rows that are missing, by all ranks. Returns false if some rank was interrupted.
    bool
    compute_rows(MPI_Comm communicator,
                 const std::filesystem::path &folder,
                 SweepPoints &points,
                 const PointTable &table,
                 const std::vector<bool> &done,
                 const std::function<bool()> &interrupted,
                 Log &log)
    {
      std::vector<unsigned long> missing;
      const unsigned long n = points.design().n_points(), stride = golden_stride(n);
      for (unsigned long i = 0; i < n; ++i)
        if (const unsigned long point = i * stride % n; !done[point])
          missing.push_back(point);
      const auto columns = table.written_columns();
      RowFile rows(communicator, folder / table.file, table.group, columns);
      CrashNote note(folder);
      const PointsByCrashes sorted = by_crashes(missing, crashes_in(folder));
      if (rank_of(communicator) == 0)
        for (const unsigned long point : sorted.given_up)
          rows.write(point, {{atlas_row(columns, crashed_point())}});

      const unsigned long n_usual = sorted.usual.size(), together = points_together(n_usual, size_of(communicator)),
                          n_parts = (n_usual + together - 1) / together;
      return share_work(
        communicator,
        {n_parts + sorted.alone.size(),
         n_usual + sorted.alone.size(),
         "points",
         interrupted,
         [&](const unsigned long number, const auto &stops, const auto &see) {
           const auto own =
             number < n_parts
               ? std::span(sorted.usual).subspan(number * together, std::min(together, n_usual - number * together))
               : std::span(sorted.alone).subspan(number - n_parts, 1);
           std::vector<Parameters> parameters;
           for (const unsigned long point : own)
             parameters.push_back(points.parameters(point));
           note.at_work_on(own);
           const auto some = compute_points(parameters, stops);
           if (!some)
             return false;
           for (std::size_t i = 0; i < own.size(); ++i)
             rows.write(own[i], {{atlas_row(columns, (*some)[i])}});
           note.at_work_on({});
           see(some->size(), 0);
           return true;
         }},
        log);
    }
  } // namespace

  ExitCode
  atlas(MPI_Comm communicator, const CommandOptions &options)
  {
    const StopSignal stop_signal; // from here on a signal ends the atlas in order
    const double start = now();
    Log log(rank_of(communicator) == 0, options);
    const ParameterFile file   = read_file(communicator, options.file, options.overrides);
    const AtlasAxes axes       = read_axes(file);
    const auto path            = output_folder(options.output, options.file);
    const unsigned int n_ranks = size_of(communicator);
    SweepPoints points(communicator, file, design_of(axes));
    PointTable table = atlas_table(points);
    table.time_limit = points.parameters(0).atlas.time_limit;
    StudyFolder folder({"atlas", {table.file}, {"Atlas/Time limit per run"}}, path, options, log);
    const std::vector<bool> done =
      points_done(communicator, [&]() { return begin_or_resume(folder, table, file, points, options.command_line); });
    const auto n_done = std::count(done.begin(), done.end(), true);
    log.line(fmt::format("Atlas: {} values of {} times {} of {}, {} points on {}{}",
                         axes.first.values.size(),
                         axes.first.entry,
                         axes.second.values.size(),
                         axes.second.entry,
                         axes.n_points(),
                         counted(n_ranks, "rank"),
                         n_done > 0 ? fmt::format("; {} are done already", n_done) : ""));
    for (const std::string &note : points.notes("atlas", "Atlas/First axis"))
      log.line(note);

    const bool is_whole = compute_rows(
      communicator, path, points, table, done, [&]() { return stop_signal.arrived_anywhere(MPI_COMM_SELF); }, log);
    on_first_rank(communicator, [&]() {
      folder.require_in_place();
      return "";
    });
    write_table_csv(communicator, path / table.file, table.group, path / "atlas.csv", [](const Table &) {});
    on_first_rank(communicator, [&]() {
      const AtlasSummary summary = summarize(path, axes);
      const double seconds       = now() - start;
      const std::string status   = is_whole ? "finished" : "stopped";
      write_file(path / "summary.json", atlas_json(summary, axes, status, seconds, n_ranks, options.command_line));
      for (const std::string &answer : summary.wrong_answers)
        log.line("Silent wrong answer at " + answer);
      if (summary.silent_wrong_answers > summary.wrong_answers.size())
        log.line(fmt::format("... and {} more (column verdict of atlas.csv)",
                             summary.silent_wrong_answers - summary.wrong_answers.size()));
      log.line(in_words(summary, axes, seconds, n_ranks));
      if (!is_whole)
        log.warn(fmt::format(
          "stopped by a signal after {} of {} points; --resume goes on", summary.computed(), summary.points));
      draw("atlas", path, log);
      log.line(fmt::format("Results are in {}/.", path.string()));
      folder.leave();
      return "";
    });
    return is_whole ? ExitCode::finished : ExitCode::stopped;
  }
} // namespace crawler
