// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/error_estimate.h>
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/run/accuracy_rule.h>
#include <crawler/run/result_table.h>
#include <crawler/studies/core/sensitivities.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace crawler
{
  namespace
  {
    /// Relative to the entry.
    constexpr double step = 1e-3;

    /// An entry, and the scenes in which it differs a little.
    struct Varied
    {
      EntrySensitivity sensitivity;
      std::vector<Scene> scenes; ///< four, or none if there is a reason
      double step;
      bool is_one_sided = false;
    };

    /// The scenes in which an entry has other values, to one side if it is at a limit. An error in one of them is a
    /// reason.
    Varied
    vary(Form &form, const Scene &scene, const std::string &entry)
    {
      const double value = *to_number(form.value(entry)), d = value != 0. ? step * std::abs(value) : step;
      Varied one{{entry, value, {}, {}, ""}, {}, d};
      const std::array<int, 4> around = {{-2, -1, 1, 2}}, above = {{1, 2, 3, 4}}, below = {{-1, -2, -3, -4}};
      for (const auto &places : {around, above, below})
        try
        {
          one.scenes.clear();
          for (const int i : places)
            one.scenes.push_back(form.scene_with(entry, value + i * d));
          one.is_one_sided = places != around;
          one.step         = places == below ? -d : d;
          one.sensitivity.reason.clear();
          for (const Scene &other : one.scenes)
            if (!have_similar_breaks(scene, other))
              one.sensitivity.reason = "jumps of the active stress or the body come or go with it";
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

    /// A quantity in the result table.
    struct Number
    {
      const char *key;
      double (*of)(const SimulationResult &);
    };

    /// In the order of all_quantities.
    constexpr std::array<Number, all_quantities.size()> numbers = {{
      {"displacement", [](const SimulationResult &result) { return result.displacement; }},
      {"stress_power", [](const SimulationResult &result) { return result.energy_balance->stress_work; }},
      {"dissipation", [](const SimulationResult &result) { return result.energy_balance->dissipation; }},
      {"positive_power", [](const SimulationResult &result) { return result.energy_balance->positive_work; }},
      {"paper_energy", [](const SimulationResult &result) { return result.energy_balance->paper_energy(); }},
      {"gait.displacement", [](const SimulationResult &result) { return result.gait->displacement; }},
      {"gait.speed", [](const SimulationResult &result) { return result.gait->speed(); }},
    }};

    std::vector<Quantity>
    quantities_for(const Parameters &parameters, const SimulationResult &result)
    {
      std::vector<Quantity> list;
      std::ranges::copy_if(all_quantities, std::back_inserter(list), [&](const Quantity quantity) {
        return is_work(quantity) ? parameters.output.energy_balance
                                 : quantity == Quantity::displacement || result.gait.has_value();
      });
      return list;
    }

    /// The derivatives, with bounds by those of the finer run. @p accuracy of the displacement, relative.
    void
    set(EntrySensitivity &entry,
        const Derivatives &values,
        const Derivatives &finer,
        const SimulationResult &result,
        const double accuracy)
    {
      using namespace accuracy_rule::sensitivities;
      if (!values[0] || !finer[0])
      {
        entry.reason =
          "the displacement has a kink there: a limit is reached, or a jump of the active stress comes in or "
          "goes out at the start or the end of the run";
        return;
      }
      for (std::size_t i = 0; i < values.size(); ++i)
      {
        if (!values[i] || !finer[i])
          continue;
        const double number = std::abs(numbers[i].of(result)), size = std::abs(*values[i]);
        // Works are less accurate than the displacement, in units of what is exchanged.
        const bool of_work = is_work(all_quantities[i]);
        const double scale = of_work ? std::max(number, result.energy_balance->exchanged_work) : number;
        const double of_number =
          i == 0 ? 0. : error_bound(result, numbers[i].key).value_or(0.) / std::max(scale, 1e-300);
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
          entry.others.push_back({numbers[i].key, *values[i], error});
      }
    }
  } // namespace

  const std::array<const char *, all_quantities.size()> &
  differentiated_numbers()
  {
    static const auto keys = []() {
      std::array<const char *, all_quantities.size()> list;
      std::ranges::transform(numbers, list.begin(), &Number::key);
      return list;
    }();
    return keys;
  }

  LocalSensitivity
  find_sensitivities(Form &form,
                     const Scene &scene,
                     const std::vector<SensitivityEntry> &entries,
                     const NumericsChoice &choice,
                     SimulationResult &result,
                     const std::function<bool()> &keep_going)
  {
    const Parameters &parameters = form.parameters;
    LocalSensitivity local;
    const std::string reason = RecordedRun::reason_against(scene, parameters.time, choice.numerics);
    std::vector<Varied> varied;
    for (const SensitivityEntry &entry : entries)
    {
      if (reason.empty())
        varied.push_back(vary(form, scene, entry.path));
      else
        varied.push_back({{entry.path, 0., {}, {}, reason}, {}, 0.});
      varied.back().sensitivity.standard_deviation = entry.standard_deviation(*to_number(form.value(entry.path)));
    }
    std::vector<Variation> variations;
    std::vector<EntrySensitivity *> known;
    for (Varied &one : varied)
      if (!one.scenes.empty())
      {
        const auto &scenes = one.scenes;
        variations.push_back({{{&scenes[0], &scenes[1], &scenes[2], &scenes[3]}}, one.step, one.is_one_sided});
        known.push_back(&one.sensitivity);
      }
    try
    {
      if (reason.empty())
      {
        const RecordedRun run(scene, parameters.time, choice.numerics, keep_going);
        const std::vector<Quantity> quantities = quantities_for(parameters, result);
        RunGradient gradient(run);
        const auto values               = gradient.derivatives(variations, quantities);
        local                           = gradient.local();
        const TimeParameters finer_time = time_of_finer_run(parameters.time);
        const RecordedRun finer_run(scene,
                                    finer_time,
                                    numerics_of_finer_run(choice, parameters.time, scene, /*cycles_repeat=*/false),
                                    keep_going);
        const auto finer_values = RunGradient(finer_run).derivatives(variations, quantities);
        const double D          = std::abs(result.displacement);
        const double accuracy =
          choice.is_users && result.error ? result.error->total / std::max(D, 1e-300) : parameters.accuracy;
        for (std::size_t i = 0; i < known.size(); ++i)
          set(*known[i], values[i], finer_values[i], result, accuracy);
      }
    }
    catch (const std::exception &error) // the run itself is there; for want of memory, perhaps
    {
      for (EntrySensitivity *one : known)
        one->reason = error.what();
    }
    for (Varied &one : varied)
      result.sensitivities.push_back(std::move(one.sensitivity));
    return local;
  }
} // namespace crawler
