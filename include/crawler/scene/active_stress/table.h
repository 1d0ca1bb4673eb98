// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/grid_interpolation.h>
#include <crawler/scene/known_stress.h>

#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Active stress/Table".
  struct TableParameters
  {
    std::string file          = "actuation.csv";
    std::string interpolation = "cubic"; ///< | linear
    std::string outside       = "error"; ///< | hold | periodic, in t
    std::string outside_in_s  = "error"; ///< | hold
    double unit_of_s = 1., unit_of_t = 1., unit_of_m = 1.;

    void
    add_parameters(Declarations &declarations);
  };

  /**
   * An active stress by samples m(s_i, t_j), as measured (doc/generators/table.md), with linear interpolation or cubic
   * splines in s and t (tensor product).
   */
  class ActiveStressTable : public KnownStress
  {
  public:
    /// Reads the file (base/grid_table.h). Throws InputError if its samples do not fit the entries, the body or the
    /// duration.
    ActiveStressTable(const TableParameters &parameters, double length, double end_time);

    std::optional<Bounds>
    bounds(const Box &box) const override;

    void
    report(std::ostream &out) const override;

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;

    const TableParameters parameters_;
    const double length_;
    const GridInterpolation table_;
    double largest_ = 0.;         ///< |m| [force]
    std::vector<double> changes_; ///< largest |m_t| between two times of the table [force/time]
  };
} // namespace crawler
