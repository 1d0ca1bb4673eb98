// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The CPU time of both forms for bodies that become emptier or softer: which one is the cheaper one at which Accuracy
// (doc/numerics.md, "Which form"; choose_form() follows that). It is that of the whole answer with its bound, as a
// point of a sweep takes it, the faster of two. Prints Markdown; nothing is required of it.
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
    double a, chi, k;
  };

  /// The CPU time of an answer that is as accurate as wanted, or nothing; and the smallest stretch.
  std::optional<double>
  cost(const Case &one, const double accuracy, const char *formulation, double &least)
  {
    const test::Settings settings = test::with(test::wave(one.a, one.chi, 1., 1., one.k),
                                               "Accuracy = {}; Discretization/Formulation = {}",
                                               accuracy,
                                               formulation);
    double seconds                = HUGE_VAL;
    Task task;
    for (int i = 0; i < 2; ++i)
    {
      task              = Task();
      task.parameters   = test::parameters_with(settings);
      const double from = test::processor_seconds();
      compute_all({&task, 1}, /*time_limit=*/20., []() { return false; });
      seconds = std::min(seconds, test::processor_seconds() - from);
    }
    least = task.computed.result.stretch.min.value;
    return task.computed.result.time.status == Status::finished ? std::optional(seconds) : std::nullopt;
  }
} // namespace

int
main(int, char **argv)
{
  int n              = 1;
  char *no_options[] = {argv[0], nullptr}, **none = no_options;
  const crawler::MpiSession mpi(n, none);
  std::vector<Case> cases;
  for (const double chi : {0.4, 0.45, 0.5, 0.525, 0.55, 0.575, 0.6})
    cases.push_back({-1., chi, 1.});
  for (const double chi : {0.5, 0.55, 0.6})
    cases.push_back({-0.5, chi, 1.});
  for (const double k : {1e-1, 1e-2, 1e-3, 3e-4, 1e-4})
    cases.push_back({-1., 0.3, k});
  for (const double a : {-3., -7., 2.})
    for (const double k : {1e-2, 1e-3, 1e-4})
      cases.push_back({a, 0.2, k});
  fmt::print("| a | chi | k | smallest stretch | form | 1e-3 | 1e-4 | 1e-5 | 1e-6 | 1e-7 | 1e-8 |\n"
             "|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Case &one : cases)
    for (const char *form : {"position", "stretch"})
    {
      std::string line;
      double least = 0.;
      for (const double accuracy : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8})
      {
        const auto seconds = cost(one, accuracy, form, least);
        line += seconds ? fmt::format(" {:.3g} ms |", 1e3 * *seconds) : std::string(" - |");
      }
      fmt::print("| {} | {} | {:g} | {:.2g} | {} |{}\n", one.a, one.chi, one.k, least, form, line);
      std::fflush(stdout);
    }
}
