// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/accuracy_rule.h>
#include <crawler/run/result_table.h>
#include <crawler/studies/core/answer_differences.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/core/differentiated_numbers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    /// Value of a number, and the bound of its error.
    struct Known
    {
      double value, error;
    };

    Known
    known(const SimulationResult &result, const std::size_t number)
    {
      constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
      const double error       = number == 0 ? (result.error ? result.error->total : unknown)
                                             : error_bound(result, differentiated_numbers[number].key).value_or(unknown);
      return {differentiated_numbers[number].of(result), error};
    }

    /// Weights of the middle and of the four other places.
    using Weights = std::array<double, 5>;

    /// Weights of two estimates of the derivative, and of the second differences to which a kink contributes and a
    /// smooth function does not.
    struct Differences
    {
      Weights value, coarse, kink;
    };

    constexpr Differences central = {{{0., 1. / 120., -8. / 15., 8. / 15., -1. / 120.}},
                                     {{0., -1. / 8., 0., 0., 1. / 8.}},
                                     {{-15. / 8., -1. / 16., 1., 1., -1. / 16.}}};
    /// Differences to one side, which cannot detect a kink.
    constexpr Differences one_sided = {{{-25. / 12., 4., -3., 4. / 3., -0.25}}, {{-0.75, 0., 1., 0., -0.25}}, {}};

    using Values = std::array<Known, 5>;

    Known
    applied(const Weights &weights, const Values &values, const double step)
    {
      Known sum{0., 0.};
      for (std::size_t i = 0; i < values.size(); ++i)
      {
        sum.value += weights[i] * values[i].value / step;
        sum.error += std::abs(weights[i] / step) * (weights[i] != 0. ? values[i].error : 0.);
      }
      return sum;
    }
  } // namespace

  double
  step_of_differences(const double relative_error)
  {
    using namespace accuracy_rule::sensitivities;
    return std::clamp(0.5 * std::cbrt(relative_error), min_step_of_answers, largest_step_of_answers);
  }

  bool
  differentiate_answers(VariedAnswers varied,
                        const SimulationResult &result,
                        EntrySensitivity &sensitivity,
                        const std::function<bool()> &keep_going)
  {
    std::vector<Task> tasks(varied.parameters.size());
    for (std::size_t i = 0; i < tasks.size(); ++i)
    {
      tasks[i].parameters = std::move(varied.parameters[i]);
      tasks[i].gait       = result.gait.has_value();
    }
    compute_all(tasks, HUGE_VAL, [&]() { return keep_going && !keep_going(); });
    for (const Task &task : tasks)
    {
      const SimulationResult &other = task.computed.result;
      if (task.error)
        sensitivity.reason = "a run with another value failed: " + problem_of(task);
      else if (other.time.status == Status::stopped)
        sensitivity.reason = "stopped before the sensitivity was known";
      else if (other.time.status != Status::finished)
        sensitivity.reason = "a run with another value did not finish: " + other.time.message;
      else if (!other.error || !std::isfinite(other.error->total))
        sensitivity.reason = "the error of a run with another value is not known";
      if (!sensitivity.reason.empty())
        return true;
    }
    using accuracy_rule::sensitivities::suspicious;
    const bool is_central          = varied.places.front() < 0 && varied.places.back() > 0;
    const Differences &differences = is_central ? central : one_sided;
    for (std::size_t number = 0; number < differentiated_numbers.size(); ++number)
    {
      if (!has_number(number, result) ||
          !std::ranges::all_of(tasks, [number](const Task &task) { return has_number(number, task.computed.result); }))
        continue;
      Values values;
      values[0] = known(result, number);
      for (std::size_t i = 0; i < tasks.size(); ++i)
        values[i + 1] = known(tasks[i].computed.result, number);
      const Known value  = applied(differences.value, values, varied.step),
                  coarse = applied(differences.coarse, values, varied.step),
                  kink   = applied(differences.kink, values, varied.step);
      if (number == 0 && std::abs(kink.value) > 2. * kink.error + suspicious * std::abs(value.value))
        return false;
      const double error = value.error + std::abs(value.value - coarse.value) + std::abs(kink.value);
      if (!std::isfinite(error))
        continue;
      if (number == 0)
      {
        sensitivity.value = value.value;
        sensitivity.error = error;
      }
      else
        sensitivity.others.push_back({differentiated_numbers[number].key, value.value, error});
    }
    if (!sensitivity.value)
      sensitivity.reason = "the error of the displacement is not known";
    return true;
  }
} // namespace crawler
