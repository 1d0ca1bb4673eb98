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
    /**
     * Reads the file (base/grid_table.h). Throws InputError if it cannot be read, if there are not enough values of s
     * or t (cubic: 4, linear: 2), if the samples do not reach from 0 to @p length and from 0 to @p end_time and no
     * continuation is declared, if they do not even overlap with that, or if they are declared periodic but differ
     * between the first and the last time.
     */
    ActiveStressTable(const TableParameters &parameters, double length, double end_time);

    std::optional<Bounds>
    bounds(const Box &box) const override;

    void
    report(std::ostream &out) const override;

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;

    /// Finds the period of a periodic table, or a whole part of it after which equally spaced samples repeat.
    std::optional<Repetition>
    search_repetition() const override;

    /// Places of kinks: the samples in (0, L), at most 256 if linear and max_knots_of_splines if cubic; if there are
    /// more, the places where a held table begins and ends.
    std::vector<double>
    kinks_in_space() const;
    /// Times of kinks: for linear interpolation the samples, at most 4096; otherwise the times at which a table that is
    /// not periodic begins and ends.
    std::vector<double>
    kinks_in_time(double end_time) const;

    const TableParameters parameters_;
    const double length_;
    const GridInterpolation table_;
    double largest_ = 0.;         ///< |m| [force]
    std::vector<double> changes_; ///< largest |m_t| between two times of the table [force/time]
  };
} // namespace crawler
