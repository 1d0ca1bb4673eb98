// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/error_estimate.h>
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/run/accuracy_rule.h>
#include <crawler/run/result_table.h>
#include <crawler/studies/core/answer_differences.h>
#include <crawler/studies/core/differentiated_numbers.h>
#include <crawler/studies/core/sensitivities.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  using namespace accuracy_rule::sensitivities;

  namespace
  {
    /// Step for the forces at the points, relative to the entry.
    constexpr double step = 1e-3;

    /// Entry, and the scenes in which it differs slightly.
    struct Varied
    {
      EntrySensitivity sensitivity;
      VariedAnswers answers;     ///< parameters of the scenes
      std::vector<Scene> scenes; ///< four, or none if there is a reason
      bool is_one_sided = false;
    };

    /// Makes the scenes in which an entry has other values, to one side if it is at a limit. An error in one of them is
    /// a reason. @p step: between the values, relative; @p both_sides: their places, in steps.
    Varied
    vary(
      Form &form, const Scene &scene, const std::string &entry, const double step, const std::array<int, 4> &both_sides)
    {
      const double value = *to_number(form.declarations.value(entry)), d = value != 0. ? step * std::abs(value) : step;
      Varied one{{entry, value, {}, {}, ""}, {}, {}};
      const std::vector<int> around(both_sides.begin(), both_sides.end()), above = {1, 2, 3, 4},
                                                                           below = {-1, -2, -3, -4};
      for (const auto &places : {around, above, below})
        try
        {
          one.scenes.clear();
          one.answers = {{}, places, places == below ? -d : d};
          for (const int i : places)
          {
            one.answers.parameters.push_back(form.parameters_with(entry, value + i * d));
            one.scenes.push_back(one.answers.parameters.back().create_scene());
          }
          one.is_one_sided = places != around;
          one.sensitivity.reason.clear();
          for (const Scene &other : one.scenes)
            if (!have_similar_breaks(scene, other))
              one.sensitivity.reason = "jumps of the active stress or the body appear or vanish with it";
          one.sensitivity.may_vary = !one.is_one_sided || one.sensitivity.reason.empty();
          break;
        }
        catch (const InputError &error)
        {
          if (one.sensitivity.reason.empty())
            one.sensitivity.reason = error.what();
          one.sensitivity.may_vary = false;
        }
      if (!one.sensitivity.reason.empty())
        one.scenes.clear();
      return one;
    }

    std::vector<Quantity>
    quantities_of(const SimulationResult &result)
    {
      std::vector<Quantity> list;
      for (std::size_t i = 0; i < all_quantities.size(); ++i)
        if (has_number(i, result))
          list.push_back(all_quantities[i]);
      return list;
    }

    /// Sets the derivatives, with bounds by those of the finer run. @p accuracy of the displacement, relative.
    void
    set(EntrySensitivity &entry,
        const Derivatives &values,
        const Derivatives &finer,
        const SimulationResult &result,
        const double accuracy)
    {
      if (!values[0] || !finer[0])
      {
        entry.reason = "the displacement has a kink there: a limit is reached, or a jump of the active stress enters "
                       "or leaves at the start or the end of the run";
        return;
      }
      for (std::size_t i = 0; i < values.size(); ++i)
      {
        if (!values[i] || !finer[i])
          continue;
        const double number = std::abs(differentiated_numbers[i].of(result)), size = std::abs(*values[i]);
        // Works are less accurate than the displacement, in units of the exchanged work.
        const bool of_work = is_work(all_quantities[i]);
        const double scale = of_work ? std::max(number, result.energy_balance->exchanged_work) : number;
        const double of_number =
          i == 0 ? 0. : error_bound(result, differentiated_numbers[i].key).value_or(0.) / std::max(scale, 1e-300);
        const double by_size  = entry.at != 0. ? scale / std::abs(entry.at) : scale;
        const double promised = all_quantities[i] == Quantity::positive_work ? promised_factor_of_positive_work
                                : of_work                                    ? promised_factor_of_works
                                                                             : promised_factor;
        const double error    = measured_factor * std::abs(*finer[i] - *values[i]) +
                             promised * std::max(accuracy, of_number) * (size + by_size) + round_off * size;
        if (i == 0)
        {
          entry.value = values[i];
          entry.error = error;
        }
        else
          entry.others.push_back({differentiated_numbers[i].key, *values[i], error});
      }
    }
  } // namespace

  LocalSensitivity
  find_sensitivities(Form &form,
                     const Scene &scene,
                     const std::vector<SensitivityEntry> &entries,
                     const NumericsChoice &choice,
                     SimulationResult &result,
                     const std::function<bool()> &keep_going)
  {
    const Parameters &parameters = form.parameters;
    const double D               = std::abs(result.displacement);
    const double accuracy =
      choice.is_users && result.error ? result.error->total / std::max(D, 1e-300) : parameters.accuracy;
    const auto varied_by = [&](const double step, const std::array<int, 4> &both_sides) {
      std::vector<Varied> varied;
      for (const SensitivityEntry &entry : entries)
      {
        varied.push_back(vary(form, scene, entry.path, step, both_sides));
        varied.back().sensitivity.standard_deviation = entry.standard_deviation(varied.back().sensitivity.at);
      }
      return varied;
    };
    LocalSensitivity local;
    std::vector<Varied> varied;
    bool has_adjoint =
      result.model != Model::kinematic && RecordedRun::is_possible(scene, parameters.time, choice.numerics);
    if (has_adjoint)
      try
      {
        varied = varied_by(step, {{-2, -1, 1, 2}});
        std::vector<Variation> variations;
        std::vector<EntrySensitivity *> known;
        for (Varied &one : varied)
          if (!one.scenes.empty())
          {
            const auto &scenes = one.scenes;
            variations.push_back(
              {{{&scenes[0], &scenes[1], &scenes[2], &scenes[3]}}, one.answers.step, one.is_one_sided});
            known.push_back(&one.sensitivity);
          }
        const RecordedRun run(scene, parameters.time, choice.numerics, keep_going);
        const std::vector<Quantity> quantities = quantities_of(result);
        RunGradient gradient(run);
        const auto values               = gradient.derivatives(variations, quantities);
        local                           = gradient.local();
        const TimeParameters finer_time = time_of_finer_run(parameters.time);
        const RecordedRun finer_run(scene,
                                    finer_time,
                                    numerics_of_finer_run(choice, parameters.time, scene, /*cycles_repeat=*/false),
                                    keep_going);
        const auto finer_values = RunGradient(finer_run).derivatives(variations, quantities);
        for (std::size_t i = 0; i < known.size(); ++i)
          set(*known[i], values[i], finer_values[i], result, accuracy);
      }
      catch (const std::exception &) // e.g. the engine gave up a step
      {
        has_adjoint = false;
        local       = {};
      }
    if (!has_adjoint)
    {
      const double apart = step_of_differences(accuracy);
      varied             = varied_by(apart, around_answer);
      for (Varied &one : varied)
        if (!one.scenes.empty() && !differentiate_answers(std::move(one.answers), result, one.sensitivity, keep_going))
        {
          VariedAnswers closer =
            vary(form, scene, one.sensitivity.entry, closer_answers * apart, around_answer).answers;
          if (!differentiate_answers(std::move(closer), result, one.sensitivity, keep_going))
            one.sensitivity.reason = "the displacement has a kink there, or changes a lot between nearby values";
        }
    }
    for (Varied &one : varied)
      result.sensitivities.push_back(std::move(one.sensitivity));
    return local;
  }
} // namespace crawler
