// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/choose_numerics.h>
#include <crawler/accuracy/run_to_accuracy.h>
#include <crawler/parameters/declarations.h>
#include <crawler/run/reduced_model.h>
#include <crawler/run/simulation.h>
#include <crawler/studies/core/input.h>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace crawler::test
{
  using Settings = std::vector<std::pair<std::string, std::string>>;

  /// Settings with others that override them.
  inline Settings
  with(Settings settings, const Settings &others)
  {
    settings.insert(settings.end(), others.begin(), others.end());
    return settings;
  }

  /**
   * Settings from a text like "p = 2; k = 0.5; T = 3; pulse; Width = 0.1". Letters are those of doc/theory.md, with the
   * parameter chi and the speed c of the optimal wave; the name of a generator alone chooses it, and what follows
   * without a section, or belongs to a term of a sum, is its own.
   */
  inline Settings
  set(const std::string &text)
  {
    static const std::string wave                           = "Active stress/Optimal wave/";
    static const std::map<std::string, std::string> letters = {{"p", "Body/Anchoring exponent"},
                                                               {"k", "Body/Elastic modulus"},
                                                               {"gamma", "Body/Friction coefficient"},
                                                               {"L", "Body/Length"},
                                                               {"T", "Time/End time"},
                                                               {"degree", "Discretization/Degree"},
                                                               {"cells", "Discretization/Number of cells"},
                                                               {"integrator", "Time/Integrator"},
                                                               {"tolerance", "Time/Tolerance"},
                                                               {"chi", wave + "Perturbation parameter"},
                                                               {"c", wave + "Wave speed"},
                                                               {"Accuracy", "Accuracy"},
                                                               {"Model", "Model"}};
    Settings settings;
    std::string section;
    std::istringstream items(text);
    for (std::string item; std::getline(items >> std::ws, item, ';');)
    {
      const std::size_t equals = item.find(" =");
      const std::string name   = item.substr(0, equals);
      if (equals == std::string::npos)
      {
        section     = "Active stress/" + name + "/";
        section[14] = static_cast<char>(std::toupper(section[14]));
        settings.emplace_back("Active stress/Generator", name);
        continue;
      }
      if (name == "c")
        settings.emplace_back(wave + "Choose wave by", "wave speed");
      const auto letter = letters.find(name);
      settings.emplace_back(letter != letters.end()                                             ? letter->second
                            : name.find('/') != std::string::npos && !name.starts_with("Term ") ? name
                                                                                                : section + name,
                            item.substr(std::min(equals + 3, item.size())));
    }
    return settings;
  }

  /// The same with values in the place of {}.
  template <typename First, typename... Rest>
  Settings
  set(fmt::format_string<First, Rest...> text, First &&first, Rest &&...rest)
  {
    return set(fmt::format(text, std::forward<First>(first), std::forward<Rest>(rest)...));
  }

  /// Settings with those of such a text, which override them.
  template <typename... Values>
  Settings
  with(Settings settings, fmt::format_string<Values...> text, Values &&...values)
  {
    return with(std::move(settings), set(fmt::format(text, std::forward<Values>(values)...)));
  }

  /// Text of a value in a parameter file.
  inline std::string
  text(const double value)
  {
    return to_text(value);
  }

  /// Parameters with some entries set by their full names.
  inline Parameters
  parameters_with(const Settings &settings)
  {
    ParameterFile file = ParameterFile::from_text("set Model = nonlinear", "test");
    for (const auto &[entry, value] : settings)
      file.add_override(entry + "=" + value);
    Parameters parameters;
    Declarations declarations;
    parameters.count_terms(file);
    parameters.add_parameters(declarations);
    file.apply(declarations);
    return parameters;
  }

  struct Outcome
  {
    SimulationResult result;
    NumericsChoice choice;
  };

  /// Runs with the numerics that the program chooses, without the error by the adjoint (as in answers.h).
  inline Outcome
  run_with(const Parameters &parameters, const Scene &scene, const RecordOptions &options = {.energy_balance = true})
  {
    Outcome outcome;
    outcome.choice = *choose_numerics({parameters, scene, {}, MPI_COMM_WORLD});
    if (outcome.choice.is_of_several_runs())
    {
      Answer answer = run_to_accuracy({parameters, scene}, outcome.choice, {}, options, /*writes=*/false);
      return {std::move(answer.result), std::move(answer.choice)};
    }
    const bool stretch = outcome.choice.numerics.formulation == Formulation::stretch; // its cells are not shared
    Simulation simulation(stretch ? MPI_COMM_SELF : MPI_COMM_WORLD, scene, parameters.time, outcome.choice.numerics);
    outcome.result = simulation.run({}, options);
    return outcome;
  }

  inline Outcome
  run_with(const Parameters &parameters, const RecordOptions &options = {.energy_balance = true})
  {
    return run_with(parameters, parameters.create_scene(), options);
  }

  inline Outcome
  run_with(const Settings &settings, const RecordOptions &options = {.energy_balance = true})
  {
    return run_with(parameters_with(settings), options);
  }

  /// The answer of a level without a mesh.
  inline SimulationResult
  on_level(const Settings &settings, const Model model = Model::kinematic, const double accuracy = 1e-9)
  {
    const Scene scene = parameters_with(settings).create_scene();
    return ReducedModel(scene, model).compute(accuracy, /*energy_balance=*/true);
  }

  /// Settings of the optimal wave with one harmonic a_1 = 1, L = gamma = 1.
  inline Settings
  wave(const double a, const double chi, const double speed = 1., const double end_time = 1., const double k = 1.)
  {
    return set("p = {}; k = {}; chi = {}; c = {}; T = {}", 1. - a, k, chi, speed, end_time);
  }
} // namespace crawler::test
