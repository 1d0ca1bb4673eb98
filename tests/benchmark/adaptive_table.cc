// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Does an adaptive mesh of the position form pay? For each scene and each relative error of the displacement the
// cheapest setting that reaches it, over numbers of cells (uniform) or mesh tolerances (adaptive) and time tolerances.
// Prints a table in Markdown (doc/numerics.md, "Adaptive against uniform meshes"); nothing is required of it. Takes
// minutes, wants an idle machine.
//
//     adaptive_table contrib/reference/extremes.json [part of a scene's name]
#include "../support/processor_time.h"
#include "../support/run_text.h"

#include <crawler/base/mpi_session.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <optional>

namespace
{
  using namespace crawler;

  constexpr double longest_run = 4.; ///< [s]; settings that take longer are out

  struct Case
  {
    std::string name;
    Parameters parameters;
    double displacement, error; ///< the reference and its own error
  };

  /// What one setting gives, and what it costs.
  struct Trial
  {
    std::string mesh;
    double seconds     = 0.;
    unsigned int cells = 0, degree = 0, steps = 0, mesh_changes = 0;
    std::string integrator;
    double error = 0.;
  };

  Case
  from_table(const nlohmann::json &rows, const std::string &name, const std::string &title)
  {
    for (const auto &row : rows)
      if (row["name"] == name)
        return {title,
                test::parameters_with(
                  test::wave(row["exponent"], row["chi"], row["speed"], row["end_time"], row["elastic_modulus"])),
                row["displacement"],
                row["error"]};
    throw std::runtime_error("extremes.json has no row \"" + name + "\"");
  }

  SimulationResult
  run(const Parameters &parameters,
      const Numerics &numerics,
      const double limit            = longest_run,
      const std::string &integrator = "bdf")
  {
    const Scene scene   = parameters.create_scene();
    TimeParameters time = parameters.time;
    time.integrator     = integrator;
    Simulation simulation(MPI_COMM_WORLD, scene, time, numerics);
    const double start = test::processor_seconds();
    return simulation.run({}, {}, {}, [&]() { return test::processor_seconds() - start < limit; });
  }

  /// A Gaussian that travels along the body; the reference is a run with far finer uniform meshes.
  Case
  travelling_pulse(const double width)
  {
    Case pulse{fmt::format("pulse of width {:g}", width),
               test::parameters_with(
                 test::set("expression; Active stress = 0.5*(1-exp(-(t/0.1)^2))*exp(-((s-0.2-0.6*t)/{})^2)", width)),
               0.,
               0.};
    const auto reference = [&](const unsigned int degree, const double cells, const double tolerance) {
      return run(pulse.parameters,
                 {degree, static_cast<unsigned int>(cells / width), tolerance, 1e-5, {{0., width}}},
                 1e3)
        .displacement;
    };
    pulse.displacement = reference(6, 5., 1e-12);
    pulse.error        = std::abs(reference(5, 4., 1e-11) - pulse.displacement);
    return pulse;
  }

  /// The median cost of three runs, if the error is reached.
  std::optional<Trial>
  attempt(
    const Case &scene, const Numerics &numerics, const std::string &integrator, const double wanted, const double limit)
  {
    std::vector<double> seconds;
    SimulationResult result;
    for (int i = 0; i < 3; ++i)
    {
      const double start = test::processor_seconds();
      result             = run(scene.parameters, numerics, limit, integrator);
      seconds.push_back(test::processor_seconds() - start);
      if (result.time.status != Status::finished || seconds[0] > 1.)
        break;
    }
    const double error = std::abs(result.displacement / scene.displacement - 1.);
    if (result.time.status != Status::finished || !(error <= wanted))
      return std::nullopt;
    std::sort(seconds.begin(), seconds.end());
    return Trial{"",
                 seconds[seconds.size() / 2],
                 result.most_cells,
                 numerics.degree,
                 result.time.steps,
                 result.mesh_changes,
                 integrator,
                 error};
  }

  /// The cheapest of the settings, from coarse to fine for each time tolerance; the first that is fine enough counts.
  std::optional<Trial>
  cheapest(const Case &scene,
           const double wanted,
           const std::vector<double> &levels,
           const std::function<void(Numerics &, double level)> &set_mesh)
  {
    std::optional<Trial> best;
    for (const std::string integrator : {"bdf", "radau 5", "radau 9"})
      for (const unsigned int degree : {4u, 6u})
        for (const double part :
             integrator == "bdf" ? std::vector<double>{0.1, 0.02, 0.004} : std::vector<double>{10., 1., 0.1})
          for (const double level : levels)
          {
            Numerics numerics;
            numerics.degree       = degree;
            numerics.tolerance    = part * wanted * std::abs(scene.displacement);
            numerics.initial_step = integrator == "bdf" ? 1e-5 : 1e-3;
            set_mesh(numerics, level);
            const auto trial = attempt(scene, numerics, integrator, wanted, best ? 1.5 * best->seconds : longest_run);
            if (!trial)
              continue;
            if (!best || trial->seconds < best->seconds)
              best = trial;
            break;
          }
    return best;
  }

  std::string
  in_words(const std::optional<Trial> &trial)
  {
    return trial ? fmt::format("{}, {} cells of degree {}, {} steps{}: {:.3g} s",
                               trial->integrator,
                               trial->cells,
                               trial->degree,
                               trial->steps,
                               trial->mesh_changes > 0 ? fmt::format(", {} meshes", trial->mesh_changes + 1) : "",
                               trial->seconds)
                 : "not reached";
  }
} // namespace

int
main(int argc, char **argv)
{
  int one = 1;
  const crawler::MpiSession guard(one, argv);
  std::ifstream file(argc > 1 ? argv[1] : "");
  if (!file)
  {
    fmt::print(stderr, "usage: adaptive_table contrib/reference/extremes.json [part of a scene's name]\n");
    return 2;
  }
  const auto rows         = nlohmann::json::parse(file)["rows"];
  const std::string only  = argc > 2 ? argv[2] : "";
  std::vector<Case> cases = {from_table(rows, "exponent a=-20 chi=0.4", "a = -20, chi = 0.4"),
                             from_table(rows, "modulus k=1e-4 chi=0.3", "k = 1e-4, chi = 0.3"),
                             from_table(rows, "modulus k=1e-6 chi=0.3", "k = 1e-6, chi = 0.3")};
  if (only.empty() || only.starts_with("pulse"))
    for (const double width : {0.01, 0.003})
      cases.push_back(travelling_pulse(width));

  std::vector<double> numbers, tolerances;
  for (double n = 4; n <= 4096; n *= 2)
    for (const double between : {1., 1.4142})
      numbers.push_back(std::round(n * between));
  for (double tolerance = 1e-1; tolerance > 1e-13; tolerance *= 0.1)
    tolerances.push_back(tolerance);
  const auto uniform = [](Numerics &numerics, const double level) {
    numerics.n_cells = static_cast<unsigned int>(level);
  };
  const auto adaptive = [](Numerics &numerics, const double level) {
    numerics.n_cells         = 8;
    numerics.mesh.tolerance  = level;
    numerics.mesh.most_cells = 4096;
  };
  fmt::print("| scene | relative error | uniform | adaptive | uniform / adaptive |\n|---|---|---|---|---|\n");
  for (const Case &scene : cases)
    if (scene.name.find(only) != std::string::npos)
      for (const double wanted : {1e-3, 1e-4, 1e-5, 1e-6})
      {
        if (scene.error > 0.3 * wanted * std::abs(scene.displacement))
          continue; // the reference does not know better
        const auto u = cheapest(scene, wanted, numbers, uniform);
        const auto a = cheapest(scene, wanted, tolerances, adaptive);
        fmt::print("| {} | {:.0e} | {} | {} | {} |\n",
                   scene.name,
                   wanted,
                   in_words(u),
                   in_words(a),
                   u && a ? fmt::format("{:.2g}", u->seconds / a->seconds) : "");
        std::fflush(stdout);
      }
  return 0;
}
