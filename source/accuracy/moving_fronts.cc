// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/extrapolation.h>
#include <crawler/accuracy/finer_run_errors.h>
#include <crawler/accuracy/moving_fronts.h>
#include <crawler/mesh/reference_element.h>
#include <crawler/run/gait_efficiency.h>
#include <crawler/run/result_table.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    // Constants measured by tests/verification/square_actuation_test.cc; doc/numerics.md, "Jumps that move".
    /// Widths of fronts, relative to the widest that fit: the first, halved each time, and the last.
    constexpr double first_part = 0.32, last_part = 0.0025;
    /// Largest number of widths of an answer.
    constexpr unsigned int max_levels = 5;
    /// Limits of the error bound, as multiples of the change by one width less, and of that since the answer before.
    constexpr double factor = 2., factor_of_change = 0.5;
    /// Accuracy of the runs, relative to the wanted one, and its limits.
    constexpr double part_of_runs = 0.1, min_accuracy = 1e-9, largest_accuracy = 1e-3;
    /// Steps of all runs after which no steeper fronts are tried.
    constexpr unsigned long max_steps = 100000;
    /// Relative change of the time of an inversion from fronts to fronts below which it is known.
    constexpr double settled_inversion = 1e-2;

    class Fronts
    {
    public:
      Fronts(const Problem &problem, const std::function<Answer(const Problem &)> &answer_of)
        : problem_(problem)
        , answer_of_(answer_of)
        , parameters_(problem.parameters)
      {
        parameters_.accuracy = std::clamp(part_of_runs * problem.parameters.accuracy, min_accuracy, largest_accuracy);
        parameters_.error_estimate = true; // the fronts are chosen by it
      }

      Answer
      compute()
      {
        for (double part = first_part; part >= last_part && n_steps_ <= max_steps; part *= 0.5)
        {
          const Scene scene   = *with_fronts(problem_.scene, part);
          Answer next         = answer_of_({parameters_, scene, problem_.keep_going});
          const bool inverted = next.result.time.status == Status::inverted;
          const bool is_known = next.result.error && std::isfinite(next.result.error->total);
          const bool stopped  = next.result.time.status == Status::stopped;
          if (!inverted && !is_known && !stopped && answer_.result.error) // the earlier answer is better
            break;
          answer_                            = std::move(next);
          answer_.choice.has_fronts          = true;
          answer_.choice.front_part          = part;
          answer_.choice.numerics.jumps_move = true; // no single run is the answer
          answer_.choice.explanation = fmt::format("jumps that move: the {}fronts of {:g} of the widest that fit, {}",
                                                   levels_.empty() ? "" : "extrapolation of wider fronts and of ",
                                                   part,
                                                   answer_.choice.explanation);
          if (inverted ? confirms_inversion() : !is_known)
            break;
          if (inverted)
            continue;
          n_steps_ += answer_.result.time.steps;
          levels_.push_back({part, answer_.result});
          if (levels_.size() > max_levels)
            levels_.erase(levels_.begin());
          if (levels_.size() == 1)
            continue;
          extrapolate();
          if (answer_.result.error->total <= wanted())
            break;
        }
        judge();
        return answer_;
      }

    private:
      struct Level
      {
        double width;
        SimulationResult result;
      };

      /// Confirms an inversion, whose time has to settle.
      bool
      confirms_inversion()
      {
        levels_.clear();
        const double t    = answer_.result.inversion->t;
        const bool second = inversion_.has_value();
        if (second)
          answer_.result.inversion->error = 2. * std::abs(t - *inversion_);
        inversion_ = t;
        return second &&
               *answer_.result.inversion->error <= std::max(problem_.parameters.accuracy, settled_inversion) * t;
      }

      double
      wanted() const
      {
        const SimulationResult &result = answer_.result;
        const double size = std::max(std::abs(result.displacement), displacement_floor * result.size.largest_u);
        return problem_.parameters.accuracy * size;
      }

      /// Extrapolated results of the levels from @p first on; their errors add up to that in time.
      SimulationResult
      extrapolated(const std::size_t first) const
      {
        std::vector<double> widths;
        std::vector<const SimulationResult *> results;
        for (std::size_t i = first; i < levels_.size(); ++i)
        {
          widths.push_back(levels_[i].width);
          results.push_back(&levels_[i].result);
        }
        const std::vector<double> weights = interpolation_matrix(widths, {0.});
        SimulationResult sum              = combined(problem_.scene, results, weights);
        for (const auto extreme : {&SimulationResult::Stretch::min, &SimulationResult::Stretch::max})
        {
          double value = 0.;
          for (std::size_t i = 0; i < results.size(); ++i)
            value += weights[i] * (results[i]->stretch.*extreme).value;
          if (value > 0.)
            (sum.stretch.*extreme).value = value;
        }
        set_efficiencies(problem_.scene, sum);
        sum.error = DisplacementError{.time = 0.};
        for (std::size_t i = 0; i < results.size(); ++i)
          sum.error->time += std::abs(weights[i]) * results[i]->error->total;
        return sum;
      }

      void
      extrapolate()
      {
        const SimulationResult &steepest = levels_.back().result;
        SimulationResult result          = extrapolated(0);
        const SimulationResult other     = extrapolated(1);
        const double time                = result.error->time;
        // Extrapolations of fewer widths sometimes agree too well: the previous answer counts, too.
        result.error.emplace();
        if (before_)
        {
          const double space = std::max(factor * std::abs(result.displacement - other.displacement),
                                        factor_of_change * std::abs(result.displacement - *before_));
          result.error       = {.total = space + time, .space = space, .time = time, .model = 0.};
        }
        before_       = result.displacement;
        result.errors = number_errors(result, other, factor, parameters_.accuracy);
        // Numbers that are found by sampling do not depend on the width smoothly: the change by the extrapolation
        // counts.
        const auto changes = number_errors(result, steepest, factor, parameters_.accuracy);
        for (std::size_t i = 0; i < changes.size(); ++i)
          if (entries_with_errors()[i]->is_sampled)
            result.errors[i] = std::max(result.errors[i], changes[i]);
        add_errors_of_cycles(result, std::abs(result.displacement));
        extend_errors(problem_.scene, result);
        result.time                 = steepest.time;
        answer_.result              = std::move(result);
        answer_.choice.wanted_error = wanted();
      }

      /// Judges the answer: one not as accurate as wanted, or of one width of fronts only, is none.
      void
      judge()
      {
        SimulationResult &result = answer_.result;
        if (result.time.status != Status::finished && result.time.reason != accuracy_not_met)
          return;
        if (!before_)
          result.error.emplace();
        result.time.status = Status::finished;
        result.time.reason = result.time.message = "";
        fails_accuracy(result, wanted(), "steeper fronts have no answer");
      }

      const Problem &problem_;
      const std::function<Answer(const Problem &)> &answer_of_;
      RunParameters parameters_; ///< parameters of the runs
      Answer answer_;
      std::vector<Level> levels_;
      std::optional<double> inversion_; ///< time of inversion of the previous fronts
      std::optional<double> before_;    ///< displacement extrapolated to fewer widths
      unsigned long n_steps_ = 0;
    };
  } // namespace

  Answer
  answer_of_fronts(const Problem &problem, const std::function<Answer(const Problem &)> &answer_of)
  {
    return Fronts(problem, answer_of).compute();
  }

  Scene
  shown_scene(const NumericsChoice &choice, const Scene &scene)
  {
    return choice.front_part > 0. ? with_fronts(scene, choice.front_part).value_or(scene) : scene;
  }
} // namespace crawler
