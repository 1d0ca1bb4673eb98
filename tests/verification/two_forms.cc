// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Random scenes over wide ranges, p from -20 to 21 and k from 1e-6 to 1e6 (in units of gamma L^2 nu), by the form that
// the program chooses and by the other one. Where both give an answer these must agree within their error bounds; how
// many end with a failure, and with which name, is counted. The exit code is 1 if an answer is silently wrong or if
// more than a hundredth of the automatic answers are failures.
//
//     two_forms FIRST-LAST OUT.csv [Accuracy] [seconds that a run of the other form may take]
#include "random_scenes.h"

#include <crawler/accuracy/run_as_promised.h>
#include <crawler/studies/core/compute.h>

#include <deal.II/base/mpi.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <map>

namespace
{
  using namespace crawler;

  /// An inversion that only one form has located is believed within this part of the duration.
  constexpr double same_time = 0.03;

  /// Body and time are those of no other random scenes; the stress is 0 at the ends, or that of an optimal wave.
  test::RandomScene
  wide_scene(const unsigned int number)
  {
    test::Random r(7000 + number);
    test::RandomScene scene;
    const double p = r.chance(0.3)   ? static_cast<double>(r.whole(0, 41)) - 20.
                     : r.chance(0.5) ? r.uniform(-20., 21.)
                                     : r.uniform(0., 4.);
    const double L = r.log_uniform(0.1, 10.), gamma = r.log_uniform(0.1, 10.), nu = r.log_uniform(0.1, 10.);
    const double unit = gamma * L * L * nu, k = r.log_uniform(1e-6, 1e6) * unit;
    const double T = r.log_uniform(0.3, 4.) / nu;
    scene.settings = {{"Body/Length", test::text(L)},
                      {"Body/Friction coefficient", test::text(gamma)},
                      {"Body/Elastic modulus", test::text(k)},
                      {"Body/Anchoring exponent", test::text(p)},
                      {"Time/End time", test::text(T)}};
    const auto set = [&scene](const std::string &entry, const std::string &value) {
      scene.settings.emplace_back("Active stress/" + entry, value);
    };
    const double strength = 1. + 0.2 * std::abs(1. - p); // steep friction makes much of a little strain
    if (r.chance(0.5))
    {
      scene.kind     = "wide wave";
      const double c = r.chance(0.5) ? nu * L : -nu * L;
      set("Optimal wave/Perturbation parameter", test::text(r.uniform(0.03, 0.7) / (2. * strength)));
      set("Optimal wave/Sine coefficients", test::text(nu * L));
      set("Optimal wave/Choose wave by", "wave speed");
      set("Optimal wave/Wave speed", test::text(c));
      return scene;
    }
    scene.kind     = "wide formula";
    const double A = r.uniform(0.02, 0.4) / strength * (k + unit / 40.);
    set("Generator", "expression");
    set("Expression/Active stress",
        fmt::format("A*sin(pi*s/L)^2*(1-exp(-5*nu*t))*sin(2*pi*({}*s/L+({})*nu*t)+{})",
                    r.whole(1, 3),
                    test::text(r.uniform(-2., 2.)),
                    test::text(r.uniform(0., 6.3))));
    set("Expression/Constants", fmt::format("A={}, nu={}", test::text(A), test::text(nu)));
    return scene;
  }

  test::RandomScene
  scene_of(const unsigned int number)
  {
    switch (number % 5)
    {
      case 0:
        return test::random_scene(number);
      case 1:
        return test::hard_scene(test::first_hard_scene + number);
      default:
        return wide_scene(number);
    }
  }

  struct FormAnswer
  {
    SimulationResult result;
    bool is_out_of_time = false;
    double seconds      = 0.;
    std::string refused;

    bool
    is(const Status status) const
    {
      return result.time.status == status;
    }
  };

  FormAnswer
  answer(test::Settings settings, const std::string &formulation, const double accuracy, const double limit)
  {
    settings.emplace_back("Accuracy", test::text(accuracy));
    settings.emplace_back("Discretization/Formulation", formulation);
    Task task;
    task.parameters = test::parameters_with(settings);
    compute_all({&task, 1}, limit, []() { return false; });
    FormAnswer answer{task.computed.result, task.is_out_of_time, task.seconds, ""};
    if (task.error)
      try
      {
        std::rethrow_exception(task.error);
      }
      catch (const std::exception &error)
      {
        answer.refused = error.what();
      }
    return answer;
  }

  /// Of the displacement or the time of the inversion; a failure with a displacement has reported its error, too.
  double
  bound(const FormAnswer &a, const double T)
  {
    if (a.result.inversion)
      return std::max(a.result.inversion_error.value_or(same_time * T), same_time * T);
    return a.result.error ? a.result.error->total : NAN;
  }

  bool
  has_answer(const FormAnswer &a)
  {
    return a.is(Status::inverted) || a.is(Status::finished) ||
           (a.result.time.reason == accuracy_not_met && a.result.error && std::isfinite(a.result.error->total));
  }

  std::string
  judge(const FormAnswer &a, const FormAnswer &b, const double T)
  {
    if (!has_answer(a) || !has_answer(b) || std::isnan(bound(a, T)) || std::isnan(bound(b, T)))
      return "not compared";
    if (a.result.inversion.has_value() != b.result.inversion.has_value())
    {
      // A body at the brink.
      const FormAnswer &lost = a.result.inversion ? a : b;
      return lost.result.inversion->t > (1. - same_time) * T ? "agree" : "WRONG: one inverts";
    }
    const double x = a.result.inversion ? a.result.inversion->t - b.result.inversion->t
                                        : a.result.displacement - b.result.displacement;
    return std::abs(x) <= bound(a, T) + bound(b, T) ? "agree" : "WRONG";
  }
} // namespace

int
main(int argc, char **argv)
{
  int one            = 1;
  char *no_options[] = {argv[0], nullptr}, **none = no_options;
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(one, none, 1);
  unsigned int first = 0, last = 0;
  if (argc < 3 || std::sscanf(argv[1], "%u-%u", &first, &last) != 2)
  {
    fmt::print(stderr, "two_forms FIRST-LAST OUT.csv [Accuracy] [seconds]\n");
    return 2;
  }
  const double accuracy = argc > 3 ? std::stod(argv[3]) : 1e-4, limit = argc > 4 ? std::stod(argv[4]) : 3.;
  std::ofstream out(argv[2]);
  out << "number,kind,form,status,reason,seconds,displacement,bound,inversion,other status,other reason,other "
         "seconds,other displacement,other bound,other inversion,verdict\n";
  std::map<std::string, unsigned int> verdicts, failures;
  unsigned int n = 0, n_failed = 0, n_wrong = 0, n_slow = 0;
  for (unsigned int number = first; number <= last; ++number, ++n)
  {
    const test::RandomScene scene = scene_of(number);
    const double T                = [&]() {
      for (const auto &[entry, value] : scene.settings)
        if (entry == "Time/End time")
          return std::stod(value);
      return 1.;
    }();
    const FormAnswer own      = answer(scene.settings, "automatic", accuracy, 60.);
    const bool is_stretch     = own.result.formulation == Formulation::stretch;
    const FormAnswer other    = answer(scene.settings, is_stretch ? "position" : "stretch", accuracy, limit);
    const std::string verdict = judge(own, other, T);
    ++verdicts[verdict];
    n_wrong += verdict.starts_with("WRONG");
    n_slow += own.seconds > 3.;
    if (!own.is(Status::finished) && !own.is(Status::inverted))
    {
      ++n_failed;
      ++failures[own.result.time.reason.empty() ? word_of(own.result.time.status) + own.refused
                                                : own.result.time.reason];
    }
    const auto numbers = [&](const FormAnswer &a) {
      return fmt::format("{},{},{:.3g},{:.12g},{:.3g},{:.8g}",
                         word_of(a.result.time.status),
                         a.is_out_of_time ? "time_limit" : a.result.time.reason,
                         a.seconds,
                         a.result.displacement,
                         bound(a, T),
                         a.result.inversion ? a.result.inversion->t : NAN);
    };
    out << fmt::format("{},{},{},{},{},{}\n",
                       number,
                       scene.kind,
                       is_stretch ? "stretch" : "position",
                       numbers(own),
                       numbers(other),
                       verdict)
        << std::flush;
    if (verdict.starts_with("WRONG"))
      for (const auto &[entry, value] : scene.settings)
        fmt::print("  --set \"{}={}\"", entry, value);
    if (verdict.starts_with("WRONG"))
      fmt::print(
        "{}: {}: {} {}\n   {}\n   {}\n", number, verdict, scene.kind, is_stretch, numbers(own), numbers(other));
    std::fflush(stdout);
  }
  fmt::print("{} scenes at Accuracy {:g}; {} answers took more than 3 s\n", n, accuracy, n_slow);
  for (const auto &[verdict, count] : verdicts)
    fmt::print("  {}: {}\n", verdict, count);
  fmt::print("failures: {}\n", n_failed);
  for (const auto &[reason, count] : failures)
    fmt::print("  {}: {}\n", reason, count);
  return n_wrong > 0 || 100 * n_failed > n ? 1 : 0;
}
