// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/log_stretch_form.h>

namespace crawler
{
  /**
   * The log-stretch form of a general scene (doc/theory.md, "General bodies and grounds"). The friction law of a node
   * is that of LogStretchForm; the profiles of body and ground and the direction are taken at the node itself, and the
   * rate of the stretch is v_s at the stretch points.
   */
  class GeneralLogForm : public LogStretchForm
  {
  public:
    GeneralLogForm(const Scene &scene, const Discretization &discretization);

    bool
    residual(double t, ConstVector y, ConstVector y_dot, Vector F) override;
    bool
    velocity(double t, ConstVector y, Vector v) override;
    CellIntegrals
    integrals(double t, ConstVector y, ConstVector v) override;

  protected:
    const LogLaws *
    laws_at(double t, ConstVector y, const LogCellInput &in) override;
    void
    change_of_near(const LogLaws &laws, ConstVector x, Vector change) const override;
    void
    friction(double t, ConstVector y, ConstVector v, std::vector<double> &g_v) override;

  private:
    /// Returns the number of the first node where a law is not positive, or -1.
    long
    evaluate(double t, ConstVector y, const LogCellInput &in);
    /// The balance of forces at the own nodes, without log w' and u'.
    bool
    balance(double t, ConstVector y, ConstVector v, Vector F);

    SlidingAtPoints sliding_;    ///< at the nodes of each cell
    BodyForceAtPoints force_;    ///< at the stretch points
    StretchElsewhere elsewhere_; ///< there
    std::vector<double> u_, v_, g_, w_dg_, at_node_;
    std::vector<double> e_, w_, rate_;
    LogLaws laws_;
    ChainMatrix<double> mass_;
  };
} // namespace crawler
