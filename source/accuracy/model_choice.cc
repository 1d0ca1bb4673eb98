// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/model_choice.h>
#include <crawler/base/exceptions.h>
#include <crawler/reduced_models/perturbation.h>
#include <crawler/reduced_models/reduced_scene.h>
#include <crawler/scene/strain_extremes.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    // Constants checked by ModelError.RandomWaves; doc/numerics.md, "Levels without a mesh".
    /// Errors below this part of the length count as zero.
    constexpr double floor = 1e-12;
    /// Share of the model in the error of the kinematic level; the rest is for its quadrature.
    constexpr double model_share = 0.75;

    /// Requires the stretch 1 at the start of a body that starts from rest.
    void
    require_start_at_rest(const Scene &scene, const Model model)
    {
      constexpr double round_off = 1e-8; // also of numbers in a table
      const ActiveStress *strain = scene.active_stress->prescribed_strain();
      if (strain == nullptr)
        return;
      const StrainExtremes start = find_extremes(*strain, scene.body.length, 0., 129, 2),
                           all   = find_extremes(*strain, scene.body.length, scene.end_time, 65, 65);
      const auto size            = [](const StrainExtremes &e) {
        return std::max(std::abs(e.smallest.strain), std::abs(e.largest.strain));
      };
      const StrainExtreme &worst =
        std::abs(start.smallest.strain) > std::abs(start.largest.strain) ? start.smallest : start.largest;
      if (size(start) > round_off * size(all))
        refuse("Active stress/Generator",
               "the strain at t = 0 is {:.6g} at s = {:.6g}, but 0 is expected everywhere, since "
               "the {} model starts from rest (Model = kinematic does not)",
               worst.strain,
               worst.s,
               word_of(model));
    }

    void
    require_fit(const Model model, const RunParameters &parameters, const ReducedScene &levels)
    {
      if (model == Model::perturbation && !levels.wave && parameters.active_stress.generator == "optimal wave")
        refuse("Model",
               "Model is perturbation, which is a series for Fourier coefficients, but the Shape of "
               "the optimal wave is {}; Model = kinematic, nonlinear or auto is expected",
               parameters.active_stress.optimal_wave.shape);
      if (model == Model::perturbation && !levels.wave)
        refuse("Model",
               "Model is perturbation, which is a series for the optimal wave, but the Generator "
               "is {}; Model = kinematic, nonlinear or auto is expected",
               parameters.active_stress.generator);
      if (model == Model::kinematic && levels.strain == nullptr)
        refuse("Model",
               "Model is kinematic, which needs the rate of the active stress, but that of Generator = "
               "{} is not known, or jumps; Model = nonlinear or auto is expected",
               parameters.active_stress.generator);
    }

    /// Approximate level to try.
    struct Candidate
    {
      Model model;
      double error, displacement; ///< in natural units
      double share;               ///< share of the model in the error
    };

    ModelChoice
    choose_by_error(const ReducedScene &levels, const double accuracy)
    {
      if (levels.is_prescribed())
        return {Model::kinematic, "Model kinematic: the strain is prescribed, so there is no equation to solve"};
      if (levels.scene.body.friction_exponent() == 0.)
        return {Model::linear, "Model linear: a = 0, where the equation is linear and the displacement 0"};
      if (levels.strain == nullptr)
        return {Model::nonlinear, "Model nonlinear: no simpler one fits this active stress"};
      const ModelErrors errors = levels.model_errors();
      std::vector<Candidate> candidates;
      if (levels.wave)
        candidates.push_back(
          {Model::perturbation, errors.perturbation, perturbation::displacement(*levels.wave, 1.), 1.});
      candidates.push_back({Model::kinematic, errors.kinematic, errors.displacement, model_share});
      std::string tried;
      for (const auto &[model, error, displacement, share] : candidates)
      {
        const std::string relative = fmt::format("{:.2g}", error / std::abs(displacement));
        if (errors.known && error <= share * std::max(accuracy * std::abs(displacement), floor))
          return {model,
                  fmt::format("Model {}: its estimated error{} is below {}",
                              word_of(model),
                              error <= floor ? "" : " " + relative,
                              error <= floor ? fmt::format("{:g} of the length", floor)
                                             : fmt::format("Accuracy {:g}", accuracy))};
        tried += fmt::format("{}{} an error {}, ",
                             word_of(model),
                             tried.empty() ? " has" : "",
                             errors.known ? "of " + relative : "that is not known");
      }
      return {Model::nonlinear, fmt::format("Model nonlinear: {}Accuracy is {:g}", tried, accuracy)};
    }
  } // namespace

  ModelChoice
  choose_model(const RunParameters &parameters, const Scene &scene)
  {
    ModelChoice choice{parameters.model, fmt::format("Model {}: as set", word_of(parameters.model))};
    if (parameters.model == Model::linear && scene.body.friction_exponent() != 0.)
      refuse("Model",
             "Model is linear, but a = 1 - p is {:g}; a = 0 is expected (Anchoring exponent p = 1)",
             scene.body.friction_exponent());
    if (parameters.model != Model::linear && parameters.model != Model::nonlinear)
    {
      const bool is_prescribed = scene.active_stress->prescribed_strain() != nullptr;
      if (parameters.output.differentiates() && parameters.model == Model::automatic && !is_prescribed)
        return {Model::nonlinear, "Model nonlinear: simpler ones that are approximate have no Sensitivities"};
      if (parameters.output.differentiates() && !is_prescribed)
        refuse(parameters.output.sensitivities.empty() ? "Output/Uncertainty" : "Output/Sensitivities",
               "Sensitivities are wanted, but Model is {} and the strain is not prescribed; "
               "nonlinear or auto is expected",
               word_of(parameters.model));
      if (!scene.is_plain() && !is_prescribed)
        return {Model::nonlinear,
                "Model nonlinear: simpler ones are for plain bodies and grounds, but the scene has " +
                  scene.general_features()};
      const ReducedScene levels(scene);
      if (parameters.model == Model::automatic)
        choice = choose_by_error(levels, parameters.accuracy);
      require_fit(choice.model, parameters, levels);
    }
    if (choice.needs_mesh())
      require_start_at_rest(scene, choice.model);
    return choice;
  }
} // namespace crawler
