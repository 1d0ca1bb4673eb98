// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/drivers/simulation.h>
#include <crawler/rungs/kinematic.h>
#include <crawler/rungs/rung_scene.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace crawler
{
  /// Computes a scene on a rung that needs neither mesh nor time stepper: perturbation or kinematic.
  class Rung
  {
  public:
    /// @p scene is in the user's units and must outlive it; it must fit the rung @p model (model_choice.h).
    Rung(const Scene &scene, const std::string &model);

    /**
     * What the rung gives, in the user's units. If the error is not known, or larger than @p accuracy times the
     * displacement (and 1e-12 of the length), the status is "failed" with the reason accuracy_not_met; if the strain
     * that the rung assumes inverts the body it is "inverted". @p keep_going is asked now and then.
     */
    SimulationResult
    compute(double accuracy, bool ledger, const std::function<bool()> &keep_going = {});

    /// The state at one time, in natural units.
    struct State
    {
      double displacement = 0., velocity = 0., net_friction = RungEnergies::unknown;
      RungEnergies energies;
      StrainExtreme smallest{}, largest{};
      RungFields fields;
    };

    /**
     * After compute(): calls @p see with the states at @p times (increasing, from 0 to 1), with fields at @p points.
     * It ends early if @p see returns false.
     */
    void
    replay(const std::vector<double> &times,
           const std::vector<double> &points,
           const std::function<bool(double time, const State &state)> &see) const;

    /// After compute() for @p scene, whose @p result gets the last stride, if the active stress declares its period,
    /// and the gait efficiency. Nothing is said of a run that did not finish.
    void
    describe_gait(const Scene &scene, SimulationResult &result) const;

    const RungScene &
    rungs() const
    {
      return rungs_;
    }

    /// What was computed, in a sentence.
    std::string
    description() const;

  private:
    void
    compute_perturbation(SimulationResult &result) const;
    void
    compute_kinematic(SimulationResult &result, double accuracy, const std::function<bool()> &keep_going);
    void
    judge(SimulationResult &result, double accuracy) const;

    const RungScene rungs_;
    const std::string model_;
    unsigned int n_space_panels_ = 0, n_time_panels_ = 0; ///< of the kinematic rung
  };

  /// Works and energies of a rung as a ledger; the initial elastic energy counts as lost before the start.
  Ledger
  ledger_of(const RungEnergies &energies);
} // namespace crawler
