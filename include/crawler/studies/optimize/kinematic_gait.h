// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/reduced_models/reduced_scene.h>
#include <crawler/reduced_models/strain_functional.h>
#include <crawler/studies/optimize/scene_family.h>

#include <optional>

namespace crawler
{
  /**
   * Gaits of the kinematic level, where the strain is given: quadrature on a grid, and derivatives in closed form
   * (reduced_models/strain_functional.h) times those of the strain, which are differences. Where the strain is linear
   * in all variables, as tested at the beginning, its derivatives are computed once, and no more scenes are built.
   */
  class KinematicGait : public GaitModel
  {
  public:
    /// Throws InputError if the start does not make a scene with a given strain.
    KinematicGait(SceneFamily &family, GaitWishes wishes, const std::vector<double> &start);

    GaitValues
    evaluate(const std::vector<double> &x, bool with_gradients, const std::vector<std::size_t> &places) override;
    bool
    refine(const std::vector<double> &x) override;
    std::pair<double, double>
    extreme_strains(const std::vector<double> &x) override;
    std::string
    description() const override;

  private:
    struct State;

    /// Strain on the grid of the quadrature, and at the places where it is limited, which are denser along the body.
    struct Samples
    {
      StrainSamples on_grid;
      std::vector<double> limited;

      void
      add(double factor, const Samples &others);
    };
    Samples
    sample(const State &state) const;

    void
    choose_limited_places(bool many);
    void
    leave_out_places();
    void
    measure_slopes(const std::vector<double> &start);
    void
    look_for_linearity(const std::vector<double> &start);
    Samples
    linear_samples(const std::vector<double> &x) const;
    ByGaitNumber<double>
    numbers(const State &state, const Samples &samples, const StrainFunctional::Values &values) const;
    void
    add_gradients(const std::vector<double> &x, const State &state, const Samples &samples, GaitValues &values);

    SceneFamily &family_;
    const GaitWishes wishes_;
    const std::vector<double> start_;
    unsigned int n_space_ = 1, n_time_ = 1; ///< panels
    std::optional<StrainFunctional> grid_;
    unsigned int n_limited_s_ = 1,
                 n_limited_t_ = 1; ///< parts of body and duration; the strain is limited at their ends
    /// Strain that is linear in the variables: its values at some x, and its derivatives [variable].
    struct Linear
    {
      std::vector<double> x;
      std::shared_ptr<const State> state; ///< everything but the strain
      Samples samples;
      std::vector<Samples> slopes;
    };
    std::optional<Linear> linear_;
    std::vector<Samples> slopes_;                         ///< at the last x, if the strain is not linear
    std::shared_ptr<const std::vector<double>> jacobian_; ///< Jacobian of the strain where it is limited, if it is
                                                          ///< linear
  };
} // namespace crawler
