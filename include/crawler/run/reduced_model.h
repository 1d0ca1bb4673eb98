// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/reduced_models/kinematic.h>
#include <crawler/reduced_models/reduced_scene.h>
#include <crawler/run/simulation.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace crawler
{
  /// Model level that needs neither mesh nor time stepper: perturbation or kinematic.
  class ReducedModel
  {
  public:
    /// @p scene is in the user's units and must outlive it; it must fit the level @p model (model_choice.h).
    ReducedModel(const Scene &scene, Model model);

    /**
     * Computes the result of the level, in the user's units. If the error is not known, or larger than @p accuracy
     * times the displacement (and 1e-12 of the length), the status is "failed" with the reason accuracy_not_met; if the
     * strain that the level assumes inverts the body it is "inverted". @p keep_going is asked now and then. With
     * @p gait the last stride is described, if the run finished and the active stress declares its period.
     */
    SimulationResult
    compute(double accuracy, bool energy_balance, const std::function<bool()> &keep_going = {}, bool gait = false);

    /// State at one time, in natural units.
    struct State : StateNumbers // without a step
    {
      ReducedFields fields = {};
    };

    /**
     * Calls @p see, after compute(), with the states at @p times (increasing, from 0 to 1), with fields at @p points.
     * Ends early if @p see returns false.
     */
    void
    replay(const std::vector<double> &times,
           const std::vector<double> &points,
           const std::function<bool(double time, const State &state)> &see) const;

    const ReducedScene reduced_scene;

    /// Description of the computation, in a sentence.
    std::string
    description() const;

  private:
    void
    compute_perturbation(SimulationResult &result) const;
    void
    compute_kinematic(SimulationResult &result, double accuracy, const std::function<bool()> &keep_going);
    void
    describe_gait(SimulationResult &result) const;
    void
    judge(SimulationResult &result, double accuracy) const;

    const Scene &scene_; ///< in the user's units
    const Model model_;
    std::vector<double> space_panels_; ///< ends of the panels of the kinematic level
    std::vector<double> time_panels_;  ///< ends of the panels in time of the kinematic level
  };
} // namespace crawler
