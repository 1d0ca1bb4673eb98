// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/batch.h>
#include <crawler/studies/core/run_files.h>
#include <crawler/studies/run/run_plan.h>

#include <fmt/format.h>

namespace crawler
{
  std::string
  in_words(const Numerics &n, const Input &input)
  {
    const TimeParameters &time   = input.parameters.time;
    const std::string integrator = time.integrator != "automatic" ? time.integrator
                                   : n.integrator.empty()         ? "bdf"
                                                                  : n.integrator;
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
} // namespace crawler
