// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/core/form.h>
#include <crawler/studies/table/noisy_copies.h>
#include <crawler/time/failure.h>

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <iterator>
#include <random>

namespace crawler
{
  namespace fs = std::filesystem;

  namespace
  {
    /// A folder that is removed at the end.
    class TemporaryFolder
    {
    public:
      TemporaryFolder()
      {
        std::string name = (fs::temp_directory_path() / "crawler-table-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
          throw FileError(
            fmt::format("cannot make a folder in \"{}\" for the copies", fs::temp_directory_path().string()));
        path = name;
      }
      ~TemporaryFolder()
      {
        std::error_code ignored;
        fs::remove_all(path, ignored);
      }
      TemporaryFolder(const TemporaryFolder &) = delete;

      fs::path path;
    };

    /// Where the scene names the file of its table.
    std::string &
    file_entry(Parameters &parameters, const MeasuredQuantity quantity, const std::string &name)
    {
      ActiveStressParameters &stress = parameters.active_stress;
      if (quantity == MeasuredQuantity::active_stress && stress.generator == "table")
        return stress.table.file;
      if (quantity == MeasuredQuantity::strain && stress.generator == "prescribed strain" &&
          stress.prescribed_strain.given_by == "table")
        return stress.prescribed_strain.file;
      throw InputError(fmt::format(
        "\"{}\" has the generator \"{}\", but for a table of {} one is expected that reads it: {}",
        name,
        stress.generator,
        quantity == MeasuredQuantity::strain ? "strain" : "active stress",
        quantity == MeasuredQuantity::strain ? "\"prescribed strain\" with Given by = table" : "\"table\""));
    }

    /// What went wrong with a run; empty if nothing did.
    std::string
    problem_of(const Task &task)
    {
      if (task.error)
        return failure_of(task.error).message;
      if (task.computed.result.time.status != Status::finished)
        return task.computed.result.time.message;
      return std::isfinite(task.computed.result.displacement) ? "" : "its displacement is not known";
    }
  } // namespace

  std::string
  table_text(const PreparedTable &table)
  {
    std::string text = fmt::format("s,t,{}\n", column_of(table.quantity));
    for (std::size_t j = 0; j < table.grid.t.size(); ++j)
      for (std::size_t i = 0; i < table.grid.s.size(); ++i)
        fmt::format_to(std::back_inserter(text),
                       "{:.15g},{:.15g},{:.10g}\n",
                       table.grid.s[i],
                       table.grid.t[j],
                       table.grid.values[j * table.grid.s.size() + i]);
    return text;
  }

  NoisyDisplacement
  noisy_displacement(const Samples &samples,
                     PreparationSettings settings,
                     const PreparedTable &prepared,
                     const ParameterFile &scene,
                     const unsigned int n_copies,
                     const std::uint64_t seed,
                     const std::function<void()> &progress)
  {
    const TemporaryFolder folder;
    const Form form(scene);
    if (prepared.period)
      settings.period = fmt::format("{:.17g}", *prepared.period);
    settings.noise = prepared.noise;
    std::vector<Task> tasks(n_copies + 1);
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal(0., 1.);
    for (std::size_t k = 0; k < tasks.size(); ++k)
    {
      Samples copy = samples;
      if (k > 0)
        for (double &value : copy.values)
          value += prepared.noise * normal(generator); // gaps stay gaps
      progress();
      const fs::path file = folder.path / fmt::format("{}.csv", k);
      write_file(file, table_text(k == 0 ? prepared : prepare_table(copy, settings)));
      tasks[k].parameters                                              = form.parameters;
      file_entry(tasks[k].parameters, prepared.quantity, scene.name()) = file.string();
    }
    compute_all(tasks, HUGE_VAL, [&]() {
      progress();
      return false;
    });
    if (const std::string problem = problem_of(tasks[0]); !problem.empty())
      throw InputError(fmt::format("\"{}\" with the new table: {}", scene.name(), problem));
    NoisyDisplacement result{tasks[0].computed.result.displacement, std::nullopt, 0., 0., 0};
    if (tasks[0].computed.result.error)
      result.bound = tasks[0].computed.result.error->total;
    double square = 0.;
    std::string problem;
    for (std::size_t k = 1; k < tasks.size(); ++k)
    {
      if (!problem_of(tasks[k]).empty())
      {
        problem = problem_of(tasks[k]);
        continue;
      }
      ++result.n_copies;
      const double D = tasks[k].computed.result.displacement, change = D - result.mean;
      result.mean += change / result.n_copies;
      square += change * (D - result.mean);
    }
    if (10 * result.n_copies < 9 * n_copies)
      throw InputError(
        fmt::format("only {} of {} noisy copies could be run, so that the uncertainty is not known; one of the "
                    "others: {}",
                    result.n_copies,
                    n_copies,
                    problem));
    result.deviation = std::sqrt(square / (result.n_copies - 1));
    return result;
  }
} // namespace crawler
