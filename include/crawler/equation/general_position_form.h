// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/position_form.h>

namespace crawler
{
  /**
   * Position form of a general scene (doc/theory.md, "General bodies and grounds"): for every test function phi
   *
   *   int f(s, s + u, w, v) phi ds + int N phi_s ds = 0,   N = m(s, t, w, w_t, ...) + k(s) (w - 1).
   *
   * Laws and their derivatives are computed at all quadrature points first, and then integrated. A stretch at another
   * place couples distant cells: the products with the Jacobian include this, the elimination does not.
   */
  class GeneralPositionForm : public PositionForm
  {
  public:
    GeneralPositionForm(const Scene &scene, const Discretization &discretization);

    bool
    setup_jacobian(double t, ConstVector u, ConstVector v, double sigma) override;
    void
    jacobian_vmult(ConstVector x, Vector y) override;
    bool
    solves_exactly() const override; ///< false where the stretch at another place contributes
    void
    setup_stage(unsigned int stage, double t, ConstVector u, ConstVector v) override;
    void
    stage_vmult(unsigned int stage, ConstVector x, ConstVector x_dot, Vector result) override;

    /// Solved by Newton's method: the friction may depend on the velocity, and the active stress on its derivative.
    bool
    velocity(double t, ConstVector u, Vector v) override;

  protected:
    long
    evaluate_laws(double t, ConstVector u, CellInput &in) override;

  private:
    /// Adds the contribution of the stretch at another place to a product with the Jacobian.
    void
    add_far(const std::vector<double> &by_near, ConstVector x, Vector result) const;

    FrictionAtPoints friction_laws_;
    BodyForceAtPoints force_;
    StretchElsewhere elsewhere_;
    std::vector<double> e_, w_, u_, v_, rate_; ///< state at the quadrature points
    PointLaws<double> laws_;
    // Derivatives of the force by the stretch at the other place, at the states of the Jacobian and of the stages.
    std::vector<double> jacobian_by_near_;
    std::vector<std::vector<double>> stage_by_near_;
  };

  /// Creates the form for a plain or a general scene.
  std::unique_ptr<PositionForm>
  create_position_form(const Scene &scene, const Discretization &discretization);
} // namespace crawler
