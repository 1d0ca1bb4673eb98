// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/observer.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/optimize/extremes_in_boxes.h>
#include <crawler/studies/optimize/scene_family.h>

#include <functional>
#include <optional>

namespace crawler
{
  /**
   * Gaits of the levels that are simulated: answers of `crawler run` for the values of the variables, and derivatives
   * by the adjoint of a run with the same numerics (adjoint/run_gradient.h). Where there is no adjoint they are
   * differences of answers, which are computed together.
   */
  class SimulatedGait : public GaitModel
  {
  public:
    /// @p interrupted is called after every step.
    SimulatedGait(SceneFamily &family, GaitWishes wishes, std::function<bool()> interrupted);

    GaitValues
    evaluate(const std::vector<double> &x, bool with_gradients, const std::vector<std::size_t> &places) override;
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
    /// Repeats the run of a task with an observer at some times, parts of the duration.
    std::unique_ptr<Observer>
    seen_by(std::unique_ptr<Observer> observer, const Task &task, const std::vector<double> &times) const;
    /// Extreme stretches in the boxes.
    std::vector<StretchPlace>
    extremes(const Task &task);
    /// Adds the smallest and the largest of the latest extremes to @p places.
    std::vector<std::size_t>
    with_extremes(std::vector<std::size_t> places) const;
    /// Adds gradients by the adjoint; of the strains, those of @p near.
    void
    add_adjoint_gradients(const std::vector<double> &x,
                          const Task &task,
                          const std::vector<std::size_t> &near,
                          GaitValues &values);
    void
    add_differences(const std::vector<double> &x, GaitValues &values);

    SceneFamily &family_;
    const GaitWishes wishes_;
    const std::function<bool()> interrupted_;
    std::optional<std::size_t> n_boxes_in_time_; ///< where strains are limited
    std::vector<double> latest_x_;               ///< variables of the following members
    std::vector<Task> latest_;                   ///< single task, with the answer there
    std::vector<StretchPlace> latest_extremes_;  ///< extremes in the boxes, if strains are limited
    std::vector<double> strain_jacobian_;        ///< [extreme][variable]
  };
} // namespace crawler
