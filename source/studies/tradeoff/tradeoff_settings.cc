// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/model_choice.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/mesh/reference_element.h>
#include <crawler/parameters/axis.h>
#include <crawler/parameters/declarations.h>
#include <crawler/run/batch.h>
#include <crawler/studies/tradeoff/tradeoff_settings.h>
#include <crawler/time/integrators.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// First steps, relative to the duration, as numerics_choice.cc has them.
    constexpr double multistep_start = 1e-5, one_step_start = 1e-2;

    /// The largest Accuracy.
    constexpr double loosest_accuracy = 0.1;

    /// The list of the entry @p entry: what @p read makes of each value; values of which it makes nothing are refused
    /// with @p expected and a hint.
    template <typename Read>
    auto
    list_of(const std::string &text,
            const std::string &entry,
            const std::string &expected,
            const Read &read,
            const std::vector<std::string> &known = {})
    {
      const std::string name = "Tradeoff/" + entry;
      std::vector<typename decltype(read(text))::value_type> result;
      for (const std::string &value : parse_values(text, name))
      {
        const auto one = read(value);
        if (!one)
        {
          const auto near = nearest_names(value, known, 1);
          throw InputError(fmt::format("\"{}\": found \"{}\", but {} is expected{}",
                                       name,
                                       value,
                                       expected,
                                       near.empty() ? "" : "; the nearest is " + quoted_list(near)),
                           name);
        }
        result.push_back(*one);
      }
      return result;
    }

    std::vector<std::string>
    words(const std::string &text, const std::string &entry, const std::vector<std::string> &known)
    {
      const auto read = [&](const std::string &value) {
        return std::find(known.begin(), known.end(), value) != known.end() ? std::optional(value) : std::nullopt;
      };
      return list_of(text, entry, quoted_list(known), read, known);
    }

    std::vector<double>
    numbers(const std::string &text, const std::string &entry)
    {
      auto result = list_of(text, entry, "a number between 0 and 1", [](const std::string &value) {
        const auto number = to_number(value);
        return number && *number > 0. && *number < 1. ? number : std::nullopt;
      });
      std::sort(result.rbegin(), result.rend());
      return result;
    }

    std::vector<unsigned int>
    whole_numbers(const std::string &text, const std::string &entry, const unsigned int largest)
    {
      const auto read = [largest](const std::string &value) {
        const auto number = to_number(value);
        return number && *number == std::round(*number) && *number >= 1 && *number <= largest
                 ? std::optional(static_cast<unsigned int>(*number))
                 : std::nullopt;
      };
      auto result = list_of(text, entry, fmt::format("a whole number from 1 to {}", largest), read);
      std::sort(result.begin(), result.end());
      return result;
    }

    /// The lists of the section, read and sorted.
    struct Lists
    {
      std::vector<std::string> models, formulations, meshes, engines, integrators;
      std::vector<unsigned int> degrees, cells;
      std::vector<double> mesh_tolerances, tolerances;
    };

    /// Names of integrators. What is known against others is said.
    std::vector<std::string>
    read_integrators(const Parameters &parameters)
    {
      const std::string name = "Tradeoff/Integrators";
      const auto values      = parse_values(parameters.tradeoff.integrators, name);
      for (const std::string &value : values)
        try
        {
          if (value == "automatic")
            throw InputError("\"automatic\" is no integrator, but the name of one is expected");
          TimeParameters time;
          time.integrator = value;
          time.validate();
        }
        catch (const InputError &error)
        {
          throw InputError(fmt::format("\"{}\": {}", name, error.what()), name);
        }
      return values;
    }

    Formulation
    formulation_of(const std::string &name)
    {
      return name == "position" ? Formulation::position : Formulation::stretch;
    }

    /// Why the program cannot do this; empty if it can.
    std::string
    refusal(const TradeoffSetting &setting, const Scene &scene)
    {
      const bool is_stretch = setting.formulation == "stretch";
      if (const std::string reason = reason_against_stretch_form(scene); is_stretch && !reason.empty())
        return "the stretch form cannot compute this: " + reason;
      if (is_stretch && (setting.engine != "fused" || setting.mesh != "uniform"))
        return "the stretch form is for the fused engine, one run at a time, and for meshes that do not change";
      if (setting.engine == "petsc")
        return "";
      Numerics numerics;
      numerics.degree         = 1;
      numerics.n_cells        = 1;
      numerics.formulation    = formulation_of(setting.formulation);
      numerics.mesh.tolerance = setting.mesh == "adaptive" ? 1. : 0.;
      TimeParameters time;
      time.integrator = setting.integrator;
      if (!lane_method(scene, time, numerics))
        return fmt::format("the fused engine{} has the radau integrators, on uniform meshes",
                           setting.is_batch() ? ", which computes batches," : "");
      return "";
    }

    /// A level without a mesh: one setting, or several of different Accuracy.
    void
    add_reduced(std::vector<TradeoffSetting> &list,
                const std::string &model,
                const Lists &lists,
                const Parameters &parameters,
                const Scene &scene)
    {
      TradeoffSetting setting;
      setting.model = model;
      try
      {
        Parameters own = parameters;
        own.model      = from_word<Model>(model).value();
        choose_model(own, scene);
      }
      catch (const InputError &error)
      {
        setting.not_offered = error.what();
        list.push_back(setting);
        return;
      }
      setting.tolerance = loosest_accuracy;
      list.push_back(setting);
      if (model == "kinematic") // a closed form has no tolerance
        for (const double tolerance : lists.tolerances)
          if (tolerance < loosest_accuracy)
          {
            setting.tolerance = tolerance;
            list.push_back(setting);
          }
    }

    /// Every mesh of one degree with every tolerance.
    void
    add_meshes(std::vector<TradeoffSetting> &list, TradeoffSetting setting, const Lists &lists)
    {
      const bool is_adaptive = setting.mesh == "adaptive";
      for (std::size_t i = 0; i < (is_adaptive ? lists.mesh_tolerances.size() : lists.cells.size()); ++i)
        for (const double tolerance : lists.tolerances)
        {
          if (is_adaptive)
            setting.mesh_tolerance = lists.mesh_tolerances[i];
          else
            setting.cells = lists.cells[i];
          setting.tolerance = tolerance;
          list.push_back(setting);
        }
    }

    Lists
    read_lists(const Parameters &parameters)
    {
      const TradeoffParameters &texts = parameters.tradeoff;
      Lists lists;
      lists.models          = words(texts.models, "Models", {"perturbation", "kinematic", "nonlinear"});
      lists.formulations    = words(texts.formulations, "Formulations", {"position", "stretch"});
      lists.meshes          = words(texts.meshes, "Meshes", {"uniform", "adaptive"});
      lists.engines         = words(texts.engines, "Engines", {"fused", "petsc", "batch"});
      lists.integrators     = read_integrators(parameters);
      lists.degrees         = whole_numbers(texts.degrees, "Degrees", ReferenceElement::highest_degree);
      lists.cells           = whole_numbers(texts.cells, "Cells", 10000000);
      lists.mesh_tolerances = numbers(texts.mesh_tolerances, "Mesh tolerances");
      lists.tolerances      = numbers(texts.tolerances, "Tolerances");
      return lists;
    }
  } // namespace

  bool
  same_mesh(const TradeoffSetting &a, const TradeoffSetting &b)
  {
    const auto same = [](const double x, const double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    return a.model == b.model && a.formulation == b.formulation && a.mesh == b.mesh && a.engine == b.engine &&
           a.integrator == b.integrator && a.degree == b.degree && a.cells == b.cells &&
           same(a.mesh_tolerance, b.mesh_tolerance);
  }

  std::string
  in_words(const TradeoffSetting &s)
  {
    if (s.has_no_mesh())
      return fmt::format(
        "model {}{}", s.model, std::isnan(s.tolerance) ? "" : fmt::format(", Accuracy {:g}", s.tolerance));
    std::vector<std::string> parts;
    for (const std::string &word : {s.formulation, s.engine, s.integrator})
      if (!word.empty())
        parts.push_back(word);
    if (s.degree > 0)
      parts.push_back(fmt::format("degree {}", s.degree));
    if (s.cells > 0)
      parts.push_back(counted(s.cells, "cell"));
    if (s.mesh == "adaptive")
      parts.push_back(std::isnan(s.mesh_tolerance) ? std::string("adaptive mesh")
                                                   : fmt::format("adaptive mesh of tolerance {:g}", s.mesh_tolerance));
    if (!std::isnan(s.tolerance))
      parts.push_back(fmt::format("tolerance {:g} of the displacement", s.tolerance));
    return fmt::format("{}", fmt::join(parts, ", "));
  }

  std::vector<TradeoffSetting>
  settings_to_try(const Parameters &parameters, const Scene &scene)
  {
    const Lists lists = read_lists(parameters);
    std::vector<TradeoffSetting> list;
    for (const std::string &model : lists.models)
      if (model != "nonlinear")
        add_reduced(list, model, lists, parameters, scene);
    if (std::find(lists.models.begin(), lists.models.end(), "nonlinear") == lists.models.end())
      return list;
    for (const std::string &formulation : lists.formulations)
      for (const std::string &mesh : lists.meshes)
        for (const std::string &engine : lists.engines)
          for (const std::string &integrator : lists.integrators)
          {
            TradeoffSetting setting;
            setting.formulation = formulation;
            setting.mesh        = mesh;
            setting.engine      = engine;
            setting.integrator  = integrator;
            setting.not_offered = refusal(setting, scene);
            if (!setting.not_offered.empty())
            {
              list.push_back(setting);
              continue;
            }
            for (const unsigned int degree : formulation == "stretch" ? std::vector<unsigned int>{1} : lists.degrees)
            {
              setting.degree = degree;
              add_meshes(list, setting, lists);
            }
          }
    return list;
  }

  Parameters
  with_setting(const Parameters &parameters, const TradeoffSetting &setting, const double size)
  {
    Parameters result = parameters;
    result.model      = from_word<Model>(setting.model).value();
    if (setting.has_no_mesh())
    {
      result.accuracy = setting.tolerance;
      return result;
    }
    result.discretization.formulation = from_word<FormulationEntry>(setting.formulation).value();
    result.discretization.mesh        = from_word<MeshKind>(setting.mesh).value();
    result.discretization.degree      = setting.degree;
    if (setting.mesh == "adaptive")
      result.discretization.mesh_tolerance = setting.mesh_tolerance;
    else
      result.discretization.n_cells = setting.cells;
    result.time.integrator   = setting.integrator;
    result.time.engine       = setting.engine == "petsc" ? Engine::petsc : Engine::automatic;
    result.time.step_control = StepControl::adaptive;
    result.time.cycle_stop   = CycleStopMode::off; // its error is no matter of the setting
    result.time.tolerance    = std::stod(fmt::format("{:.5e}", setting.tolerance * size));
    if (!result.time.initial_step)
      result.time.initial_step =
        (setting.integrator.starts_with("radau") ? one_step_start : multistep_start) * parameters.time.end_time;
    return result;
  }

  std::string
  as_prm(const Parameters &parameters, const TradeoffSetting &setting)
  {
    if (setting.has_no_mesh())
      return fmt::format(
        "set Model    = {}\nset Accuracy = {}\n", word_of(parameters.model), to_text(parameters.accuracy));
    const DiscretizationParameters &d = parameters.discretization;
    const TimeParameters &t           = parameters.time;
    std::string text                  = fmt::format("subsection Discretization\n"
                                                    "  set Formulation     = {}\n  set Mesh            = {}\n"
                                                    "  set Degree          = {}\n",
                                   word_of(d.formulation),
                                   word_of(d.mesh),
                                   d.degree.value());
    if (setting.mesh == "adaptive")
      text += fmt::format("  set Mesh tolerance  = {}\n", to_text(d.mesh_tolerance.value()));
    if (d.n_cells)
      text += fmt::format("  set Number of cells = {}\n", *d.n_cells);
    text += fmt::format("end\nsubsection Time\n  set Integrator      = {}\n  set Engine          = {}\n",
                        t.integrator,
                        word_of(t.engine));
    if (t.integrator == "bdf")
      text += fmt::format("  set Order           = {}\n", t.order);
    return text + fmt::format("  set Step control    = {}\n  set Cycle stop      = {}\n  set Tolerance       = {}\n  "
                              "set Initial step    = {}\nend\n",
                              word_of(t.step_control),
                              word_of(t.cycle_stop),
                              to_text(t.tolerance.value()),
                              to_text(t.initial_step.value()));
  }
} // namespace crawler
