// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/answer.h>
#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/swept_error.h>
#include <crawler/adjoint/error_sweep.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace crawler
{
  void
  sweep_error(const RunParameters &parameters,
              const Scene &scene,
              const NumericsChoice &choice,
              SimulationResult &result,
              const std::function<bool()> &keep_going)
  {
    constexpr double max_work = 5e4; // steps times cells: about a second
    if (result.time.status != Status::finished || !result.error || !std::isfinite(result.error->total) ||
        result.cycles || scene.ground.direction.is_uneven() || // moving kinks have no higher orders
        !RecordedRun::is_possible(scene, parameters.time, choice.numerics) ||
        static_cast<double>(result.time.steps) * result.most_cells > max_work)
      return;
    DisplacementError &error = *result.error;
    try
    {
      const RecordedRun run(scene, parameters.time, choice.numerics, keep_going);
      const auto swept = sweep_errors(run);
      if (!swept || !swept->is_good())
        return;
      const double value = run.displacement + swept->time + swept->space;
      const double bound = std::max(swept->bound_of_corrected(), displacement_round_off * scene.body.length);
      const double found = std::abs(result.displacement - value);
      if (bound < found) // otherwise it may be the sweep's own error
        error.total = std::max(error.total, found);
      if (bound < error.total)
        result.corrected = {value, bound};
      const double all = swept->time_sum + swept->space_sum;
      if (all > 0.)
      {
        error.space = error.total * swept->space_sum / all;
        error.time  = error.total - error.space;
      }
    }
    catch (const std::runtime_error &) // the answer and its bound stay
    {
    }
    if (std::isfinite(choice.wanted_error) && fails_accuracy(result, choice.wanted_error, ""))
      result.time.message = "by the adjoint, " + result.time.message;
  }
} // namespace crawler
