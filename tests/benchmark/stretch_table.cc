// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Costs of collapsing, stiff, inverting and soft bodies (doc/numerics.md, "Which form"). For each case and Accuracy
// the CPU time of the whole answer with its bound, as a point of a sweep takes it (the faster of two), the true error
// and the bound, both over Accuracy times the displacement. Prints Markdown; nothing is required of it.
//
//     stretch_table [part of a case's name] [formulation, for all cases]
//
// With the word "trade" the CPU time of both forms for bodies that become emptier or softer: which one is the cheaper
// one at which Accuracy (choose_form() follows that).
#include "../support/processor_time.h"
#include "../support/run_text.h"

#include <crawler/base/mpi_session.h>
#include <crawler/studies/core/compute.h>

#include <cmath>
#include <string>

namespace
{
  using namespace crawler;

  struct Case
  {
    std::string name;
    double a, chi, k;
    double reference; ///< displacement, or the time of the inversion
    bool inverts;
    double accurate; ///< the smallest Accuracy asked for
  };

  const Case cases[] = {{"a = -1, chi = 0.4", -1., 0.4, 1., .0900725298, false, 1e-6},
                        {"a = -1, chi = 0.6", -1., 0.6, 1., .2349598824, false, 1e-6},
                        {"a = -1, chi = 0.7", -1., 0.7, 1., .287958443, false, 1e-6},
                        {"a = -1, chi = 0.8", -1., 0.8, 1., .328038004, false, 1e-6},
                        {"a = -1, k = 10, chi = 0.6", -1., 0.6, 10., .26374413, false, 1e-6},
                        {"a = -1, k = 100, chi = 0.56", -1., 0.56, 100., .24183304, false, 1e-6},
                        {"a = -1, k = 1e-4, chi = 0.3", -1., 0.3, 1e-4, .0478959170, false, 1e-6},
                        {"a = -1, k = 1e-5, chi = 0.3", -1., 0.3, 1e-5, .047935667, false, 1e-6},
                        {"a = -1, k = 1e-6, chi = 0.3", -1., 0.3, 1e-6, .04794297, false, 1e-6},
                        {"a = -7, k = 1e-4, chi = 0.3", -7., 0.3, 1e-4, .516944874, false, 1e-4},
                        {"a = -0.8, chi = 0.77", -0.8, 0.77, 1., .322123, true, 1e-4}};

  /// The answer with the bound, and the CPU time of the faster of two.
  double
  compute(const Case &c, const double accuracy, const std::string &formulation, const double limit, Task &task)
  {
    const test::Settings settings = test::with(test::wave(c.a, c.chi, 1., 1., c.k),
                                               "Accuracy = {}; Discretization/Formulation = {}",
                                               accuracy,
                                               formulation.empty() ? "automatic" : formulation);
    double seconds                = HUGE_VAL;
    for (int i = 0; i < 2; ++i)
    {
      task              = Task();
      task.parameters   = test::parameters_with(settings);
      const double from = test::processor_seconds();
      compute_all({&task, 1}, limit, []() { return false; });
      seconds = std::min(seconds, test::processor_seconds() - from);
    }
    return seconds;
  }

  void
  show(const Case &c, const double accuracy, const std::string &formulation)
  {
    Task task;
    const double seconds           = compute(c, accuracy, formulation, /*limit=*/600., task);
    const SimulationResult &result = task.computed.result;
    const bool inverted            = result.inversion.has_value();
    const double value             = inverted ? result.inversion->t : result.displacement;
    const double wanted            = accuracy * (inverted ? 1. : std::abs(value));
    const double bound = inverted ? result.inversion->error.value_or(NAN) : result.error ? result.error->total : NAN;
    fmt::print("| {} | {:.0e} | {:.3g} ms | {:.10g} | {:.2g} | {:.2g} | {} {}, {} cells, {} steps{} |\n",
               c.name,
               accuracy,
               1e3 * seconds,
               value,
               std::abs(value - c.reference) / wanted,
               bound / wanted,
               result.formulation == Formulation::stretch ? "stretch" : "position",
               result.time.status == Status::finished || result.time.status == Status::inverted
                 ? word_of(result.time.status)
                 : result.time.reason.c_str(),
               result.mesh.n_cells,
               result.time.steps,
               inverted != c.inverts ? ", WRONG" : "");
    if (std::getenv("VERBOSE") != nullptr)
      fmt::print("    {}\n", task.computed.choice.explanation);
    std::fflush(stdout);
  }

  /// The CPU time of an answer that is as accurate as wanted, or nothing.
  std::optional<double>
  cost(const Case &c, const double accuracy, const std::string &formulation, double &least)
  {
    Task task;
    const double seconds = compute(c, accuracy, formulation, /*limit=*/20., task);
    least                = task.computed.result.min_stretch.value;
    return task.computed.result.time.status == Status::finished ? std::optional(seconds) : std::nullopt;
  }

  void
  show_trade()
  {
    fmt::print("| a | chi | k | smallest stretch | form | 1e-3 | 1e-4 | 1e-5 | 1e-6 | 1e-7 | 1e-8 |\n"
               "|---|---|---|---|---|---|---|---|---|---|---|\n");
    std::vector<Case> list;
    for (const double chi : {0.4, 0.45, 0.5, 0.525, 0.55, 0.575, 0.6})
      list.push_back({"", -1., chi, 1., 0., false, 0.});
    for (const double chi : {0.5, 0.55, 0.6})
      list.push_back({"", -0.5, chi, 1., 0., false, 0.});
    for (const double k : {1e-1, 1e-2, 1e-3, 3e-4, 1e-4})
      list.push_back({"", -1., 0.3, k, 0., false, 0.});
    for (const double a : {-3., -7., 2.})
      for (const double k : {1e-2, 1e-3, 1e-4})
        list.push_back({"", a, 0.2, k, 0., false, 0.});
    for (const Case &c : list)
      for (const char *form : {"position", "stretch"})
      {
        std::string line;
        double least = 0.;
        for (const double accuracy : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8})
        {
          const auto seconds = cost(c, accuracy, form, least);
          line += seconds ? fmt::format(" {:.3g} ms |", 1e3 * *seconds) : std::string(" - |");
        }
        fmt::print("| {} | {} | {:g} | {:.2g} | {} |{}\n", c.a, c.chi, c.k, least, form, line);
        std::fflush(stdout);
      }
  }
} // namespace

int
main(int argc, char **argv)
{
  int one            = 1;
  char *no_options[] = {argv[0], nullptr}, **none = no_options;
  const crawler::MpiSession mpi(one, none);
  const std::string part = argc > 1 ? argv[1] : "", formulation = argc > 2 ? argv[2] : "";
  if (part == "trade")
  {
    show_trade();
    return 0;
  }
  fmt::print(
    "| case | Accuracy | CPU | displacement or t* | true error | bound | by |\n|---|---|---|---|---|---|---|\n");
  for (const Case &c : cases)
    if (c.name.find(part) != std::string::npos)
      for (const double accuracy : {1e-3, 1e-4, 1e-5, 1e-6})
        if (accuracy >= c.accurate)
          show(c, accuracy, formulation);
}
