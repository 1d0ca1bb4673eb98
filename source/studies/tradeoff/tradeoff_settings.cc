// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/model_choice.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/mesh/reference_element.h>
#include <crawler/parameters/axis.h>
#include <crawler/parameters/declarations.h>
#include <crawler/run/batch.h>
#include <crawler/studies/tradeoff/tradeoff_settings.h>
#include <crawler/time/integrators.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace crawler
{
  namespace
  {
    using Texts = std::vector<std::string>;

    /// First steps, relative to the duration, as in choose_numerics.cc.
    constexpr double multistep_start = 1e-5, one_step_start = 1e-2;

    /// Largest Accuracy, and the largest number in the list Cells.
    constexpr double loosest_accuracy = 0.1, most_cells = 1e7;

    /// List of this entry: some of these words, or without words numbers below 1, or whole ones up to the largest;
    /// numbers in order from the coarsest mesh or the loosest tolerance.
    Texts
    list_of(const std::string &entry, const std::string &text, const Texts &words, const double largest = 1.)
    {
      const bool is_whole        = largest > 1.;
      const std::string name     = "Tradeoff/" + entry;
      const std::string expected = !words.empty() ? quoted_list(words)
                                   : is_whole     ? fmt::format("a whole number from 1 to {}", largest)
                                                  : "a number between 0 and 1";
      Texts values               = parse_values(text, name);
      for (std::string &value : values)
      {
        const double x  = to_number(value).value_or(0.);
        const bool fits = !words.empty() ? std::ranges::find(words, value) != words.end()
                                         : x > 0. && (is_whole ? x <= largest && x == std::round(x) : x < 1.);
        std::string why = reason_against(value);
        why             = !why.empty() ? "; it is refused: " + why : nearest_hint(value, words);
        if (!fits)
          refuse_entry(name, "found \"{}\", but {} is expected{}", value, expected, why);
        if (words.empty())
          value = to_text(x);
      }
      if (words.empty())
        std::ranges::sort(values, [&](const std::string &a, const std::string &b) {
          return is_whole == (*to_number(a) < *to_number(b));
        });
      return values;
    }

    /// Lists of the section by the columns that they fill.
    std::map<std::string, Texts>
    read_lists(const TradeoffParameters &texts)
    {
      Texts names;
      for (const Integrator &one : integrators())
        names.push_back(one.name);
      return {{"model", list_of("Models", texts.models, {"perturbation", "kinematic", "nonlinear"})},
              {"formulation", list_of("Formulations", texts.formulations, {"position", "stretch"})},
              {"mesh", list_of("Meshes", texts.meshes, {"uniform", "adaptive"})},
              {"engine", list_of("Engines", texts.engines, {"fused", "petsc", "batch"})},
              {"integrator", list_of("Integrators", texts.integrators, names)},
              {"degree", list_of("Degrees", texts.degrees, {}, ReferenceElement::highest_degree)},
              {"cells", list_of("Cells", texts.cells, {}, most_cells)},
              {"mesh tolerance", list_of("Mesh tolerances", texts.mesh_tolerances, {})},
              {"tolerance", list_of("Tolerances", texts.tolerances, {})}};
    }

    /// Reason why the program cannot do this; empty if it can.
    std::string
    refusal(const TradeoffSetting &setting, const Scene &scene)
    {
      const bool is_stretch = setting["formulation"] == "stretch", is_adaptive = setting["mesh"] == "adaptive";
      if (const std::string reason = reason_against_stretch_form(scene); is_stretch && !reason.empty())
        return "the stretch form cannot compute this: " + reason;
      if (is_stretch && (setting["engine"] != "fused" || is_adaptive))
        return "the stretch form is for the fused engine, one run at a time, and for meshes that do not change";
      if (setting["engine"] == "petsc")
        return "";
      Numerics numerics;
      numerics.degree         = 1;
      numerics.n_cells        = 1;
      numerics.formulation    = is_stretch ? Formulation::stretch : Formulation::position;
      numerics.mesh.tolerance = is_adaptive ? 1. : 0.;
      TimeParameters time;
      time.integrator = setting["integrator"];
      if (!lane_method(scene, time, numerics))
        return fmt::format("the fused engine{} has the radau integrators, on uniform meshes",
                           setting["engine"] == "batch" ? ", which computes batches," : "");
      return "";
    }

    /// Combines each setting with each value.
    std::vector<TradeoffSetting>
    combined(const std::vector<TradeoffSetting> &settings, const std::string &column, const Texts &values)
    {
      std::vector<TradeoffSetting> list;
      for (const TradeoffSetting &setting : settings)
        for (const std::string &value : values)
        {
          list.push_back(setting);
          list.back().values[column] = value;
        }
      return list;
    }

    /// Settings of a level without a mesh: one, or several of different Accuracy.
    std::vector<TradeoffSetting>
    reduced(const Parameters &parameters, const Texts &tolerances)
    {
      TradeoffSetting setting{{{"model", word_of(parameters.model)}}, ""};
      try
      {
        choose_model(parameters, parameters.create_scene());
      }
      catch (const InputError &error)
      {
        setting.not_offered = error.what();
        return {setting};
      }
      Texts accuracies = {to_text(loosest_accuracy)};
      if (parameters.model == Model::kinematic) // a closed form has no tolerance
        std::ranges::copy_if(tolerances, std::back_inserter(accuracies), [](const std::string &tolerance) {
          return *to_number(tolerance) < loosest_accuracy;
        });
      return combined({setting}, "tolerance", accuracies);
    }
  } // namespace

  const std::vector<SettingColumn> &
  setting_columns()
  {
    static const std::vector<SettingColumn> columns = {
      {{"model", "", "level of the model", 16}, "Model"},
      {{"formulation", "", "position or stretch", 16}, "Discretization/Formulation"},
      {{"mesh", "", "uniform or adaptive", 16}, "Discretization/Mesh"},
      {{"engine", "", "fused, petsc, or batch: 8 bodies side by side by the fused engine", 16}, "Time/Engine"},
      {{"integrator", "", "time integrator", 24}, "Time/Integrator"},
      {{"degree", "1", "polynomial degree"}, "Discretization/Degree"},
      {{"cells", "1", "cells of a uniform mesh"}, "Discretization/Number of cells"},
      {{"mesh tolerance", "1", "tolerance of an adaptive mesh, relative to the square of the strain"},
       "Discretization/Mesh tolerance"},
      {{"tolerance", "1", "time tolerance over the size of the displacement; of a level without a mesh: Accuracy"},
       "Time/Tolerance"}};
    return columns;
  }

  bool
  same_mesh(TradeoffSetting a, TradeoffSetting b)
  {
    a.values.erase("tolerance");
    b.values.erase("tolerance");
    return a.values == b.values;
  }

  std::vector<TradeoffSetting>
  settings_to_try(const Input &input)
  {
    const Scene &scene = input.scene;
    Parameters own     = input.parameters;
    own.model          = Model::nonlinear; // the reference needs the whole equation
    choose_model(own, scene);
    auto lists = read_lists(own.tradeoff);
    std::vector<TradeoffSetting> list, ways;
    const auto add = [&list](const std::vector<TradeoffSetting> &more) {
      list.insert(list.end(), more.begin(), more.end());
    };
    for (const std::string &model : lists["model"])
      if (own.model = from_word<Model>(model).value(); own.model == Model::nonlinear)
        ways.push_back({{{"model", model}}, ""});
      else
        add(reduced(own, lists["tolerance"]));
    for (const char *column : {"formulation", "mesh", "engine", "integrator"}) // the last one varies fastest
      ways = combined(ways, column, lists[column]);
    for (TradeoffSetting &way : ways)
    {
      way.not_offered        = refusal(way, scene);
      const std::string size = way["mesh"] == "adaptive" ? "mesh tolerance" : "cells";
      const Texts degrees    = way["formulation"] == "stretch" ? Texts{"1"} : lists["degree"];
      if (way.not_offered.empty())
        add(combined(combined(combined({way}, "degree", degrees), size, lists[size]), "tolerance", lists["tolerance"]));
      else
        add({way});
    }
    return list;
  }

  Texts
  overrides(const TradeoffSetting &setting, const Parameters &parameters, const double size)
  {
    if (!setting.not_offered.empty())
      return {};
    if (setting["model"] != "nonlinear")
      return {"Model=" + setting["model"], "Accuracy=" + setting["tolerance"]};
    Texts list = {"Time/Step control=adaptive", "Time/Cycle stop=off"}; // its error is not part of the setting
    for (const auto &[column, entry] : setting_columns())
    {
      std::string value = setting[column.name];
      if (value.empty())
        continue;
      if (entry == "Time/Tolerance")
        value = to_text(std::stod(fmt::format("{:.5e}", *to_number(value) * size)));
      else if (entry == "Time/Engine" && value != "petsc")
        value = "automatic";
      list.push_back(entry + "=" + value);
    }
    const double start = setting["integrator"].starts_with("radau") ? one_step_start : multistep_start;
    if (!parameters.time.initial_step)
      list.push_back("Time/Initial step=" + to_text(start * parameters.time.end_time));
    return list;
  }
} // namespace crawler
