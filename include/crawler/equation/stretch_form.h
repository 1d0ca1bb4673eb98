// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/assembler.h>
#include <crawler/equation/stretch_loops.h>

namespace crawler
{
  /// @p scene is in natural units. @p other selects a rule other than the best one, as a check.
  StretchMethod
  stretch_method(const Scene &scene, bool other = false);

  /// Reason why the stretch form cannot compute a scene, in words; empty if it can.
  std::string
  reason_against_stretch_form(const Scene &scene);

  /// Laws at the middles of the cells, which are all that the stretch form needs of a general scene.
  class StretchLaws
  {
  public:
    /// @p scene must outlive it.
    StretchLaws(const Scene &scene, const std::vector<double> &middles);

    /// Evaluates for the stretch @p w and its rate at each cell; @p known_m is m if it depends on time and place only
    /// and is known. Returns the number of the first cell where the friction is not a positive number, or -1.
    long
    evaluate(double t, std::span<const double> w, std::span<const double> rate, const double *known_m = nullptr);

    /// Evaluates the force in the body alone.
    void
    evaluate_force(double t, std::span<const double> w, std::span<const double> rate, const double *known_m = nullptr);

    std::vector<double> friction; ///< g(w), without the body's profile
    BodyForceAtPoints force;
    /// Laws for the unknown w; the mobility is 0 where a cell is empty and sticks.
    CellLaws<double>
    at_cells() const;

  private:
    const Scene &scene_;
    std::vector<double> profile_, w_, w_dg_, strain_, mobility_, mobility_slope_;
  };

  /**
   * Stretch form (doc/numerics.md, "Stretch form"): one stretch in each cell of a mesh of degree 1, on one rank. The
   * unknowns y are those of the cells, w or q = w^(1+a)/(1+a) (StretchMethod), and last the displacement of the left
   * end; the fused engine integrates them.
   */
  class StretchForm : public Assembler
  {
  public:
    /// @p other as in stretch_method().
    StretchForm(const Scene &scene, const Discretization &discretization, bool other = false);

    ConstVector
    displacement(ConstVector y) const override;
    /// Stretches of the cells; that of an empty cell is 0.
    ConstVector
    stretch(ConstVector y) const override;
    /// Slopes that make no new extremes and keep fronts sharp.
    std::vector<double>
    stretch_slopes(ConstVector y) const override;
    std::vector<double>
    node_friction(double t, ConstVector y, ConstVector v) const override;
    StretchRange
    stretch_range(ConstVector y) override;
    void
    set_initial_state(Vector y) override;
    bool
    velocity(double t, ConstVector y, Vector v) override;
    CellIntegrals
    integrals(double t, ConstVector y, ConstVector v) override;

    /// Region from the middle of the first to that of the last cell whose stretch, at its present rate, is lost within
    /// @p reach [time] after the time @p t.
    std::pair<double, double>
    lost_places(double t, ConstVector y, double reach);

  private:
    /// Finds the stretch rate for the velocity @p v at the nodes.
    void
    find_rate(ConstVector v) const;

    /// Evaluates the laws for the stretch @p w with the velocity @p v at the nodes; the result as in StretchLaws.
    long
    evaluate(double t, ConstVector w, ConstVector v) const;

    const StretchMethod method_;
    const double power_;      ///< 1 + a
    const bool may_be_empty_; ///< a < 0
    // State that was evaluated last.
    mutable StretchLaws laws_;
    mutable generic::StretchNodes<double> nodes_;
    mutable std::vector<double> w_, u_, rate_;
    std::vector<double> node_velocities_;
  };
} // namespace crawler
