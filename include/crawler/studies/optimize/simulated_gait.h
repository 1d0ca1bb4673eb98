// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/compute.h>
#include <crawler/studies/optimize/scene_family.h>

#include <functional>
#include <optional>

namespace crawler
{
  /**
   * Gaits of the levels that are simulated: an answer for the values of the variables as of `crawler run`, and
   * derivatives by the adjoint of a run with the same numerics (adjoint/run_gradient.h). Where there is none they are
   * differences of answers, which are computed together.
   */
  class SimulatedGait : public GaitModel
  {
  public:
    /// @p interrupted is asked after every step.
    SimulatedGait(SceneFamily &family, GaitWishes wishes, std::function<bool()> interrupted);

    GaitValues
    evaluate(const std::vector<double> &x, bool with_gradients) override;
    bool
    refine(const std::vector<double> &) override
    {
      return false;
    }
    std::pair<double, double>
    extreme_strains(const std::vector<double> &x) override;
    double
    noise() const override
    {
      return family_.form().parameters.accuracy;
    }
    std::string
    description() const override;

  private:
    std::vector<Task>
    answers(const std::vector<std::vector<double>> &places);
    ByGaitNumber<double>
    numbers(const Task &task) const;
    void
    add_adjoint_gradients(const std::vector<double> &x, const Task &task, GaitValues &values);
    void
    add_differences(const std::vector<double> &x, GaitValues &values);

    SceneFamily &family_;
    const GaitWishes wishes_;
    const std::function<bool()> interrupted_;
    std::vector<double> latest_x_;        ///< of latest_
    std::vector<Task> latest_;            ///< one, the answer there
    std::vector<double> strain_jacobian_; ///< [smallest, largest][variable]
  };
} // namespace crawler
