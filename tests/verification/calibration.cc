// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Is the error that a run reports larger than its true error, and not much larger? (doc/numerics.md, "Error bounds")
//   [mpirun -n N] calibration SCENES OUTPUT.csv [ACCURACY ...]       (default: 1e-3 1e-5 1e-8)
// Runs so many random scenes (random_scenes.h), or those from one number to another (300-519; the ten thousands choose
// the family: from 10000 on their stresses start or jump suddenly, from 20000 on they are hard to judge, from 30000 on
// bodies are soft), at each accuracy as `crawler run` does, and compares them with second_method.h, asked for a tenth
// of the smallest accuracy, or, where that knows less, with the stretch form at a hundredth of it. Writes a row for
// each run and prints a table. Exit status 1 if less than 99 % of the true errors are below the reported ones (one miss
// is admitted in any case), one is three times as large, or, but for soft bodies, the median of reported over true is
// above 10.
#include "second_method.h"

#include <crawler/accuracy/answer.h>
#include <crawler/base/archive.h>
#include <crawler/base/communication.h>
#include <crawler/base/mpi_session.h>
#include <crawler/base/work_queue.h>
#include <crawler/run/cycle_stop.h>

#include <algorithm>
#include <fstream>
#include <map>

namespace
{
  using namespace crawler;
  using namespace crawler::test;
  /// The error of a reference that can judge an error is at most this part of it.
  constexpr double part_of_reported = 0.05;
  /// No reference is waited for longer [steps].
  constexpr unsigned long limit = 400000;

  RandomScene
  scene_of(const unsigned int number, const std::filesystem::path &folder)
  {
    static const std::vector<std::vector<Family>> families = {
      {Family::smooth},
      {Family::jumps},
      {Family::pulse, Family::event, Family::long_gait, Family::soft, Family::robot},
      {Family::soft}};
    const std::vector<Family> &which = families.at(number / 10000);
    return random_scene(which[number % which.size()], number, folder);
  }

  struct Row
  {
    unsigned int scene;
    std::string kind, status;
    double accuracy, reference, reference_bar, value, reported, space, time, wanted, length;
    unsigned int cells, steps, refinements;
    double solve_seconds, estimate_seconds;

    void
    exchange(Archive &archive)
    {
      archive(scene, kind, status, accuracy, reference, reference_bar, value, reported, space, time, wanted, length);
      archive(cells, steps, refinements, solve_seconds, estimate_seconds);
    }
  };

  /// All rows of one scene; none if it inverts or has no reference.
  std::vector<Row>
  rows_of(const unsigned int number, const std::vector<double> &accuracies, const std::filesystem::path &folder)
  {
    const RandomScene random = scene_of(number, folder);
    Parameters parameters    = parameters_with(random.settings);
    std::vector<Row> rows;
    std::vector<Task> tasks;
    for (const double accuracy : accuracies)
    {
      parameters.accuracy             = accuracy;
      const Scene scene               = parameters.create_scene();
      tasks.emplace_back().parameters = parameters;
      tasks.back().computed           = answer_in_memory(
        {parameters, scene}, {.energy_balance = true, .cycles = cycle_wish(parameters, scene, /*has_pictures=*/false)});
    }
    const auto finest                = std::min_element(accuracies.begin(), accuracies.end()) - accuracies.begin();
    parameters.output.energy_balance = false;
    parameters.accuracy              = std::max(0.1 * accuracies[finest], 1e-9);
    Judgement reference              = by_position_form(parameters, random, tasks[finest], limit);
    if (!(reference.error <= part_of_reported * accuracies[finest] * std::abs(reference.displacement)))
    {
      parameters.accuracy                   = std::max(0.01 * accuracies[finest], 1e-8);
      parameters.discretization.formulation = FormulationEntry::stretch;
      const Judgement other                 = by_program(parameters, "stretch", limit);
      if (!(reference.error <= other.error) && std::isfinite(other.error))
        reference = other;
    }
    if (!std::isfinite(reference.error))
    {
      fmt::print("scene {} ({}) has no reference; {}\n", number, random.kind, reference.problem);
      return rows;
    }
    for (std::size_t i = 0; i < tasks.size(); ++i)
    {
      const SimulationResult &result = tasks[i].computed.result;
      const DisplacementError error  = result.error.value_or(DisplacementError());
      rows.push_back({number,
                      random.kind,
                      reason_of(result),
                      accuracies[i],
                      reference.displacement,
                      reference.error,
                      result.displacement,
                      error.total,
                      error.space,
                      error.time,
                      tasks[i].computed.choice.wanted_error,
                      parameters.body.length,
                      result.process.mesh.most_cells,
                      result.time.steps,
                      result.process.refinements,
                      result.process.seconds.solve,
                      result.process.seconds.error});
    }
    return rows;
  }

  constexpr const char *names = "scene,kind,accuracy,status,reference,reference_bar,displacement,true_error,"
                                "reported_error,reported_space,reported_time,wanted_error,length,cells,steps,"
                                "refinements,solve_seconds,estimate_seconds";

  std::string
  line(const Row &r)
  {
    return fmt::format("{},{},{:g},{},{:.17g},{:.3g},{:.17g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{},{},{},{:.3g},"
                       "{:.3g}\n",
                       r.scene,
                       r.kind,
                       r.accuracy,
                       r.status,
                       r.reference,
                       r.reference_bar,
                       r.value,
                       std::abs(r.value - r.reference),
                       r.reported,
                       r.space,
                       r.time,
                       r.wanted,
                       r.length,
                       r.cells,
                       r.steps,
                       r.refinements,
                       r.solve_seconds,
                       r.estimate_seconds);
  }

  /// What the table counts, for one accuracy or all.
  struct Count
  {
    unsigned int runs = 0, judged = 0, covered = 0, met = 0, refined = 0, failed = 0;
    std::vector<double> ratios, overheads;

    void
    add(const Row &r)
    {
      ++runs;
      refined += r.refinements > 0;
      failed += r.status != "finished" && r.status != "accuracy_not_met";
      // The reference must be good enough to tell.
      if (!std::isfinite(r.reported) || r.reference_bar > part_of_reported * r.reported)
        return;
      ++judged;
      const double error = std::abs(r.value - r.reference);
      covered += error <= r.reported;
      met += error <= r.wanted;
      ratios.push_back(r.reported / error);
      if (r.estimate_seconds > 0.)
        overheads.push_back(r.estimate_seconds / r.solve_seconds);
    }

    void
    print(const std::string &name) const
    {
      fmt::print("{:>8} {:>6} {:>7} {:>9.2f} {:>9.2f} {:>10.1f} {:>8} {:>7} {:>9.2f}\n",
                 name,
                 runs,
                 judged,
                 100. * covered / judged,
                 100. * met / judged,
                 quantile(ratios, 0.5),
                 refined,
                 failed,
                 quantile(overheads, 0.5));
    }
  };
} // namespace

int
main(int argc, char **argv)
{
  int one = 1;
  const crawler::MpiSession guard(one, argv);
  if (argc < 3)
  {
    fmt::print(stderr, "usage: calibration SCENES OUTPUT.csv [ACCURACY ...]\n");
    return 2;
  }
  const std::string scenes     = argv[1];
  const std::size_t dash       = scenes.find('-');
  const unsigned long first    = dash == std::string::npos ? 0 : std::stoul(scenes),
                      n_scenes = dash == std::string::npos ? std::stoul(scenes)
                                                           : std::stoul(scenes.substr(dash + 1)) + 1 - first;
  std::vector<double> accuracies;
  for (int i = 3; i < argc; ++i)
    accuracies.push_back(std::stod(argv[i]));
  if (accuracies.empty())
    accuracies = {1e-3, 1e-5, 1e-8};

  const auto folder = std::filesystem::path(argv[2]).replace_extension("");
  WorkQueue queue(MPI_COMM_WORLD, n_scenes);
  std::vector<Row> rows;
  while (const auto number = queue.next())
    for (const Row &row : rows_of(static_cast<unsigned int>(first + *number), accuracies, folder))
      rows.push_back(row);
  const auto all = gather(archived(rows), MPI_COMM_WORLD);
  if (rank_of(MPI_COMM_WORLD) > 0)
    return 0;

  std::map<double, Count, std::greater<>> counts;
  Count total;
  std::ofstream file(argv[2]);
  file << names << "\n";
  for (const std::string &bytes : all)
  {
    Archive archive(bytes);
    archive(rows);
    for (const Row &row : rows)
    {
      file << line(row);
      counts[row.accuracy].add(row);
      total.add(row);
    }
  }
  file.close();
  if (!file)
  {
    fmt::print(stderr, "calibration: cannot write {}\n", argv[2]);
    return 2;
  }
  fmt::print("accuracy   runs  judged covered %     met %  rep./true  refined  failed  overhead\n");
  for (const auto &[accuracy, count] : counts)
    count.print(fmt::format("{:g}", accuracy));
  total.print("all");
  // Of few runs one may miss; none may miss by much.
  const double least = total.judged > 0 ? *std::min_element(total.ratios.begin(), total.ratios.end()) : 0.;
  fmt::print("smallest reported over true error: {:.2f}\n", least);
  // The median of few ratios says little.
  const double max_median = total.judged < 50 ? 20. : 10.;
  const bool kept         = total.judged - total.covered <= std::max(1., 0.01 * total.judged) &&
                    (first >= 30000 || quantile(total.ratios, 0.5) <= max_median) && least > 1. / 3.;
  fmt::print("{}\n", kept ? "the promise is kept" : "THE PROMISE IS NOT KEPT");
  return kept ? 0 : 1;
}
