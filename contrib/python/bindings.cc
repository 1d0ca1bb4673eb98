// SPDX-License-Identifier: LGPL-2.1-or-later
// The module crawler._core: texts of parameter files go in, texts (JSON) and arrays come out; crawler/__init__.py makes
// of them what users see. One computation at a time, without Python's lock, which is taken now and then to look for
// signals.
#include "command.h"

#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/mpi_session.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/base/stop_place.h>
#include <crawler/base/versions.h>
#include <crawler/output/kymograph_writer.h>
#include <crawler/output/statistics_writer.h>
#include <crawler/parameters/entry_lists.h>
#include <crawler/run/summary.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/core/entry_rules.h>
#include <crawler/studies/core/scene_numbers.h>
#include <crawler/studies/core/sensitivities.h>
#include <crawler/studies/run/run_in_memory.h>
#include <crawler/studies/sweep/point_table.h>
#include <crawler/studies/sweep/sweep_blocks.h>
#include <crawler/studies/sweep/sweep_rows.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <sstream>
#include <tuple>

namespace py = pybind11;

namespace crawler
{
  namespace
  {
    /// MPI and PETSc, from the first scene that needs them to the end of Python. MPI may have been started by others.
    class Libraries
    {
    public:
      static void
      start()
      {
        if (instance_ == nullptr)
          instance_.reset(new Libraries);
      }
      static void
      end()
      {
        instance_.reset();
      }

    private:
      Libraries()
      {
        static char name[] = "crawler", no_handler[] = "-no_signal_handler", yes[] = "true";
        static char *words[] = {name, no_handler, yes, nullptr};
        int n                = 3;
        char **arguments     = words;
        const QuickStart quick_start;
        session_ = std::make_unique<MpiSession>(n, arguments);
      }
      static std::unique_ptr<Libraries> instance_;
      std::unique_ptr<MpiSession> session_;
    };
    std::unique_ptr<Libraries> Libraries::instance_;

    /// Runs @p work without Python's lock, alone; it asks its argument whether a signal has arrived whose handler in
    /// Python raised something, which is thrown at the end.
    template <typename Work>
    auto
    without_lock(const Work &work)
    {
      static std::mutex one_at_a_time;
      constexpr double pause = 0.05; // seconds
      bool interrupted       = false;
      double last            = now();
      const auto look        = [&]() {
        const py::gil_scoped_acquire lock;
        last        = now();
        interrupted = interrupted || PyErr_CheckSignals() != 0;
      };
      const std::function<bool()> asked = [&]() {
        reach(StopPlace::step);
        if (!interrupted && now() - last > pause)
          look();
        return interrupted;
      };
      auto answer = [&]() {
        const py::gil_scoped_release unlocked;
        const std::lock_guard alone(one_at_a_time);
        auto result = work(asked);
        look(); // a signal that ended the work in its own way, too
        return result;
      }();
      if (interrupted)
        throw py::error_already_set();
      return answer;
    }

    /// A parameter file as Python gives it: read from the file @p name unless there is a text.
    struct Source
    {
      std::string name;
      std::optional<std::string> text;
      std::vector<std::string> overrides;

      ParameterFile
      file() const
      {
        ParameterFile read = text ? ParameterFile::from_text(*text, name) : ParameterFile::read(name);
        for (const std::string &one : overrides)
          read.add_override(one);
        return read;
      }
    };

    /// A copy of the values with this shape.
    py::array
    array_of(const std::vector<double> &values, const std::vector<std::size_t> &shape)
    {
      return py::array_t<double>(shape, values.data());
    }

    std::string
    summary_text(const SimulationResult &result)
    {
      return summary_json(result, /*n_ranks=*/1, "python");
    }

    /// Nothing is computed; the entries as they are used, and what is perhaps not meant.
    std::pair<std::string, std::vector<std::string>>
    check(const Source &source)
    {
      return without_lock([&](const std::function<bool()> &) {
        const Input input = read_input(source.file(), /*command=*/"check");
        auto notes        = input.notes;
        for (const std::string &note : notes_on_choice(input, choose_model(input).model))
          notes.push_back(note);
        return std::pair(input.effective, notes);
      });
    }

    /// Those that the entry "Fit/Variables" lists, in the scene of which `crawler fit` finds them.
    std::tuple<std::string, std::vector<std::string>, std::vector<std::tuple<std::string, double, double, double>>>
    variables_of_fit(const Source &source)
    {
      return without_lock([&](const std::function<bool()> &) {
        const Input input = read_input(source.file(), /*command=*/"fit");
        auto notes        = input.notes;
        std::vector<std::tuple<std::string, double, double, double>> variables;
        for (const Variable &one : read_variables(input.file, "Fit/Variables"))
          variables.emplace_back(one.path, one.from, one.to, one.start);
        return std::tuple(input.effective, notes, variables);
      });
    }

    /// Increasing numbers from 0 to a last one.
    void
    require_increasing(const std::vector<double> &numbers,
                       const double last,
                       const char *numbers_name,
                       const char *last_name)
    {
      for (std::size_t i = 0; i < numbers.size(); ++i)
        if (!(numbers[i] >= 0. && numbers[i] <= last) || (i > 0 && !(numbers[i] > numbers[i - 1])))
          throw InputError(
            fmt::format("the {} of the fields have {:g}, but increasing numbers from 0 to the {} {:g} are "
                        "expected",
                        numbers_name,
                        numbers[i],
                        last_name,
                        last));
    }

    /// Those at these places [length], or equidistant ones.
    WantedFields
    wanted_fields(const Scene &scene,
                  const std::vector<double> &times,
                  const std::optional<std::vector<double>> &places)
    {
      require_increasing(times, scene.end_time, "times", "end time");
      if (!places)
        return {times, Kymograph::equidistant()};
      require_increasing(*places, scene.body.length, "places", "length");
      std::vector<double> points;
      for (const double place : *places)
        points.push_back(place / scene.body.length);
      return {times, std::move(points)};
    }

    py::dict
    dict_of_fields(const Kymograph &kymograph)
    {
      py::dict fields;
      for (const FieldName &field : field_names)
        if (field.in_kymograph)
          fields[field.name] =
            array_of(kymograph.rows().*field.values, {kymograph.times().size(), kymograph.points.size()});
      return fields;
    }

    py::dict
    run_source(const Source &source,
               const std::optional<std::vector<double>> &times,
               const std::optional<std::vector<double>> &places)
    {
      std::string effective;
      std::vector<std::string> notes;
      LocalSensitivity local;
      const RunInMemory run = without_lock([&](const std::function<bool()> &interrupted) {
        Input input = read_input(source.file(), run_in_memory_command);
        effective   = input.effective;
        notes       = input.notes;
        WantedFields wanted;
        if (times)
          wanted = wanted_fields(input.scene, *times, places);
        const ModelChoice model = choose_model(input);
        if (model.needs_mesh())
          Libraries::start();
        Afterwards sensitivities;
        if (!input.sensitivities.empty())
          sensitivities = [&](const Input &computed, const NumericsChoice &choice, SimulationResult &result) {
            local = add_sensitivities(computed, choice, result, [&]() { return !interrupted(); });
          };
        return run_in_memory(input, model, wanted, interrupted, sensitivities);
      });
      py::dict answer;
      answer["summary"]    = summary_text(run.result);
      answer["parameters"] = effective;
      notes.insert(notes.end(), run.notes.begin(), run.notes.end());
      answer["notes"] = notes;
      answer["lines"] = summary_lines(run.result);
      if (run.kymograph)
      {
        answer["times"]  = array_of(run.kymograph->times(), {run.kymograph->times().size()});
        answer["fields"] = dict_of_fields(*run.kymograph);
      }
      if (run.statistics)
      {
        const auto names           = run.statistics->column_names();
        answer["statistics_names"] = names;
        answer["statistics"] =
          array_of(run.statistics->values(), {run.statistics->values().size() / names.size(), names.size()});
      }
      if (!local.s.empty())
      {
        const std::size_t n = local.s.size(), n_t = local.times.size();
        answer["local"] = py::dict(py::arg("s")               = array_of(local.s, {n}),
                                   py::arg("elastic_modulus") = array_of(local.elastic_modulus, {n}),
                                   py::arg("friction")        = array_of(local.friction, {n}),
                                   py::arg("t")               = array_of(local.times, {n_t}),
                                   py::arg("active_stress")   = array_of(local.stress, {n_t, n_t > 0 ? n : 0}));
      }
      return answer;
    }

    std::unique_ptr<FieldRuns>
    field_runs(const Source &source, const std::vector<std::string> &paths)
    {
      return without_lock(
        [&](const std::function<bool()> &) { return std::make_unique<FieldRuns>(source.file(), paths); });
    }

    /// End of a run, and its fields if it finished.
    py::dict
    run_for_fields(FieldRuns &runs,
                   const std::vector<double> &numbers,
                   const bool is_similar,
                   const std::vector<double> &times,
                   const std::vector<double> &places)
    {
      const RunInMemory run  = without_lock([&](const std::function<bool()> &interrupted) {
        return runs.run(
          numbers,
          is_similar,
          [&](const Scene &scene) { return wanted_fields(scene, times, places); },
          Libraries::start,
          interrupted);
      });
      const TimeOutcome &end = run.result.time;
      py::dict answer(py::arg("reason") = end.reason, py::arg("message") = end.message, py::arg("steps") = end.steps);
      if (end.status == Status::finished && run.kymograph)
        answer["fields"] = dict_of_fields(*run.kymograph);
      return answer;
    }

    py::list
    run_batch_of(const std::vector<Source> &sources)
    {
      std::vector<std::string> effective, summaries;
      std::vector<std::vector<std::string>> notes;
      without_lock([&](const std::function<bool()> &interrupted) {
        std::vector<Input> inputs;
        std::vector<Task> tasks;
        for (const Source &source : sources)
        {
          inputs.push_back(read_input(source.file(), /*command=*/"batch"));
          tasks.emplace_back().parameters = inputs.back().parameters;
          tasks.back().gait               = true;
        }
        Libraries::start();
        compute_all(tasks, HUGE_VAL, interrupted);
        for (std::size_t i = 0; i < tasks.size(); ++i)
        {
          Task &task = tasks[i];
          if (task.error)
            std::rethrow_exception(task.error);
          SimulationResult &result = task.computed.result;
          result.process.model     = task.parameters.model;
          if (Form form(inputs[i].file); !inputs[i].sensitivities.empty() && result.time.status == Status::finished)
            find_sensitivities(form, *task.scene, inputs[i].sensitivities, task.computed.choice, result, [&]() {
              return !interrupted();
            });
          summaries.push_back(summary_text(result));
          effective.push_back(inputs[i].effective);
          notes.push_back(inputs[i].notes);
        }
        return 0;
      });
      py::list answers;
      for (std::size_t i = 0; i < sources.size(); ++i)
        answers.append(py::dict(
          py::arg("summary") = summaries[i], py::arg("parameters") = effective[i], py::arg("notes") = notes[i]));
      return answers;
    }

    /// The columns of `crawler sweep`, on one rank, by their names; and notes.
    std::pair<py::dict, std::vector<std::string>>
    sweep_source(const Source &source)
    {
      std::vector<RowFile::Column> columns;
      std::vector<RowFile::Row> rows;
      std::vector<std::string> notes;
      without_lock([&](const std::function<bool()> &interrupted) {
        Libraries::start();
        const ParameterFile file = source.file();
        SweepPoints points(MPI_COMM_SELF, file);
        points.require_checkable();
        notes                      = points.notes();
        columns                    = sweep_columns(points);
        rows                       = std::vector<RowFile::Row>(points.design().n_points());
        const RowFile::Known known = known_columns(columns, points.design());
        const std::vector<bool> done(rows.size(), false);
        for (std::size_t i = 0; i < rows.size(); ++i)
          for (std::size_t c = 0; c < columns.size(); ++c)
            rows[i].push_back(c < known.n_columns     ? known.value(c, i)
                              : columns[c].width == 0 ? RowFile::Value(std::numeric_limits<double>::quiet_NaN())
                                                      : RowFile::Value(std::string()));
        SweepWork work(points, /*n_ranks=*/1);
        const auto write = [&](const unsigned long first, const std::span<const RowFile::Row> some) {
          for (std::size_t i = 0; i < some.size(); ++i)
            std::ranges::copy(some[i], rows[first + i].begin() + static_cast<std::ptrdiff_t>(known.n_columns));
        };
        const double start = now(), limit = points.sweep().time_limit.value_or(HUGE_VAL);
        const auto stops = [&]() { return now() - start > limit || interrupted(); };
        for (unsigned long part = 0; part < work.n_parts() && !stops(); ++part)
          work.compute(part, done, write, stops, [](unsigned long, unsigned long) {});
        return 0;
      });
      py::dict table;
      for (std::size_t c = 0; c < columns.size(); ++c)
      {
        py::list texts;
        std::vector<double> numbers;
        for (const RowFile::Row &row : rows)
          if (columns[c].width == 0)
            numbers.push_back(std::get<double>(row[c]) + 0.); // no -0
          else
            texts.append(std::get<std::string>(row[c]));
        table[py::str(columns[c].name)] =
          columns[c].width == 0 ? py::object(array_of(numbers, {numbers.size()})) : py::object(texts);
      }
      return {table, notes};
    }

    /// A command with its files; the exit code, and notes.
    std::pair<int, std::vector<std::string>>
    command(
      const std::string &name, const Source &source, const std::string &output, const bool overwrite, const bool quiet)
    {
      return without_lock([&](const std::function<bool()> &) {
        Libraries::start();
        CommandOptions options;
        options.file         = source.text ? "-" : source.name;
        options.overrides    = source.overrides;
        options.output       = output;
        options.overwrite    = overwrite;
        options.quiet        = quiet;
        options.command_line = "python";
        return run_command(name, options, source.file());
      });
    }

    std::string
    all_entries()
    {
      Parameters parameters;
      Declarations declarations;
      parameters.add_parameters(declarations);
      std::ostringstream text;
      print_json(declarations, text);
      return text.str();
    }

    void
    raise(const char *name, const char *message)
    {
      PyErr_SetString(py::module_::import("crawler").attr(name).ptr(), with_plain_numbers(message).c_str());
    }
  } // namespace
} // namespace crawler

PYBIND11_MODULE(_core, module)
{
  using namespace crawler;
  py::register_exception_translator([](const std::exception_ptr error) {
    try
    {
      if (error)
        std::rethrow_exception(error);
    }
    catch (const InputError &problem)
    {
      raise("InputError", problem.what());
    }
    catch (const FileError &problem)
    {
      raise("FileError", problem.what());
    }
    catch (const std::filesystem::filesystem_error &problem)
    {
      raise("FileError", problem.what());
    }
  });
  py::class_<Source>(module, "Source")
    .def(py::init([](std::string name, std::optional<std::string> text, std::vector<std::string> overrides) {
      return Source{std::move(name), std::move(text), std::move(overrides)};
    }));
  py::class_<FieldRuns>(module, "FieldRuns").def(py::init(&field_runs)).def("run", run_for_fields);
  module.def("check", check);
  module.def("run", run_source);
  module.def("variables_of_fit", variables_of_fit);
  module.def("batch", run_batch_of);
  module.def("sweep", sweep_source);
  module.def("command", command);
  module.def("entries", all_entries);
  module.def("numbers", []() { return result_entries().dump(); });
  module.def("end", &Libraries::end);
  module.attr("n_points") = Kymograph::n_points;
  module.attr("versions") = versions();
  py::list numbers;
  for (const char *const key : differentiated_numbers)
    numbers.append(key);
  module.attr("differentiated_numbers") = numbers;
}
