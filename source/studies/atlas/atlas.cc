// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/stop_signal.h>
#include <crawler/base/work_queue.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/atlas/atlas.h>
#include <crawler/studies/atlas/atlas_results.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/study.h>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace crawler
{
  namespace
  {
    /// The parameter file as a form in which the two entries of the axes can be filled in.
    class Form
    {
    public:
      explicit Form(const ParameterFile &file)
      {
        parameters_.count_terms(file);
        parameters_.add_parameters(declarations_);
        file.apply(declarations_);
      }
      Form(const Form &) = delete;

      const Parameters &
      parameters() const
      {
        return parameters_;
      }

      const Parameters &
      filled(const AtlasAxes &axes, const unsigned long index)
      {
        declarations_.set(axes.first.entry, axes.first.values[index / axes.second.values.size()]);
        declarations_.set(axes.second.entry, axes.second.values[index % axes.second.values.size()]);
        return parameters_;
      }

      Declarations &
      declarations()
      {
        return declarations_;
      }

      std::string
      text() const
      {
        std::ostringstream out;
        declarations_.print_prm(out);
        return out.str();
      }

    private:
      Parameters parameters_;
      Declarations declarations_; ///< its entries are the members of parameters_
    };

    std::string
    unit_of(const std::string &path, const Declarations &declarations)
    {
      for (const EntryInfo &entry : declarations.entries())
        if (entry.path == path)
          return entry.unit;
      return "";
    }

    /// Reads both axes and looks at all their values. Throws InputError.
    AtlasAxes
    read_axes(const ParameterFile &file)
    {
      Form scratch(file);
      const std::string first_name = "Atlas/First axis", second_name = "Atlas/Second axis";
      const auto read = [&](const std::string &text, const std::string &name) {
        const Axis axis = parse_axis(text, name);
        if (axis.entry.starts_with("Atlas/"))
          throw InputError(
            fmt::format("\"{}\": \"{}\" cannot vary; an entry of another section is expected", name, axis.entry), name);
        require_valid(axis, name, scratch.declarations());
        numbers_of(axis, name);
        return axis;
      };
      try
      {
        const AtlasParameters texts = scratch.parameters().atlas;
        AtlasAxes axes{read(texts.first_axis, first_name), read(texts.second_axis, second_name), "", ""};
        if (axes.first.entry == axes.second.entry)
          throw InputError(fmt::format("\"{}\" is on both axes; two different entries are expected", axes.first.entry),
                           second_name);
        if (const std::string &model = scratch.parameters().model; model != "nonlinear")
          throw InputError(
            fmt::format("Model is {}, but an atlas compares formulations of the nonlinear model; Model = "
                        "nonlinear is expected",
                        model),
            "Model");
        if (scratch.parameters().active_stress.generator == "strain feedback")
          throw InputError("Generator is strain feedback, but an atlas must know the stretch of the ends beforehand; "
                           "another one is expected",
                           "Active stress/Generator");
        axes.first_unit  = unit_of(axes.first.entry, scratch.declarations());
        axes.second_unit = unit_of(axes.second.entry, scratch.declarations());
        return axes;
      }
      catch (const InputError &error)
      {
        throw file.with_place(error);
      }
    }

    /**
     * The rows of one rank as they come, in a file of their own (OUTPUT/rows/RANK.csv), so that a job that is killed
     * loses none. The tables at the end replace it.
     */
    class RowWriter
    {
    public:
      RowWriter(const std::filesystem::path &folder, const unsigned int rank, const AtlasAxes &axes)
        : path_(folder / fmt::format("{}.csv", rank))
        , axes_(axes)
        , out_(path_)
      {
        out_ << csv(atlas_table({}, axes));
      }

      void
      write(const AtlasPoint &point)
      {
        const std::string with_names = csv(atlas_table({point}, axes_));
        out_ << with_names.substr(with_names.find('\n') + 1) << std::flush;
        if (!out_)
          throw FileError("cannot write \"" + path_.string() + "\" (is the disk full?)");
      }

    private:
      const std::filesystem::path path_;
      const AtlasAxes &axes_;
      std::ofstream out_;
    };

    /// So many points are computed together: enough to fill the lanes of the fused engine, unless ranks would wait.
    unsigned long
    points_together(const unsigned long n_points, const unsigned int n_ranks)
    {
      constexpr unsigned long most = 8, parts_per_rank = 8;
      return std::clamp(n_points / (parts_per_rank * n_ranks), 1ul, most);
    }

    /// This rank's share of the points. A signal ends the work of all ranks; each drops the points it is at.
    std::vector<AtlasPoint>
    compute_own_points(MPI_Comm communicator,
                       const ParameterFile &file,
                       const AtlasAxes &axes,
                       const StopSignal &stop_signal,
                       RowWriter &rows,
                       Log &log)
    {
      Form form(file);
      const std::vector<double> first = numbers_of(axes.first, ""), second = numbers_of(axes.second, "");
      WorkQueue queue(communicator, axes.n_points());
      StudyProgress progress(log, axes.n_points(), "points");
      const auto interrupted = [&]() {
        queue.serve();
        return stop_signal.arrived_anywhere(MPI_COMM_SELF);
      };
      std::vector<AtlasPoint> points;
      const unsigned long stride     = golden_stride(axes.n_points());
      const unsigned long n_together = points_together(axes.n_points(), size_of(communicator));
      for (;;)
      {
        std::vector<unsigned long> indices;
        std::vector<Parameters> parameters;
        while (indices.size() < n_together)
        {
          const auto number = queue.next();
          if (!number)
            break;
          indices.push_back(*number * stride % axes.n_points());
          parameters.push_back(form.filled(axes, indices.back()));
        }
        if (indices.empty())
          break;
        auto some = compute_points(parameters, interrupted);
        if (!some)
        {
          queue.close();
          break;
        }
        for (std::size_t i = 0; i < indices.size(); ++i)
        {
          AtlasPoint &point = (*some)[i];
          point.index       = indices[i];
          point.first       = first[point.index / second.size()];
          point.second      = second[point.index % second.size()];
          rows.write(point);
          points.push_back(point);
          queue.done();
          progress.report(queue.so_far().done);
        }
      }
      return points;
    }

    /// The points of all ranks in their order, on rank 0.
    std::vector<AtlasPoint>
    collect(MPI_Comm communicator, const std::vector<AtlasPoint> &own)
    {
      std::vector<AtlasPoint> all;
      for (const std::string &text : gather(pack(own), communicator))
        for (const AtlasPoint &point : unpack(text))
          all.push_back(point);
      std::sort(all.begin(), all.end(), [](const AtlasPoint &a, const AtlasPoint &b) { return a.index < b.index; });
      return all;
    }

    /// The points in which something is wrong, the first few.
    void
    report_wrong_answers(const std::vector<AtlasPoint> &points, const AtlasAxes &axes, Log &log)
    {
      constexpr unsigned int most = 10;
      unsigned int n              = 0;
      for (const AtlasPoint &point : points)
        if (point.verdict.kind == Verdict::silent_wrong_answer && ++n <= most)
          log.line(fmt::format("Silent wrong answer at {} = {:g}, {} = {:g}: {}",
                               split_path(axes.first.entry).back(),
                               point.first,
                               split_path(axes.second.entry).back(),
                               point.second,
                               point.verdict.explanation));
      if (n > most)
        log.line(fmt::format("... and {} more (column verdict of atlas.csv)", n - most));
    }
  } // namespace

  ExitCode
  atlas(MPI_Comm communicator, const CommandOptions &options)
  {
    const StopSignal stop_signal; // from here on a signal ends the atlas in order
    const double start = now();
    Log log(rank_of(communicator) == 0, options.quiet);
    const ParameterFile file    = read_file(communicator, options.file, options.overrides);
    const AtlasAxes axes        = read_axes(file);
    const std::string effective = Form(file).text();
    const auto folder           = output_folder(options.output, options.file);
    const unsigned int n_ranks  = size_of(communicator);

    on_first_rank(communicator, [&]() {
      require_usable(folder, options.overwrite);
      require_no_sweep(folder);
      prepare(folder);
      std::filesystem::remove_all(folder / "rows"); // of an atlas that was killed
      std::filesystem::create_directories(folder / "rows");
      write_file(folder / "original.prm", file.text());
      write_file(folder / "parameters.prm", effective);
      log.open(folder / "log.txt");
      return "";
    });
    log.line(fmt::format("Atlas: {} values of {} times {} of {}, {} points on {} rank{}",
                         axes.first.values.size(),
                         axes.first.entry,
                         axes.second.values.size(),
                         axes.second.entry,
                         axes.n_points(),
                         n_ranks,
                         n_ranks == 1 ? "" : "s"));

    RowWriter rows(folder / "rows", rank_of(communicator), axes);
    const auto points    = collect(communicator, compute_own_points(communicator, file, axes, stop_signal, rows, log));
    const auto summary   = summarize(points, axes);
    const double seconds = now() - start;
    on_first_rank(communicator, [&]() {
      const Table table = atlas_table(points, axes);
      write_file(folder / "atlas.csv", csv(table));
      write_hdf5(folder / "atlas.h5", "atlas", table, provenance(effective, options.command_line));
      std::filesystem::remove_all(folder / "rows");
      const std::string status = summary.computed() == summary.points ? "finished" : "stopped";
      write_file(folder / "summary.json", atlas_json(summary, axes, status, seconds, n_ranks, options.command_line));
      report_wrong_answers(points, axes, log);
      log.line(in_words(summary, axes, seconds, n_ranks));
      if (status == "stopped")
        log.warn(fmt::format("stopped by a signal after {} of {} points", summary.computed(), summary.points));
      draw("atlas.py", folder, log);
      log.line(fmt::format("Results are in {}/.", folder.string()));
      return "";
    });
    int code = static_cast<int>(summary.computed() == summary.points ? ExitCode::finished : ExitCode::stopped);
    MPI_Bcast(&code, 1, MPI_INT, 0, communicator);
    return static_cast<ExitCode>(code);
  }
} // namespace crawler
