// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/batch.h>
#include <crawler/run/summary.h>
#include <crawler/studies/run/run_files.h>

#include <fmt/format.h>

#include <sstream>

namespace crawler
{
  namespace
  {
    void
    report_scene(Log &log, const Input &input)
    {
      const Parameters &p = input.parameters;
      log.line(fmt::format("Body L = {:g}{}, k = {:g}{}, gamma = {:g}{}, p = {:g} (a = {:g}), end time {:g}{}",
                           p.body.length,
                           p.units.behind("length"),
                           p.body.elastic_modulus,
                           p.units.behind("force"),
                           p.body.friction_coefficient,
                           p.units.behind("force time/length^2"),
                           p.body.anchoring_exponent,
                           p.body.friction_exponent(),
                           p.time.end_time,
                           p.units.behind("time")));
      if (!input.scene.is_plain())
        log.line("Besides: " + input.scene.general_features());
      std::ostringstream wave;
      input.scene.active_stress->report(wave);
      std::istringstream lines(wave.str());
      log.line("Active stress: " + p.active_stress.generator);
      for (std::string line; std::getline(lines, line);)
        log.line("  " + line);
      for (const std::string &note : input.notes)
        log.line(note);
      if (const auto *failures = input.scene.active_stress->failures(); failures != nullptr && failures->count > 0)
        log.warn("warning: " + failures->latest);
    }
  } // namespace

  std::string
  in_words(const Numerics &n, const Input &input)
  {
    const TimeParameters &time   = input.parameters.time;
    const std::string integrator = integrator_of(time, n);
    const std::size_t ends       = first_cell_ends(input.scene, n).size();
    const std::size_t cells      = ends > 0 ? ends - 1 : n.n_cells;
    return fmt::format("Mesh: {} cells of degree {}, {} unknowns. Time: {}{}, tolerance {:.3g}.",
                       cells,
                       n.degree,
                       cells * n.degree + 1,
                       integrator,
                       integrator == "bdf"                 ? fmt::format(" of order {}", time.order)
                       : lane_method(input.scene, time, n) ? " (fused engine)"
                                                           : "",
                       n.tolerance);
  }

  void
  report_plan(Log &log, const Input &input, const ModelChoice &model, const NumericsChoice *const choice)
  {
    report_scene(log, input);
    log.line(model.explanation);
    if (choice != nullptr)
    {
      log.line(in_words(choice->numerics, input));
      log.line("  (" + choice->explanation + ")");
    }
    for (const std::string &note : notes_on_choice(input, model.model, choice ? &choice->numerics : nullptr))
      log.line(note);
  }

  ExitCode
  report_end(Log &log,
             const SimulationResult &result,
             const UnitNames &units,
             const std::filesystem::path &folder,
             const std::string &animation)
  {
    const TimeOutcome &outcome = result.time;
    for (const std::string &line : summary_lines(result, units))
      log.line(line);
    if (outcome.status != Status::finished)
      log.warn(outcome.reason + ": " + outcome.message);
    const auto picture = folder / animation;
    log.line(fmt::format("Results are in {}/{}.",
                         folder.string(),
                         !animation.empty() && std::filesystem::exists(picture)
                           ? fmt::format("; open {} in ParaView", picture.string())
                           : ""));
    log.require_written();
    if (outcome.status == Status::finished)
      return ExitCode::finished;
    if (outcome.status == Status::inverted)
      return ExitCode::inverted;
    if (outcome.status == Status::stopped)
      return ExitCode::stopped;
    if (outcome.reason == "ledger_residual" || outcome.reason == "net_friction" || outcome.reason == "gait_efficiency")
      return ExitCode::self_check_failed;
    return ExitCode::numerical_failure;
  }
} // namespace crawler
