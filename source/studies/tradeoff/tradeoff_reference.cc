// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/numerics_choice.h>
#include <crawler/base/clock.h>
#include <crawler/run/accuracy_rule.h>
#include <crawler/run/simulation.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/tradeoff/tradeoff_reference.h>
#include <crawler/time/failure.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    /// Relative to the displacement.
    constexpr double settled = 1e-12, last_tolerance = 1e-14, round_off = 1e-14;
    constexpr unsigned int most_levels = 6;
    /// A method may take so many times the time limit of a run.
    constexpr double most_time = 2.;
    /// Changes below this that grow again are round-off.
    constexpr double near_round_off = 1e-9;
    /// The displacement counts as no smaller than this part of the body's deformation, as in numerics_choice.cc.
    using accuracy_rule::displacement_floor;
    /// Meshes are looked at from this error on, up to so many times as many cells, with this tolerance.
    constexpr double poor                  = 0.03;
    constexpr unsigned int most_refinement = 32, most_cells = 4096, most_meshes = 5;
    constexpr double mesh_tolerance = 1e-12;

    /// A way to compute the scene, and how it is refined: cells are doubled, tolerances multiplied by the factor.
    struct Method
    {
      TradeoffSetting setting;
      unsigned int first_cells;
      double first_tolerance = 1e-7, factor = 0.01;
    };

    TradeoffSetting
    setting(const char *formulation, const char *engine, const char *integrator, const unsigned int degree)
    {
      TradeoffSetting result;
      result.formulation = formulation;
      result.mesh        = "uniform";
      result.engine      = engine;
      result.integrator  = integrator;
      result.degree      = degree;
      return result;
    }

    std::vector<Method>
    methods(const Scene &scene)
    {
      TradeoffSetting adaptive = setting("automatic", "petsc", "bdf", 4);
      adaptive.mesh            = "adaptive";
      adaptive.mesh_tolerance  = 1e-3;
      if (scene.friction_exponent() < 0.)
        return {{setting("position", "fused", "radau 9", 8), 8},
                {setting("position", "petsc", "radau 5", 7), 8},
                // For bodies that collapse.
                {adaptive, 0, 1e-5, 0.1},
                {setting("stretch", "fused", "radau 5", 1), 64, 1e-4, 0.1},
                {setting("position", "petsc", "bdf", 6), 8}};
      return {{setting("position", "fused", "radau 9", 8), 8},
              {setting("position", "petsc", "radau 5", 7), 8},
              {adaptive, 0, 1e-5, 0.1},
              {setting("position", "petsc", "bdf", 6), 8}};
    }

    class ReferenceMaker
    {
    public:
      ReferenceMaker(const Parameters &parameters,
                     const Scene &scene,
                     const TradeoffLists &lists,
                     const std::function<bool()> &interrupted,
                     const std::function<void(const std::string &)> &report)
        : parameters_(parameters)
        , scene_(scene)
        , lists_(lists)
        , interrupted_(interrupted)
        , report_(report)
      {
      }

      TradeoffReference
      make()
      {
        std::vector<RefinedDisplacement> settled_ones;
        for (const Method &method : methods(scene_))
        {
          const double start                = now();
          const RefinedDisplacement refined = refine(method);
          if (interrupted_())
          {
            reference_.status = "stopped";
            reference_.message.clear();
            return reference_;
          }
          report_(refined.method.empty()
                    ? fmt::format("  {:.1f} s: {} does not work here", now() - start, in_words(method.setting))
                    : fmt::format("  {:.1f} s: {}: {:.12g}, last change {:.1e}",
                                  now() - start,
                                  refined.method,
                                  refined.displacement,
                                  refined.change));
          if (!refined.method.empty())
            settled_ones.push_back(refined);
          if (settled_ones.size() == 2)
            break;
        }
        if (settled_ones.empty())
          return reference_;
        std::sort(settled_ones.begin(),
                  settled_ones.end(),
                  [](const RefinedDisplacement &a, const RefinedDisplacement &b) { return a.change < b.change; });
        reference_.status = "finished";
        reference_.first  = settled_ones[0];
        if (settled_ones.size() > 1)
          reference_.second = settled_ones[1];
        reference_.size = size_of(reference_.first.displacement);
        reference_.bar  = reference_.first.change + round_off * reference_.size;
        if (reference_.is_checked())
          reference_.bar += std::abs(reference_.first.displacement - reference_.second.displacement);
        if (std::find(lists_.meshes.begin(), lists_.meshes.end(), "uniform") != lists_.meshes.end())
        {
          for (const unsigned int degree : lists_.degrees)
            reference_.meshes[degree] = meshes(degree);
          const bool stretch =
            std::find(lists_.formulations.begin(), lists_.formulations.end(), "stretch") != lists_.formulations.end();
          if (stretch && !reference_.meshes.contains(1)) // the degree of that form
            reference_.meshes[1] = meshes(1);
        }
        reference_.message.clear(); // of methods that failed
        if (interrupted_())
          reference_.status = "stopped";
        return reference_;
      }

    private:
      double
      size_of(const double displacement) const
      {
        const double size = std::max(std::abs(displacement), displacement_floor * largest_u_);
        return size > 0. ? size : scene_.body.length;
      }

      SimulationResult
      run(const TradeoffSetting &setting)
      {
        const Parameters parameters = with_setting(parameters_, setting, size_);
        const double end            = now() + parameters.tradeoff.run_time_limit;
        const auto keep_going       = [&]() { return now() < end && !interrupted_(); };
        const auto choice           = choose_numerics(MPI_COMM_SELF, parameters, scene_, keep_going);
        SimulationResult result;
        result.time.status = Status::stopped;
        if (choice)
        {
          Simulation simulation(MPI_COMM_SELF, scene_, parameters.time, choice->numerics);
          result = simulation.run(
            {},
            {.energy_balance = false, .resolution = largest_u_ == 0. ? ResolutionWish::size : ResolutionWish::none},
            {},
            keep_going);
        }
        if (result.time.status == Status::stopped && result.time.message.empty())
          result.time.message = fmt::format("stopped after {:g} s", parameters.tradeoff.run_time_limit);
        return result;
      }

      /// One that throws is one that failed: there are other methods.
      SimulationResult
      guarded_run(const TradeoffSetting &setting)
      {
        try
        {
          return run(setting);
        }
        catch (...)
        {
          SimulationResult result;
          result.time = failure_of(std::current_exception());
          return result;
        }
      }

      /// Nothing if fewer than two runs finished.
      RefinedDisplacement
      refine(const Method &method)
      {
        TradeoffSetting setting = method.setting;
        RefinedDisplacement refined;
        double before    = TradeoffSetting::none;
        const double end = now() + most_time * parameters_.tradeoff.run_time_limit;
        for (unsigned int level = 0; level < most_levels && now() < end; ++level)
        {
          const double smaller          = std::pow(method.factor, level);
          setting.cells                 = method.first_cells << level;
          setting.mesh_tolerance        = method.setting.mesh_tolerance * smaller;
          setting.tolerance             = std::max(method.first_tolerance * smaller, last_tolerance);
          const SimulationResult result = guarded_run(setting);
          if (result.time.status != Status::finished)
          {
            reference_.status  = word_of(result.time.status);
            reference_.message = in_words(setting) + ": " + result.time.message;
            if (result.time.status == Status::stopped)
              break;
            continue;
          }
          if (largest_u_ == 0.)
          {
            // The first run's tolerance was relative to a guess; from here on it is the displacement.
            largest_u_ = result.largest_u;
            size_      = size_of(result.displacement);
          }
          const double change = std::abs(result.displacement - before), size = size_of(result.displacement);
          before = result.displacement;
          if (std::isnan(change))
            continue; // the first
          if (change > 0.5 * refined.change && refined.change < near_round_off * size)
            break;
          refined = {in_words(setting), result.displacement, change};
          if (change <= settled * size)
            break;
        }
        return refined;
      }

      /// The meshes of one degree that are worth trying, or those of the list.
      std::vector<std::pair<unsigned int, double>>
      meshes(const unsigned int degree)
      {
        // The position form if it gave the reference, or the check.
        const bool in_position = reference_.first.method.starts_with("position") ||
                                 reference_.second.method.starts_with("position") || scene_.friction_exponent() >= 0.;
        TradeoffSetting setting =
          crawler::setting(in_position ? "position" : "stretch", "fused", "radau 9", in_position ? degree : 1);
        setting.tolerance = mesh_tolerance;
        std::vector<std::pair<unsigned int, double>> result;
        const auto add = [&](const unsigned int cells) {
          setting.cells              = cells;
          const SimulationResult run = guarded_run(setting);
          const bool finished        = run.time.status == Status::finished;
          const double error         = std::abs(run.displacement - reference_.first.displacement) / reference_.size;
          result.emplace_back(cells, finished ? error : std::numeric_limits<double>::infinity());
          return run.time.status != Status::stopped;
        };
        if (!lists_.cells.empty())
        {
          for (const unsigned int cells : lists_.cells)
            add(cells);
          return result;
        }
        const double wanted      = std::max(reference_.relative_bar(), lists_.tolerances.back());
        unsigned int first_cells = 0;
        // 1, 2, 4, 8, ...; from degree 4 on 1, 2, 3, 4, 6, 8, 12, ...
        for (unsigned int cells = 1; cells <= most_cells;)
        {
          if (!add(cells) || result.back().second <= wanted || interrupted_())
            break;
          if (first_cells == 0 && result.back().second <= poor)
            first_cells = cells;
          if (first_cells > 0 && cells >= most_refinement * first_cells)
            break;
          const bool is_power_of_two = (cells & (cells - 1)) == 0;
          cells = degree < 4 || cells == 1 ? 2 * cells : is_power_of_two ? cells + cells / 2 : cells / 3 * 4;
        }
        return useful_meshes(result, wanted);
      }

      const Parameters &parameters_;
      const Scene &scene_;
      const TradeoffLists &lists_;
      const std::function<bool()> &interrupted_;
      const std::function<void(const std::string &)> &report_;
      TradeoffReference reference_;
      double largest_u_ = 0.;                 ///< of the first run that finished [length]
      double size_      = scene_.body.length; ///< of the displacement, as far as it is known [length]
    };

    Json
    to_json(const RefinedDisplacement &d)
    {
      return {d.method, d.displacement, d.change};
    }

    double
    number(const Json &json)
    {
      return json.is_null() ? TradeoffSetting::none : json.get<double>();
    }

    RefinedDisplacement
    refined_displacement(const Json &json)
    {
      return {json[0], number(json[1]), number(json[2])};
    }
  } // namespace

  TradeoffReference
  make_reference(const Parameters &parameters,
                 const Scene &scene,
                 const TradeoffLists &lists,
                 const std::function<bool()> &interrupted,
                 const std::function<void(const std::string &)> &report)
  {
    return ReferenceMaker(parameters, scene, lists, interrupted, report).make();
  }

  std::vector<std::pair<unsigned int, double>>
  useful_meshes(const std::vector<std::pair<unsigned int, double>> &meshes, const double wanted)
  {
    std::vector<std::pair<unsigned int, double>> good;
    for (const auto &mesh : meshes)
      if (mesh.second <= poor)
      {
        good.push_back(mesh);
        if (mesh.second <= wanted)
          break;
      }
    if (good.empty() && !meshes.empty())
      good.push_back(meshes.back());
    if (good.size() <= most_meshes)
      return good;
    std::vector<std::pair<unsigned int, double>> some;
    for (unsigned int i = 0; i < most_meshes; ++i)
      some.push_back(good[(i * (good.size() - 1) + (most_meshes - 1) / 2) / (most_meshes - 1)]);
    return some;
  }

  std::string
  pack(const TradeoffReference &reference)
  {
    Json meshes = Json::array();
    for (const auto &[degree, list] : reference.meshes)
      for (const auto &[cells, error] : list)
        meshes.push_back({degree, cells, std::isfinite(error) ? Json(error) : Json(nullptr)});
    return Json({{"first", to_json(reference.first)},
                 {"second", to_json(reference.second)},
                 {"bar", reference.bar},
                 {"size", reference.size},
                 {"meshes", meshes},
                 {"status", reference.status},
                 {"message", reference.message}})
      .dump(-1, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace);
  }

  TradeoffReference
  unpack_reference(const std::string &text)
  {
    const Json json = Json::parse(text);
    TradeoffReference reference;
    reference.first   = refined_displacement(json["first"]);
    reference.second  = refined_displacement(json["second"]);
    reference.bar     = number(json["bar"]);
    reference.size    = number(json["size"]);
    reference.status  = json["status"];
    reference.message = json["message"];
    for (const Json &mesh : json["meshes"])
      reference.meshes[mesh[0]].emplace_back(
        mesh[1], mesh[2].is_null() ? std::numeric_limits<double>::infinity() : mesh[2].get<double>());
    return reference;
  }
} // namespace crawler
