// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/stress_scales.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/parameters/declarations.h>
#include <crawler/run/result_table.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/core/sensitivities.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace crawler
{
  namespace
  {
    // Constants measured by tests/verification/sensitivity_bounds.py.
    /// Bound of a derivative: factor on its difference to the finer numerics; since both may agree by chance, multiples
    /// of Accuracy of the derivative and of D/p, for works of the relative error of the work and with factors of their
    /// own; and relative round-off of the differences that give dF/dp.
    constexpr double measured_factor = 2., wanted_factor = 16., wanted_factor_of_works = 40.,
                     wanted_factor_of_positive_work = 160., round_off = 1e-10;
    /// Relative steps of entries whose answers are compared where there is no adjoint; a slope is suspicious if it
    /// changes by more than this part, as a kink's does, and values closer by closer_answers decide.
    constexpr double min_step_of_answers = 1e-3, largest_step_of_answers = 0.01, suspicious = 0.1,
                     closer_answers = 0.25;
    /// Largest change at the breaks in time, relative to the largest active stress, of one that is continuous there.
    constexpr double continuous = 1e-5;
  } // namespace

  double
  step_of_differences(const double relative_error)
  {
    return std::clamp(0.5 * std::cbrt(relative_error), min_step_of_answers, largest_step_of_answers);
  }

  namespace
  {
    /// True if these results have the number: an energy balance, a last stride.
    bool
    has_number(const std::size_t number, const SimulationResult &result)
    {
      return is_work(all_quantities[number]) ? result.energy_balance.has_value()
                                             : number == 0 || result.gait.has_value();
    }

    /// Places of the other answers, in steps: two differences, one of them far coarser.
    inline constexpr std::array<int, 4> around_answer = {{-4, -1, 1, 4}};

    /// Entry, and the scenes in which it differs slightly.
    struct Varied
    {
      EntrySensitivity sensitivity;
      double step                        = 0.; ///< between the scenes, in units of the entry; negative: downwards
      bool is_one_sided                  = false;
      std::vector<Parameters> parameters = {}; ///< of the scenes
      std::vector<Scene> scenes          = {}; ///< four, or none if there is a reason
    };

    struct Known
    {
      double value, error;
    };

    Known
    known(const SimulationResult &result, const std::size_t number)
    {
      const double error = number == 0 ? (result.error ? result.error->total : NAN)
                                       : error_bound(result, differentiated_numbers[number]).value_or(NAN);
      return {entry_of(differentiated_numbers[number]).number_in(result), error};
    }

    void
    add(EntrySensitivity &entry, const std::size_t number, const double value, const double error)
    {
      if (number > 0)
        return entry.others.push_back({differentiated_numbers[number], value, error});
      entry.value = value;
      entry.error = error;
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

    /**
     * Derivatives of the displacement and of other numbers by an entry, as differences of fourth order of whole
     * answers, for scenes and methods that have no adjoint (doc/numerics.md, "Sensitivities"). The error bound is the
     * sum of the difference to a coarse formula, the contribution of a kink, and the error bounds of the answers. @p
     * result is the answer in the middle. A reason is set instead where an answer is missing or has no bound. Returns
     * false, with nothing set, if the displacement seems to have a kink.
     */
    bool
    differentiate_answers(const Varied &varied,
                          const SimulationResult &result,
                          EntrySensitivity &sensitivity,
                          const std::function<bool()> &keep_going)
    {
      std::vector<Task> tasks(varied.parameters.size());
      for (std::size_t i = 0; i < tasks.size(); ++i)
      {
        tasks[i].parameters = varied.parameters[i];
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
      const Differences &differences = varied.is_one_sided ? one_sided : central;
      for (std::size_t number = 0; number < differentiated_numbers.size(); ++number)
      {
        if (!has_number(number, result) || !std::ranges::all_of(tasks, [number](const Task &task) {
              return has_number(number, task.computed.result);
            }))
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
        add(sensitivity, number, value.value, error);
      }
      if (!sensitivity.value)
        sensitivity.reason = "the error of the displacement is not known";
      return true;
    }

    /// Step for the forces at the points, relative to the entry.
    constexpr double step = 1e-3;

    /// Makes the scenes in which an entry has other values, to one side if it is at a limit. An error in one of them is
    /// a reason. @p step: between the values, relative; @p both_sides: their places, in steps;
    /// @p may_differ: jumps and kinks may appear or vanish.
    Varied
    vary(Form &form,
         const Scene &scene,
         const std::string &entry,
         const double step,
         const std::array<int, 4> &both_sides,
         const bool may_differ)
    {
      const double value = *to_number(form.declarations.value(entry)), d = value != 0. ? step * std::abs(value) : step;
      Varied one{{entry, value, {}, {}, ""}};
      const std::vector<int> around(both_sides.begin(), both_sides.end()), above = {1, 2, 3, 4},
                                                                           below = {-1, -2, -3, -4};
      for (const auto &places : {around, above, below})
        try
        {
          one.scenes.clear();
          one.parameters.clear();
          one.step         = places == below ? -d : d;
          one.is_one_sided = places != around;
          for (const int i : places)
          {
            one.parameters.push_back(form.parameters_with(entry, value + i * d));
            one.scenes.push_back(one.parameters.back().create_scene());
          }
          one.sensitivity.reason.clear();
          for (const Scene &other : one.scenes)
            if (!may_differ && !have_similar_breaks(scene, other))
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
        const double number = std::abs(entry_of(differentiated_numbers[i]).number_in(result)),
                     size   = std::abs(*values[i]);
        // Works are less accurate than the displacement, in units of the exchanged work.
        const bool of_work = is_work(all_quantities[i]);
        const double scale = of_work ? std::max(number, result.energy_balance->exchanged_work) : number;
        const double of_number =
          i == 0 ? 0. : error_bound(result, differentiated_numbers[i]).value_or(0.) / std::max(scale, 1e-300);
        const double by_size = entry.at != 0. ? scale / std::abs(entry.at) : scale;
        const double factor  = all_quantities[i] == Quantity::positive_work ? wanted_factor_of_positive_work
                               : of_work                                    ? wanted_factor_of_works
                                                                            : wanted_factor;
        const double error   = measured_factor * std::abs(*finer[i] - *values[i]) +
                             factor * std::max(accuracy, of_number) * (size + by_size) + round_off * size;
        add(entry, i, *values[i], error);
      }
    }

    /// Sets the derivatives of a run and, for their errors, of a finer one.
    LocalSensitivity
    differentiate_by_adjoint(std::vector<Varied> &varied,
                             const TimeParameters &time,
                             const Scene &scene,
                             const NumericsChoice &choice,
                             const SimulationResult &result,
                             const double accuracy,
                             const std::function<bool()> &keep_going)
    {
      std::vector<Variation> variations;
      std::vector<EntrySensitivity *> known;
      for (Varied &one : varied)
        if (!one.scenes.empty())
        {
          variations.push_back({one.scenes, one.step, one.is_one_sided});
          known.push_back(&one.sensitivity);
        }
      const RecordedRun run(scene, time, choice.numerics, keep_going);
      const std::vector<Quantity> quantities = quantities_of(result);
      RunGradient gradient                   = gradient_of(run, variations, quantities);
      const TimeParameters finer_time        = time_of_finer_run(time);
      SimulationResult whole                 = result;
      whole.cycles.reset(); // all of them are recorded
      const RecordedRun finer_run(scene, finer_time, numerics_of_finer_run(choice, time, scene, whole), keep_going);
      const auto finer_values = gradient_of(finer_run, variations, quantities).quantities;
      for (std::size_t i = 0; i < known.size(); ++i)
        set(*known[i], gradient.quantities[i], finer_values[i], result, accuracy);
      return std::move(gradient.local);
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
    const auto varied_by = [&](const double step, const std::array<int, 4> &both_sides, const bool may_differ) {
      std::vector<Varied> varied;
      for (const SensitivityEntry &entry : entries)
      {
        varied.push_back(vary(form, scene, entry.path, step, both_sides, may_differ));
        varied.back().sensitivity.standard_deviation = entry.standard_deviation(varied.back().sensitivity.at);
      }
      return varied;
    };
    LocalSensitivity local;
    std::vector<Varied> varied;
    bool has_adjoint =
      result.process.model != Model::kinematic && RecordedRun::is_possible(scene, parameters.time, choice.numerics);
    if (has_adjoint)
      try
      {
        varied = varied_by(step, {{-2, -1, 1, 2}}, /*may_differ=*/false);
        local  = differentiate_by_adjoint(varied, parameters.time, scene, choice, result, accuracy, keep_going);
      }
      catch (const std::exception &) // e.g. the engine gave up a step
      {
        has_adjoint = false;
        local       = {};
      }
    const double apart = step_of_differences(accuracy);
    // Kinks of a continuous active stress that enter or leave at the start or the end mislead the adjoint only.
    bool is_continuous = false;
    if (!has_adjoint ||
        !std::ranges::all_of(varied, [](const Varied &one) { return one.sensitivity.value.has_value(); }))
    {
      const StressScales scales = stress_scales(scene);
      is_continuous             = scales.sudden_later < continuous && !scales.jumps_move;
    }
    if (!has_adjoint)
      varied = varied_by(apart, around_answer, is_continuous);
    for (Varied &one : varied)
    {
      EntrySensitivity entry = one.sensitivity;
      bool is_known          = has_adjoint && (entry.value || !is_continuous);
      for (const double closer : {1., closer_answers, closer_answers * closer_answers})
        if (!is_known)
        {
          if (has_adjoint || closer < 1.)
            one = vary(form, scene, entry.entry, closer * apart, around_answer, is_continuous);
          entry.reason   = one.sensitivity.reason;
          entry.may_vary = one.sensitivity.may_vary;
          is_known       = one.scenes.empty() || differentiate_answers(one, result, entry, keep_going);
        }
      if (!is_known)
        entry.reason = "the displacement has a kink there, or changes a lot between nearby values";
      result.sensitivities.push_back(std::move(entry));
    }
    return local;
  }

  void
  write_sensitivities(const LocalSensitivity &local, const std::filesystem::path &folder, const UnitNames &units)
  {
    if (local.s.empty())
      return;
    std::string text = units.in_brackets("s [length],elastic modulus [1],friction [1]\n");
    for (std::size_t i = 0; i < local.s.size(); ++i)
      fmt::format_to(std::back_inserter(text), "{},{},{}\n", local.s[i], local.elastic_modulus[i], local.friction[i]);
    write_file(folder / "sensitivity_body.csv", text);
    if (local.times.empty())
      return;
    text = units.in_brackets("s [length],t [time],active stress [1/(force time)]\n");
    for (std::size_t j = 0; j < local.times.size(); ++j)
      for (std::size_t i = 0; i < local.s.size(); ++i)
        fmt::format_to(
          std::back_inserter(text), "{},{},{}\n", local.s[i], local.times[j], local.stress[j * local.s.size() + i]);
    write_file(folder / "sensitivity_stress.csv", text);
  }

  LocalSensitivity
  add_sensitivities(const Input &input,
                    const NumericsChoice &choice,
                    SimulationResult &result,
                    const std::function<bool()> &keep_going)
  {
    Form form(input.file);
    LocalSensitivity local = find_sensitivities(form, input.scene, input.sensitivities, choice, result, keep_going);
    if (trimmed(input.parameters.output.sensitivities) == "all")
      std::erase_if(result.sensitivities, [&](const EntrySensitivity &one) {
        return one.standard_deviation == 0. &&
               (one.may_vary ? one.value == 0. : input.file.assignment_of(one.entry) == nullptr);
      });
    std::ranges::stable_sort(result.sensitivities, [](const EntrySensitivity &a, const EntrySensitivity &b) {
      const auto size = [](const EntrySensitivity &one) { return one.value ? std::abs(*one.value * one.at) : -1.; };
      return size(a) > size(b);
    });
    return local;
  }
} // namespace crawler
