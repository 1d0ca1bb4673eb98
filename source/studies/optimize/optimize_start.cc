// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/model_choice.h>
#include <crawler/base/clock.h>
#include <crawler/base/exceptions.h>
#include <crawler/studies/optimize/kinematic_gait.h>
#include <crawler/studies/optimize/optimize_start.h>
#include <crawler/studies/optimize/rol_optimizer.h>
#include <crawler/studies/optimize/simulated_gait.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    /// JSON has no infinities and no NaN.
    double
    number_of(const Json &value)
    {
      return value.is_number() ? value.get<double>() : NAN;
    }

    Json
    json_of(const GaitRecord &record)
    {
      return {record.x, record.objective, record.numbers, record.violation, record.problem};
    }

    GaitRecord
    record_of(const Json &json)
    {
      GaitRecord record{json[0], number_of(json[1]), {}, number_of(json[3]), json[4]};
      for (std::size_t i = 0; i < n_gait_numbers; ++i)
        record.numbers[i] = number_of(json[2][i]);
      return record;
    }

    /// The limits of strain, closer by what was exceeded. Returns whether something was.
    bool
    tighten(OptimizeParameters &parameters, const OptimizeParameters &wanted, const std::pair<double, double> &extremes)
    {
      constexpr double more = 1.02;
      const auto closer     = [&](std::optional<double> &limit, const std::optional<double> &own, const double value) {
        if (!own)
          return false;
        const double excess = (std::abs(value) - std::abs(*own)) * more;
        if (!(std::abs(value) > std::abs(*own) * (1. + GaitProblem::admissible)) || value * *own < 0.)
          return false;
        *limit = std::copysign(std::max(std::abs(*limit) - excess, 0.5 * std::abs(*own)), *own);
        return true;
      };
      const bool is_lower = closer(parameters.smallest_strain, wanted.smallest_strain, extremes.first);
      return closer(parameters.largest_strain, wanted.largest_strain, extremes.second) || is_lower;
    }
  } // namespace

  std::string
  pack(const StartResult &result)
  {
    Json json = {{"work", result.work ? Json(*result.work) : Json()},
                 {"start", result.start},
                 {"best", json_of(result.best)},
                 {"limits", Json::array()},
                 {"has_converged", result.has_converged},
                 {"was_interrupted", result.was_interrupted},
                 {"message", result.message},
                 {"iterations", result.iterations},
                 {"seconds", result.seconds},
                 {"records", Json::array()}};
    for (const GaitLimit &limit : result.limits)
      json["limits"].push_back({limit.name, limit.value, limit.multiplier});
    for (const GaitRecord &record : result.records)
      json["records"].push_back(json_of(record));
    return json.dump();
  }

  StartResult
  unpack_start(const std::string &text)
  {
    const Json json = Json::parse(text);
    StartResult result;
    if (json["work"].is_number())
      result.work = json["work"].get<double>();
    result.start = json["start"];
    result.best  = record_of(json["best"]);
    for (const Json &limit : json["limits"])
      result.limits.push_back({limit[0], number_of(limit[1]), number_of(limit[2])});
    result.has_converged   = json["has_converged"];
    result.was_interrupted = json["was_interrupted"];
    result.message         = json["message"];
    result.iterations      = json["iterations"];
    result.seconds         = json["seconds"];
    for (const Json &record : json["records"])
      result.records.push_back(record_of(record));
    return result;
  }

  std::unique_ptr<GaitModel>
  make_gait_model(SceneFamily &family, const std::vector<double> &start, const std::function<bool()> &stops)
  {
    const Parameters parameters = family.parameters(start);
    const GaitWishes wishes     = GaitProblem::wishes(parameters.optimize);
    const ModelChoice model     = choose_model(parameters, parameters.create_scene());
    if (model.model == Model::perturbation)
      throw InputError("the perturbation level gives the leading order only, which has no best gait; kinematic, "
                       "nonlinear or linear is expected",
                       "Model");
    if (model.model == Model::kinematic)
      return std::make_unique<KinematicGait>(family, wishes, start);
    return std::make_unique<SimulatedGait>(family, wishes, stops);
  }

  StartResult
  search(SceneFamily &family,
         const std::optional<double> work,
         const unsigned long start,
         const std::function<bool()> &stops)
  {
    constexpr unsigned int most_rounds = 12;
    constexpr double roughly           = 1e-3; // while the grid is still too coarse
    constexpr double above_noise       = 10.;
    const double begin                 = now();
    StartResult result;
    result.work                     = work;
    result.start                    = start;
    const OptimizeParameters wanted = family.form().parameters.optimize;
    OptimizeParameters parameters   = wanted;
    std::vector<double> x           = start_values(wanted, family.variables(), start), multipliers;
    double scale                    = 1.; // of the objective, for the multipliers
    bool is_rough                   = true; // of simulations all is known after the first round
    try
    {
      const auto model = make_gait_model(family, x, stops);
      is_rough         = model->noise() == 0.;
      for (unsigned int round = 0; round < most_rounds; ++round)
      {
        GaitProblem problem(*model, parameters, family.variables(), work, x, stops);
        const auto keep = [&](const GaitRecord &best) {
          result.best = best;
          result.records.insert(result.records.end(), problem.records().begin(), problem.records().end());
        };
        try
        {
          if (multipliers.size() != problem.lower().size())
            multipliers.clear();
          for (double &one : multipliers)
            one *= scale / problem.scale();
          const double tolerance = std::max(parameters.tolerance, above_noise * model->noise());
          const OptimizerEnd end = minimise(problem,
                                            problem.to_y(x),
                                            multipliers,
                                            is_rough ? std::max(roughly, tolerance) : tolerance,
                                            parameters.most_iterations);
          multipliers = end.multipliers;
          scale       = problem.scale();
          keep(end.has_converged ? problem.record(end.y) : problem.best());
          result.has_converged = end.has_converged;
          result.message       = end.message;
          result.iterations += end.iterations;
          result.limits = problem.limits(end.multipliers);
          for (GaitLimit &limit : result.limits) // as they were wanted, not tightened
            if (limit.name == "Smallest strain")
              limit.value = *wanted.smallest_strain;
            else if (limit.name == "Largest strain")
              limit.value = *wanted.largest_strain;
        }
        catch (const GaitModel::Interrupted &)
        {
          if (!problem.records().empty())
            keep(problem.best());
          throw;
        }
        if (!result.best.problem.empty())
          break;
        x                  = result.best.x;
        const bool is_fine = !model->refine(x);
        if (!is_fine) // the limits are looked at in other places
          parameters = wanted;
        const bool exceeds =
          is_fine && !is_rough && (wanted.smallest_strain || wanted.largest_strain) && tighten(parameters, wanted, model->extreme_strains(x));
        if (is_fine && !exceeds && !is_rough)
          break;
        is_rough = is_rough && !is_fine;
        if (round + 1 == most_rounds)
          result.message = "the limits of strain are exceeded between the places where they are looked at";
      }
    }
    catch (const GaitModel::Interrupted &)
    {
      result.was_interrupted = true;
      result.has_converged   = false;
      result.message         = "stopped";
    }
    result.seconds = now() - begin;
    return result;
  }
} // namespace crawler
