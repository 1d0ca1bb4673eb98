// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Random scenes of everything that generators, laws and ranges allow (random_scenes.h). The answer of `crawler run` is
// compared with that of second_method.h; where that does not decide, with the other form or finer automatic numerics,
// which report their errors. Where an answer seems wrong the second method gets more and more
// cells, and changes by these count as its error: all of its meshes may have missed a layer. An answer is wrong if the
// difference is larger than both errors together
// ("the bound only" if it is still as small as Accuracy asks for). Prints coverage, failures by reason, and the cost
// (processor time of choice, run and error, without files). The exit code is 1 if an answer is wrong, if a single scene
// has none, if fewer than half of the answers could be compared, or, of 500 scenes or more, if 0.5 % fail, one takes 5
// s, or 5 % take 20 ms. How long a method is waited for is a number of steps, so the verdicts are the same on any
// machine; but for a scene of huge steps, which is given up after a minute and has failed then in any case.
//
//     random_extremes FIRST-LAST OUT.csv [steps that a run of the second method may take; 0: nothing is compared
//                                         [steps that the program may take]]
#include "second_method.h"

#include <crawler/base/mpi_session.h>

#include <cstdio>
#include <map>

namespace
{
  using namespace crawler;
  using namespace crawler::test;

  /// What is required.
  constexpr double largest_failed_share = 0.005, largest_missed_share = 0.01, usual_seconds = 0.02, usual_share = 0.95,
                   max_seconds = 5.;
  /// Of fewer scenes only wrong answers count: shares and times say little.
  constexpr unsigned int fewest = 500;
  /// No answer is waited for longer, and no second method unless the user says so [steps].
  constexpr unsigned long own_limit = 200000, second_limit = 20000;
  constexpr double most_cells =
    16.; ///< of the second method, where it does not agree, relative to those it begins with
  /// Of the answers so many must have been compared.
  constexpr double min_compared_share = 0.5;
  /// The error is larger than the reported one, but not larger than Accuracy asks for.
  constexpr const char *bound_only = "WRONG: the bound only";

  struct Row
  {
    unsigned int number = 0;
    RandomScene scene;
    std::string status, reason, form, verdict, refused;
    double accuracy = 0., seconds = 0., displacement = NAN, bound = NAN, inversion = NAN;
    Judgement second;

    bool
    has_failed() const
    {
      return refused.empty() && status != "finished" && status != "inverted";
    }
  };

  /// agree, WRONG, or undecided.
  std::string
  compare(const Row &own, const Judgement &second, const double wanted, const double T)
  {
    const bool inverts = own.status == "inverted";
    if (!second.is_answer() || (!inverts && !std::isfinite(own.bound)))
      return "undecided";
    if (inverts != second.inversion.has_value())
      return (inverts ? own.inversion : *second.inversion) > (1. - same_time) * T ? "agree" : "WRONG: one inverts";
    if (inverts)
      return std::abs(own.inversion - *second.inversion) <= std::max(own.bound, same_time * T) ? "agree"
                                                                                               : "WRONG: inverts then";
    if (std::abs(own.displacement - second.displacement) > own.bound + second.error)
      return std::abs(own.displacement - second.displacement) > wanted + second.error ? "WRONG" : bound_only;
    return second.error <= std::max(own.bound, wanted) ? "agree" : "undecided";
  }

  /// By one method after the other until one decides; what says that a wrong answer is right must know it four times as
  /// well, and then nothing is decided.
  void
  judge(Row &row, const Parameters &parameters, const Task &own, const unsigned long limit)
  {
    const SimulationResult &result = own.computed.result;
    const bool has_bound           = result.error && std::isfinite(result.error->total);
    if (row.status == "inverted")
      row.bound = result.inversion->error.value_or(0.);
    else if (has_bound)
      row.bound = result.error->total;
    row.verdict = "not compared";
    if (limit == 0 || own.is_out_of_time || (row.status != "inverted" && !has_bound))
      return;
    const double wanted         = parameters.accuracy * std::abs(result.displacement);
    Parameters other            = parameters;
    other.model                 = Model::nonlinear;
    other.output.energy_balance = false;
    const auto in_form          = [&](const FormulationEntry form, const double part, const char *name) {
      Parameters p                 = other;
      p.discretization.formulation = form;
      p.accuracy                   = std::clamp(part * parameters.accuracy, 1e-9, 1e-2);
      return by_program(p, name, limit);
    };
    const bool is_stretch = result.process.formulation == Formulation::stretch;
    // The stretches of stiff bodies differ by round-off only.
    const Body &body    = parameters.body;
    const double T      = parameters.time.end_time;
    const bool is_stiff = body.elastic_modulus * T > 1e3 * body.friction_coefficient * body.length * body.length;
    for (unsigned int method = 0; method < 3; ++method)
    {
      if (method == 1 && is_stiff && !is_stretch)
        continue;
      Judgement second =
        method == 0   ? by_position_form(other, row.scene, own, limit)
        : method == 1 ? in_form(is_stretch ? FormulationEntry::position : FormulationEntry::stretch, 0.5, "other form")
                      : in_form(is_stretch ? FormulationEntry::stretch : FormulationEntry::position, 0.1, "finer");
      std::string verdict = compare(row, second, wanted, T);
      for (double more = 2.; method == 0 && verdict.starts_with("WRONG") && more <= most_cells; more *= 2.)
      {
        Judgement finer = by_position_form(other, row.scene, own, limit, more);
        finer.error     = std::max(finer.error, std::abs(finer.displacement - second.displacement));
        if (!finer.is_answer()) // one mesh alone is not known to be fine enough
        {
          verdict = more == 2. ? "undecided" : verdict;
          break;
        }
        second  = finer;
        verdict = compare(row, second, wanted, T);
      }
      const bool was_wrong = row.verdict.starts_with("WRONG");
      if (row.second.by.empty())
        row.second = second;
      if (verdict == "undecided" || (was_wrong && verdict == "agree" && !(second.error <= row.bound / 4.)))
        continue;
      if (!was_wrong || verdict == "agree")
        row.second = second;
      row.verdict = was_wrong && verdict == "agree" ? "disputed" : verdict;
      if (verdict == "agree")
        return;
    }
  }

  Row
  answer(const unsigned int number,
         const std::filesystem::path &folder,
         const unsigned long limit,
         const unsigned long max_steps)
  {
    Row row;
    row.number = number;
    row.scene  = random_scene(Family::everything, number, folder);
    try
    {
      const Parameters parameters    = parameters_with(row.scene.settings);
      row.accuracy                   = parameters.accuracy;
      const Task own                 = computed(parameters, max_steps);
      row.seconds                    = own.seconds;
      const SimulationResult &result = own.computed.result;
      if (own.error)
        std::rethrow_exception(own.error);
      row.status       = own.is_out_of_time ? "time_limit" : word_of(result.time.status);
      row.reason       = own.is_out_of_time ? "time_limit" : result.time.reason;
      row.form         = result.process.model != Model::nonlinear             ? word_of(result.process.model)
                         : result.process.formulation == Formulation::stretch ? "stretch"
                                                                              : "position";
      row.displacement = result.displacement;
      if (result.inversion)
        row.inversion = result.inversion->t;
      judge(row, parameters, own, limit);
    }
    catch (const std::exception &error)
    {
      row.refused = error.what();
      row.verdict = "refused";
    }
    return row;
  }

  std::string
  command(const Row &row)
  {
    std::string text = "crawler run --overwrite --set Output/Statistics=false --set \"Output/Number of snapshots=0\"";
    for (const auto &[entry, value] : row.scene.settings)
      text += fmt::format(" --set \"{}={}\"", entry, value);
    return text;
  }

  void
  print(const Row &r)
  {
    fmt::print("scene {} ({}, {}): {} {} in {:.3g} s, D = {:.12g} +- {:.2g}, inverts at {:.6g}; {}\n"
               "  {}: D = {:.12g} +- {:.2g}, inverts at {:.6g} {}\n  {}\n",
               r.number,
               r.scene.kind,
               r.form,
               r.status,
               r.reason,
               r.seconds,
               r.displacement,
               r.bound,
               r.inversion,
               r.verdict,
               r.second.by,
               r.second.displacement,
               r.second.error,
               r.second.inversion.value_or(NAN),
               r.second.problem,
               command(r));
  }

  struct Count
  {
    unsigned int n = 0, finished = 0, inverted = 0, failed = 0, compared = 0, missed = 0, wrong = 0;
    std::vector<double> seconds;

    void
    add(const Row &r)
    {
      ++n;
      finished += r.status == "finished";
      inverted += r.status == "inverted";
      failed += r.has_failed();
      compared += r.verdict == "agree" || r.verdict.starts_with("WRONG");
      missed += r.verdict == bound_only;
      wrong += r.verdict.starts_with("WRONG") && r.verdict != bound_only;
      seconds.push_back(r.seconds);
    }
    void
    print(const std::string &name) const
    {
      fmt::print("{:22} {:6} {:8} {:8} {:6} {:8} {:6} {:5} {:8.3f} {:8.3f} {:8.3f}\n",
                 name,
                 n,
                 finished,
                 inverted,
                 failed,
                 compared,
                 missed,
                 wrong,
                 quantile(seconds, 0.5),
                 quantile(seconds, usual_share),
                 quantile(seconds, 1.));
    }
  };

  /// What the scene has besides its generator.
  std::vector<std::string>
  groups(const Row &row)
  {
    std::vector<std::string> groups = {"all", "generator " + row.scene.kind, "form " + row.form};
    for (const auto &[entry, value] : row.scene.settings)
      if (entry.starts_with("Ground/") && !entry.ends_with("interpolation") && !entry.ends_with("velocity") &&
          !entry.ends_with("Expression"))
        groups.push_back("law " + entry.substr(7));
      else if (entry.ends_with("profile") || entry.ends_with("Initial stretch"))
        groups.push_back("law " + entry.substr(5));
    groups.push_back(fmt::format("Accuracy 1e{}", static_cast<int>(std::floor(std::log10(row.accuracy)))));
    return groups;
  }

  bool
  print_summary(const std::vector<Row> &rows, const bool is_compared)
  {
    std::map<std::string, Count> counts;
    std::map<std::string, unsigned int> failures, refusals;
    for (const Row &row : rows)
      if (row.refused.empty())
      {
        for (const std::string &group : groups(row))
          counts[group].add(row);
        if (row.has_failed())
          ++failures[row.reason];
      }
      else
        ++refusals[row.refused];
    const Count all = counts["all"];
    fmt::print("{:22} {:>6} {:>8} {:>8} {:>6} {:>8} {:>6} {:>5} {:>8} {:>8} {:>8}\n",
               "",
               "scenes",
               "finished",
               "inverted",
               "failed",
               "compared",
               "missed",
               "wrong",
               "median s",
               "95 %",
               "largest");
    for (const auto &[name, count] : counts)
      count.print(name);
    fmt::print("failures:\n");
    for (const auto &[reason, n] : failures)
      fmt::print("  {}: {}\n", reason, n);
    fmt::print("refused:\n");
    for (const auto &[reason, n] : refusals)
      fmt::print("  {}: {}\n", n, reason);
    std::vector<Row> slow = rows;
    std::sort(slow.begin(), slow.end(), [](const Row &a, const Row &b) { return a.seconds > b.seconds; });
    slow.resize(std::min<std::size_t>(slow.size(), 10));
    fmt::print("\nthe slowest:\n");
    for (const Row &row : slow)
      print(row);
    const bool kept = all.wrong == 0 && all.missed <= std::max(1., largest_missed_share * all.n) &&
                      (all.n < fewest ||
                       (all.failed < largest_failed_share * all.n &&
                        quantile(all.seconds, usual_share) < usual_seconds && quantile(all.seconds, 1.) < max_seconds));
    const bool enough = !is_compared || all.compared >= min_compared_share * (all.finished + all.inverted);
    fmt::print("{} of {} answers compared: {}\n",
               all.compared,
               all.finished + all.inverted,
               !kept            ? "NOT KEPT"
               : !enough        ? "TOO FEW, THIS PROVES NOTHING"
               : all.n < fewest ? "no answer is wrong"
                                : "kept");
    return kept && enough;
  }
} // namespace

int
main(int argc, char **argv)
{
  int one            = 1;
  char *no_options[] = {argv[0], nullptr}, **none = no_options;
  const crawler::MpiSession mpi(one, none);
  unsigned int first = 0, last = 0;
  const int n_numbers = argc < 3 ? 0 : std::sscanf(argv[1], "%u-%u", &first, &last);
  if (n_numbers < 1)
  {
    fmt::print(stderr, "random_extremes FIRST-LAST OUT.csv [steps [steps]]\n");
    return 2;
  }
  last                               = std::max(first, last);
  const unsigned long limit          = argc > 3 ? std::stoul(argv[3]) : second_limit,
                      max_steps      = argc > 4 ? std::stoul(argv[4]) : own_limit;
  const std::filesystem::path folder = std::filesystem::path(argv[2]).replace_extension("");
  std::ofstream out(argv[2]);
  out << "number,kind,form,accuracy,status,reason,seconds,displacement,bound,inversion,second,second displacement,"
         "second error,second inversion,second problem,verdict\n";
  computed(parameters_with({}), own_limit); // what a process does once
  std::vector<Row> rows;
  for (unsigned int number = first; number <= last; ++number)
  {
    rows.push_back(answer(number, folder, limit, max_steps));
    const Row &r = rows.back();
    out << fmt::format("{},{},{},{:.3g},{},{},{:.4g},{:.15g},{:.3g},{:.10g},{},{:.15g},{:.3g},{:.10g},\"{}\",{}\n",
                       r.number,
                       r.scene.kind,
                       r.form,
                       r.accuracy,
                       r.refused.empty() ? r.status : "refused",
                       r.reason,
                       r.seconds,
                       r.displacement,
                       r.bound,
                       r.inversion,
                       r.second.by,
                       r.second.displacement,
                       r.second.error,
                       r.second.inversion.value_or(NAN),
                       r.second.problem,
                       r.verdict)
        << std::flush;
    if (r.has_failed() || r.verdict.starts_with("WRONG") || r.verdict == "disputed")
      print(r);
    std::fflush(stdout);
  }
  const bool is_one_without_answer = first == last && rows.front().has_failed();
  return print_summary(rows, limit > 0) && !is_one_without_answer ? 0 : 1;
}
