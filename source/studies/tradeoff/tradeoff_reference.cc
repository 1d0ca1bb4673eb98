// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/core/compute.h>
#include <crawler/studies/tradeoff/tradeoff_reference.h>

#include <fmt/format.h>

#include <cmath>

namespace crawler
{
  namespace
  {
    constexpr double round_off = 1e-14;
    /// Longest time for an answer, in time limits of a run.
    constexpr double time_factor = 2.;
    /// Values of Accuracy: the first, the factor from one to the next, and the loosest of use.
    constexpr double first_accuracy = 1e-12, first_of_check = 1e-10, next = 100., loosest = 1e-4, loosest_check = 1e-6;
    constexpr double coarse_accuracy = 1e-3;

    Task
    computed(const Parameters &parameters, const double accuracy, const std::function<bool()> &interrupted)
    {
      Task task;
      task.parameters          = parameters;
      task.parameters.accuracy = accuracy;
      compute_all({&task, 1}, time_factor * parameters.tradeoff.run_time_limit, interrupted);
      return task;
    }

    /// Finds the answer with the smallest Accuracy from @p accuracy to @p last that is reached. Without method if there
    /// is none; @p reference then says why.
    TradeoffAnswer
    find_answer(const Parameters &parameters,
                double accuracy,
                const double last,
                TradeoffReference &reference,
                const std::function<bool()> &interrupted)
    {
      for (; accuracy <= 1.001 * last && !interrupted(); accuracy *= next)
      {
        const Task task              = computed(parameters, accuracy, interrupted);
        const auto &[result, choice] = task.computed;
        const PointStatus outcome    = status_of(task);
        if (outcome.status == "finished" && result.error && std::isfinite(result.error->total))
          return {fmt::format("{}, {}, {}, degree {}, Accuracy {:.0e}",
                              word_of(choice.numerics.formulation),
                              result.process.engine,
                              result.process.integrator,
                              choice.numerics.degree,
                              accuracy),
                  result.displacement,
                  result.error->total};
        reference.status  = outcome.status;
        reference.message = outcome.message;
        if (outcome.status == "inverted")
          break;
        if (outcome.status == "finished" ||
            task.is_out_of_time) // the run or the one that measures its error took too long
        {
          reference.status = "failed";
          reference.message =
            fmt::format("no run whose error is known within {:g} s; a larger Tradeoff/Time limit per run is needed",
                        time_factor * parameters.tradeoff.run_time_limit);
        }
      }
      return {};
    }

    /// Size to which Accuracy is relative, where round-off does not count.
    double
    size_of_displacement(const Parameters &free, const double displacement, const std::function<bool()> &interrupted)
    {
      const Task task   = computed(free, coarse_accuracy, interrupted);
      const double size = task.computed.choice.wanted_error / coarse_accuracy, least = std::abs(displacement);
      if (!task.error && size > 1.01 * least) // set by the deformation
        return size;
      return least > 0. ? least : free.body.length;
    }
  } // namespace

  TradeoffReference
  make_reference(const Parameters &parameters, const std::function<bool()> &interrupted)
  {
    Parameters free      = parameters.with_free_numerics();
    free.model           = Model::nonlinear;
    free.time.cycle_stop = CycleStopMode::off;
    TradeoffReference reference;
    const TradeoffAnswer &answer = reference.answer, &check = reference.check;
    reference.answer = find_answer(free, first_accuracy, loosest, reference, interrupted);
    if (!answer.method.empty())
    {
      Parameters other                 = free;
      other.discretization.formulation = FormulationEntry::position;
      other.discretization.degree      = 7;
      other.time.integrator            = "radau 5";
      other.time.engine                = Engine::petsc;
      reference.check                  = find_answer(other, first_of_check, loosest_check, reference, interrupted);
      reference.displacement           = answer.displacement;
      reference.size                   = size_of_displacement(free, answer.displacement, interrupted);
      reference.bar                    = answer.error_bound + round_off * reference.size;
      if (!check.method.empty())
        reference.bar += std::abs(answer.displacement - check.displacement);
      reference.relative_bar = reference.bar / reference.size;
      reference.status       = "finished";
      reference.message      = "";
    }
    if (interrupted())
      reference.status = "stopped";
    return reference;
  }
} // namespace crawler
