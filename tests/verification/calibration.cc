// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Is the error that a run reports larger than its true error, and not much larger? (doc/numerics.md, "Error bounds")
//   [mpirun -n N] calibration SCENES OUTPUT.csv [ACCURACY ...]       (default: 1e-3 1e-5 1e-8)
// Runs so many random scenes (random_scenes.h), or those from one number to another (300-519; from 10000 on their
// stresses start or jump suddenly; from 20000 on they are hard to judge), at each accuracy as
// `crawler run` does, and compares them with a far finer run in the position form, of degree 8, by radau 5 through
// PETSc; its own error is the difference to bdf. Where that form cannot hold the stretch the reference is the stretch
// form's for a hundred times smaller an Accuracy. Writes a row for each run and prints a table. Exit status 1 if less
// than 99 % of the true errors are below the reported ones (one miss is admitted in any case), one is three times as
// large, or the median of reported over true is above 10.
#include "random_scenes.h"

#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/mesh_choices.h>
#include <crawler/accuracy/mesh_family.h>
#include <crawler/accuracy/run_to_accuracy.h>
#include <crawler/base/archive.h>
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/mpi_session.h>
#include <crawler/base/work_queue.h>
#include <crawler/run/self_check.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <map>

namespace
{
  using namespace crawler;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  /// The error of a reference that can judge an error is at most this part of it.
  constexpr double part_of_reported = 0.05;

  /// A displacement; not a number if the run did not finish, and then why.
  struct Reference
  {
    double displacement = unknown, bar = unknown;
    std::string problem;
  };

  std::string
  problem_of(const SimulationResult &result)
  {
    return fmt::format("{} at t = {:.4g}, smallest stretch {:.3g}",
                       result.time.reason.empty() ? word_of(result.time.status) : result.time.reason.c_str(),
                       result.time.time,
                       result.min_stretch.value);
  }

  /// The displacement by an engine that the runs do not use, and by finer meshes and steps.
  double
  displacement(const Parameters &parameters, const std::string &integrator)
  {
    Parameters p                 = parameters;
    p.accuracy                   = integrator == "bdf" ? 3e-10 : 1e-9;
    p.time.integrator            = integrator;
    p.time.engine                = Engine::petsc;
    p.time.max_steps             = 40000;
    p.time.cycle_stop            = CycleStopMode::off;
    p.discretization.formulation = FormulationEntry::position;
    p.discretization.mesh        = MeshKind::uniform;
    p.discretization.degree      = 8;
    p.output.energy_balance      = false;
    const Scene scene            = p.create_scene();
    Numerics numerics            = choose_numerics({p, scene})->numerics;
    numerics.n_cells             = std::clamp(numerics.n_cells, 8u, 128u); // layers of a start ask for thousands
    if (integrator == "bdf")                                               // so that the bar knows the mesh, too
      numerics.n_cells += (numerics.n_cells + 2) / 3;
    Simulation simulation(MPI_COMM_SELF, scene, p.time, numerics);
    const SimulationResult result = simulation.run({}, {});
    return result.time.status == Status::finished ? result.displacement : unknown;
  }

  Reference
  displacement_of_smooth(const Parameters &parameters)
  {
    Reference reference;
    reference.displacement = displacement(parameters, "radau 5");
    reference.bar          = std::abs(displacement(parameters, "bdf") - reference.displacement);
    return reference;
  }

  /// By the stretch form, which reports its own error.
  Reference
  displacement_by_stretch(const Parameters &parameters, const test::RandomScene &random, const double accuracy)
  {
    Parameters p                 = parameters;
    p.accuracy                   = accuracy;
    p.time.cycle_stop            = CycleStopMode::off;
    p.discretization.formulation = FormulationEntry::stretch;
    p.output.energy_balance      = false;
    const Scene scene            = random.create(p);
    if (!reason_against_stretch_form(scene).empty())
      return {unknown, unknown, "the stretch form cannot compute it"};
    const auto choice             = choose_numerics({p, scene});
    const SimulationResult result = answer_of_family({p, scene}, *choice, {}).result;
    if (!result.error || !std::isfinite(result.error->total))
      return {unknown, unknown, "stretch form: " + problem_of(result)};
    return {result.displacement, result.error->total, ""};
  }

  /// The same for a jumping scene, on graded meshes; the bar is the difference of two such displacements, on two
  /// engines.
  Reference
  displacement_of_jumping(const Parameters &parameters, const test::RandomScene &random)
  {
    Parameters p       = parameters;
    p.accuracy         = 1e-3;
    p.time.cycle_stop  = CycleStopMode::off;
    const Scene scene  = random.create(p);
    const double rough = std::abs(
      Simulation(MPI_COMM_SELF, scene, p.time, choose_numerics({p, scene})->numerics).run({}, {}).displacement);
    Reference reference;
    const auto run = [&](const std::string &integrator,
                         const std::string &engine,
                         const double tolerance,
                         const Grading &grading,
                         const unsigned int n_cells = 14) {
      Numerics n                    = {.degree    = 8,
                                       .n_cells   = n_cells,
                                       .tolerance = std::max(tolerance * rough, 3e-14 * scene.body.length),
                                       .grading   = grading};
      n.initial_step                = first_step_on_graded_mesh(scene, n);
      TimeParameters time           = p.time;
      time.integrator               = integrator;
      time.engine                   = from_word<Engine>(engine).value();
      time.max_steps                = 100000;
      const SimulationResult result = Simulation(MPI_COMM_SELF, scene, time, n).run({}, {});
      if (result.time.status == Status::finished)
        return result.displacement;
      reference.problem += (reference.problem.empty() ? "" : "; ") + integrator + ": " + problem_of(result);
      return unknown;
    };
    // The tiny first steps of the finest cells of stiff bodies may fail.
    double first = run("radau 9", "petsc", 1e-8, {9, 0.35});
    if (!std::isfinite(first))
      first = run("radau 9", "petsc", 1e-7, {8, 0.35});
    double second = run("radau 5", "automatic", 1e-9, {11, 0.4}, 20);
    if (!std::isfinite(second))
      second = run("radau 5", "automatic", 1e-9, {8, 0.4}, 20);
    reference.displacement = first;
    reference.bar          = std::abs(second - first);
    return reference;
  }

  /// The same by steps that no event can escape, and of all cycles.
  Reference
  displacement_by_short_steps(const Parameters &parameters, const test::RandomScene &random)
  {
    Reference reference;
    const Scene scene                = random.create(parameters);
    Parameters rough                 = parameters;
    rough.accuracy                   = 1e-6;
    rough.discretization.formulation = FormulationEntry::position;
    const Numerics by_rule           = choose_numerics({rough, scene})->numerics;
    const auto run = [&](const std::string &integrator, const double tolerance, const unsigned int more) {
      Numerics n   = by_rule;
      n.degree     = 8;
      n.mesh       = {};
      n.n_cells    = std::max(12u, by_rule.n_cells) + more;
      n.tolerance  = tolerance * by_rule.tolerance;
      n.integrator = integrator;
      if (random.step > 0.)
        n.step_limits = {{0., random.step}};
      TimeParameters time           = parameters.time;
      time.integrator               = integrator;
      time.max_steps                = 400000;
      const SimulationResult result = Simulation(MPI_COMM_SELF, scene, time, n).run({}, {});
      if (result.time.status == Status::finished)
        return result.displacement;
      reference.problem += (reference.problem.empty() ? "" : "; ") + integrator + ": " + problem_of(result);
      return unknown;
    };
    reference.displacement = run("radau 9", 1e-5, 0);
    reference.bar          = std::abs(run("radau 9", 1e-3, 5) - reference.displacement);
    return reference;
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
  rows_of(const unsigned int number, const std::vector<double> &accuracies)
  {
    const bool jumping             = number >= test::first_jumping_scene;
    const bool hard                = number >= test::first_hard_scene;
    const test::RandomScene random = hard      ? test::hard_scene(number)
                                     : jumping ? test::jumping_scene(number)
                                               : test::random_scene(number);
    Parameters parameters          = test::parameters_with(random.settings);
    Reference reference = random.step > 0. || random.kind == "long" ? displacement_by_short_steps(parameters, random)
                          : jumping || random.kind == "sudden"      ? displacement_of_jumping(parameters, random)
                                                                    : displacement_of_smooth(parameters);
    const double least  = *std::min_element(accuracies.begin(), accuracies.end());
    if (!(reference.bar <= part_of_reported * least * std::abs(reference.displacement)))
    {
      const Reference other = displacement_by_stretch(parameters, random, std::max(0.01 * least, 1e-8));
      if (!(reference.bar <= other.bar) && std::isfinite(other.bar))
        reference = other;
    }
    std::vector<Row> rows;
    if (!std::isfinite(reference.bar))
    {
      fmt::print("scene {} ({}) has no reference; {}\n", number, random.kind, reference.problem);
      return rows;
    }
    for (const double accuracy : accuracies)
    {
      parameters.accuracy = accuracy;
      const Scene scene   = random.create(parameters);
      const Answer answer = answer_in_memory(
        {parameters, scene}, {.energy_balance = true, .cycles = cycle_wish(parameters, scene, /*has_pictures=*/false)});
      const SimulationResult &result = answer.result;
      const DisplacementError error  = result.error.value_or(DisplacementError());
      rows.push_back({number,
                      random.kind,
                      result.time.status == Status::finished ? "finished" : result.time.reason,
                      accuracy,
                      reference.displacement,
                      reference.bar,
                      result.displacement,
                      error.total,
                      error.space,
                      error.time,
                      answer.choice.wanted_error,
                      scene.body.length,
                      result.mesh.most_cells,
                      result.time.steps,
                      result.refinements,
                      result.seconds.solve,
                      result.seconds.error});
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
                 test::quantile(ratios, 0.5),
                 refined,
                 failed,
                 test::quantile(overheads, 0.5));
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

  WorkQueue queue(MPI_COMM_WORLD, n_scenes);
  std::vector<Row> rows;
  while (const auto number = queue.next())
    for (const Row &row : rows_of(static_cast<unsigned int>(first + *number), accuracies))
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
                    test::quantile(total.ratios, 0.5) <= max_median && least > 1. / 3.;
  fmt::print("{}\n", kept ? "the promise is kept" : "THE PROMISE IS NOT KEPT");
  return kept ? 0 : 1;
}
