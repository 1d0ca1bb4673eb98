// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/error_estimate.h>
#include <crawler/adjoint/run_gradient.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/parameters/declarations.h>
#include <crawler/run/accuracy_rule.h>
#include <crawler/run/result_table.h>
#include <crawler/studies/run/sensitivities.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

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
      bool may_vary = true;      ///< both ways
      std::vector<Scene> scenes; ///< four, or none if there is a reason
      double step;
    };

    /// The scenes of the file in which an entry has four other values. An error in one of them is a reason.
    Varied
    vary(const Input &input, const std::string &entry, const double value)
    {
      Varied one{{entry, value, {}, {}, ""}, true, {}, value != 0. ? step * std::abs(value) : step};
      try
      {
        for (const int i : {-2, -1, 1, 2})
        {
          ParameterFile file = input.file;
          file.add_override(entry + "=" + to_text(value + i * one.step));
          one.scenes.push_back(read_input(std::move(file)).scene);
          if (!have_similar_breaks(input.scene, one.scenes.back()))
            one.sensitivity.reason = "jumps of the active stress or the body come or go with it";
        }
      }
      catch (const InputError &error)
      {
        one.sensitivity.reason = error.what();
        one.may_vary           = false;
      }
      if (!one.sensitivity.reason.empty())
        one.scenes.clear();
      return one;
    }

    std::vector<Varied>
    vary_all(const Input &input)
    {
      const ParameterFile effective = ParameterFile::from_text(input.effective, "parameters.prm");
      std::vector<Varied> list;
      for (const std::string &entry : input.sensitivities)
        list.push_back(vary(input, entry, *to_number(effective.assignment_of(entry)->value)));
      return list;
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
    }};

    std::vector<Quantity>
    quantities_for(const Parameters &parameters)
    {
      if (parameters.output.energy_balance)
        return {all_quantities.begin(), all_quantities.end()};
      return {Quantity::displacement};
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
        entry.reason = "a jump of the active stress comes in or goes out at the start or the end of the run with it, "
                       "where the displacement has a kink";
        return;
      }
      for (std::size_t i = 0; i < values.size(); ++i)
      {
        if (!values[i] || !finer[i])
          continue;
        const double number = std::abs(numbers[i].of(result)), size = std::abs(*values[i]);
        // Works are less accurate than the displacement, in units of what is exchanged.
        const double scale   = i == 0 ? number : std::max(number, result.energy_balance->exchanged_work);
        const double of_work = i == 0 ? 0. : error_bound(result, numbers[i].key).value_or(0.) / scale;
        const double by_size = entry.at != 0. ? scale / std::abs(entry.at) : scale;
        const double error =
          measured_factor * std::abs(*finer[i] - *values[i]) +
          (i == 0 ? promised_factor : promised_factor_of_works) * std::max(accuracy, of_work) * (size + by_size) +
          round_off * size;
        if (i == 0)
        {
          entry.value = values[i];
          entry.error = error;
        }
        else
          entry.others.push_back({numbers[i].key, *values[i], error});
      }
    }

    void
    write_local(const LocalSensitivity &local, const std::filesystem::path &folder)
    {
      std::string text = "s [length],elastic modulus [1],friction [1]\n";
      for (std::size_t i = 0; i < local.s.size(); ++i)
        fmt::format_to(std::back_inserter(text), "{},{},{}\n", local.s[i], local.elastic_modulus[i], local.friction[i]);
      write_file(folder / "sensitivity_body.csv", text);
      if (local.times.empty())
        return;
      text = "s [length],t [time],active stress [1/(force time)]\n";
      for (std::size_t j = 0; j < local.times.size(); ++j)
        for (std::size_t i = 0; i < local.s.size(); ++i)
          fmt::format_to(
            std::back_inserter(text), "{},{},{}\n", local.s[i], local.times[j], local.stress[j * local.s.size() + i]);
      write_file(folder / "sensitivity_stress.csv", text);
    }
  } // namespace

  void
  find_sensitivities(const Input &input,
                     const NumericsChoice &choice,
                     const std::filesystem::path &folder,
                     SimulationResult &result,
                     const std::function<bool()> &keep_going)
  {
    const Parameters &parameters = input.parameters;
    std::vector<Varied> entries;
    std::string reason = RecordedRun::reason_against(input.scene, parameters.time, choice.numerics);
    if (reason.empty())
      entries = vary_all(input);
    else
      for (const std::string &entry : input.sensitivities)
        entries.push_back({{entry, 0., {}, {}, reason}, true, {}, 0.});
    std::vector<Variation> variations;
    std::vector<EntrySensitivity *> known;
    for (Varied &entry : entries)
      if (!entry.scenes.empty())
      {
        const auto &scenes = entry.scenes;
        variations.push_back({{{&scenes[0], &scenes[1], &scenes[2], &scenes[3]}}, entry.step});
        known.push_back(&entry.sensitivity);
      }
    try
    {
      if (reason.empty())
      {
        const RecordedRun run(input.scene, parameters.time, choice.numerics, keep_going);
        const std::vector<Quantity> quantities = quantities_for(parameters);
        RunGradient gradient(run);
        const auto values = gradient.derivatives(variations, quantities);
        write_local(gradient.local(), folder);
        const TimeParameters finer_time = time_of_finer_run(parameters.time);
        const RecordedRun finer_run(
          input.scene,
          finer_time,
          numerics_of_finer_run(choice, parameters.time, input.scene, /*cycles_repeat=*/false),
          keep_going);
        const auto finer_values = RunGradient(finer_run).derivatives(variations, quantities);
        const double D          = std::abs(result.displacement);
        const double accuracy =
          choice.is_users && result.error ? result.error->total / std::max(D, 1e-300) : parameters.accuracy;
        for (std::size_t i = 0; i < known.size(); ++i)
          set(*known[i], values[i], finer_values[i], result, accuracy);
      }
    }
    catch (const FileError &)
    {
      throw;
    }
    catch (const std::exception &error) // the run itself is there; for want of memory, perhaps
    {
      for (EntrySensitivity *one : known)
        one->reason = error.what();
    }
    // Of all those that have no effect, or may not vary from where they are by default, are left out.
    const bool all = trimmed(parameters.output.sensitivities) == "all";
    for (Varied &entry : entries)
      if (!all || (entry.may_vary ? entry.sensitivity.value != 0.
                                  : input.file.assignment_of(entry.sensitivity.entry) != nullptr))
        result.sensitivities.push_back(std::move(entry.sensitivity));
    std::ranges::stable_sort(result.sensitivities, [](const EntrySensitivity &a, const EntrySensitivity &b) {
      const auto size = [](const EntrySensitivity &one) { return one.value ? std::abs(*one.value * one.at) : -1.; };
      return size(a) > size(b);
    });
  }
} // namespace crawler
