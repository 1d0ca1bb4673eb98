// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/tradeoff/tradeoff_reference.h>
#include <crawler/time/failure.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace crawler
{
  NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TradeoffAnswer, method, displacement, error_bound)
  NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TradeoffReference, answer, check, bar, size, status, message)

  namespace
  {
    constexpr double round_off = 1e-14;
    /// An answer may take so many times the time limit of a run.
    constexpr double time_factor = 2.;
    /// Values of Accuracy: from these on, by this factor, down to the loosest that is any use.
    constexpr double first_accuracy = 1e-12, first_of_check = 1e-10, next = 100., loosest = 1e-4, loosest_check = 1e-6;
    constexpr double coarse_accuracy = 1e-3;

    /// Nonlinear model, and numerics that the program chooses.
    Parameters
    with_free_numerics(const Parameters &parameters)
    {
      Parameters free      = parameters;
      free.model           = Model::nonlinear;
      free.discretization  = {};
      free.time            = {};
      free.time.end_time   = parameters.time.end_time;
      free.time.max_steps  = parameters.time.max_steps;
      free.time.cycle_stop = CycleStopMode::off;
      return free;
    }

    /// What cannot be computed in this way has failed.
    TimeOutcome
    outcome_of(const Task &task)
    {
      if (!task.error)
        return task.computed.result.time;
      TimeOutcome outcome;
      try
      {
        outcome = failure_of(task.error);
      }
      catch (const InputError &error)
      {
        outcome.status  = Status::failed;
        outcome.message = error.what();
      }
      return outcome;
    }

    class ReferenceMaker
    {
    public:
      ReferenceMaker(const std::function<bool()> &interrupted, const std::function<void(const std::string &)> &report)
        : interrupted_(interrupted)
        , report_(report)
      {
      }

      TradeoffReference
      make(const Parameters &parameters)
      {
        Parameters own                 = with_free_numerics(parameters);
        reference_.answer              = answer(own, first_accuracy, loosest);
        own.discretization.formulation = FormulationEntry::position;
        own.discretization.degree      = 7;
        own.time.integrator            = "radau 5";
        own.time.engine                = Engine::petsc;
        if (!reference_.answer.method.empty() && !interrupted_())
          reference_.check = answer(own, first_of_check, loosest_check);
        if (interrupted_())
        {
          reference_.status  = "stopped";
          reference_.message = "stopped while the reference was made";
        }
        else if (!reference_.answer.method.empty())
          finish(parameters);
        return reference_;
      }

    private:
      void
      finish(const Parameters &parameters)
      {
        const TradeoffAnswer &answer = reference_.answer, &check = reference_.check;
        reference_.status = "finished";
        reference_.message.clear();
        // What Accuracy is relative to, where round-off does not count.
        reference_.size = std::abs(answer.displacement);
        Task task;
        task.parameters          = with_free_numerics(parameters);
        task.parameters.accuracy = coarse_accuracy;
        compute_all({&task, 1}, time_factor * parameters.tradeoff.run_time_limit, interrupted_);
        const double size = task.computed.choice.wanted_error / coarse_accuracy;
        if (!task.error && size > 1.01 * reference_.size) // the deformation counts
          reference_.size = size;
        if (!(reference_.size > 0.))
          reference_.size = parameters.body.length;
        reference_.bar = answer.error_bound + round_off * reference_.size;
        if (reference_.is_checked())
          reference_.bar += std::abs(answer.displacement - check.displacement);
      }

      /// Without method if there is none; reference_ then says why.
      TradeoffAnswer
      answer(Parameters parameters, const double first, const double last)
      {
        for (double accuracy = first; accuracy <= 1.001 * last && !interrupted_(); accuracy *= next)
        {
          Task task;
          parameters.accuracy = accuracy;
          task.parameters     = parameters;
          compute_all({&task, 1}, time_factor * parameters.tradeoff.run_time_limit, interrupted_);
          const SimulationResult &result = task.computed.result;
          const TimeOutcome outcome      = outcome_of(task);
          if (outcome.status == Status::finished && result.error && std::isfinite(result.error->total))
          {
            const auto &numerics = task.computed.choice.numerics;
            TradeoffAnswer found = {fmt::format("{}, {}, {}, degree {}, Accuracy {:.0e}",
                                                numerics.formulation == Formulation::stretch ? "stretch" : "position",
                                                result.engine,
                                                result.integrator,
                                                numerics.degree,
                                                accuracy),
                                    result.displacement,
                                    result.error->total};
            report_(fmt::format("  {:.1f} s: {}: {:.15g}, error bound {:.1e}",
                                task.seconds,
                                found.method,
                                found.displacement,
                                found.error_bound));
            return found;
          }
          // The run took too long, or the one that measures its error.
          const bool is_late = outcome.status == Status::finished || task.is_out_of_time;
          reference_.status  = is_late ? "failed" : word_of(outcome.status);
          reference_.message =
            is_late
              ? fmt::format("no run whose error is known within {:g} s; a larger Tradeoff/Time limit per run is needed",
                            time_factor * parameters.tradeoff.run_time_limit)
              : outcome.message;
          if (outcome.status == Status::inverted)
            break;
        }
        return {};
      }

      const std::function<bool()> &interrupted_;
      const std::function<void(const std::string &)> &report_;
      TradeoffReference reference_;
    };
  } // namespace

  TradeoffReference
  make_reference(const Parameters &parameters,
                 const std::function<bool()> &interrupted,
                 const std::function<void(const std::string &)> &report)
  {
    return ReferenceMaker(interrupted, report).make(parameters);
  }

  std::string
  pack(const TradeoffReference &reference)
  {
    return nlohmann::json(reference).dump(-1, ' ', /*ensure_ascii=*/false, nlohmann::json::error_handler_t::replace);
  }

  TradeoffReference
  unpack_reference(const std::string &text)
  {
    return nlohmann::json::parse(text).get<TradeoffReference>();
  }
} // namespace crawler
