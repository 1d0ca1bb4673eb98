// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/cubic_spline.h>
#include <crawler/scene/strain_history.h>

#include <string>

namespace crawler
{
  /// A strain given on a grid over s and t, with cubic splines in both directions (tensor product).
  class StrainTable : public StrainHistory
  {
  public:
    /**
     * Reads the CSV file @p name: the header s,t,strain and one row a sample of a full grid, in any order. Throws
     * InputError for @p entry, with the number of the row, if there is no such file, if a row has not three numbers, if
     * a point is missing or given twice, if there are less than four values of s or t, or if the grid does not reach
     * from 0 to @p length and from 0 to @p end_time.
     */
    StrainTable(const std::string &name, double length, double end_time, const std::string &entry);

    std::unique_ptr<StrainAtPoints>
    at(const std::vector<double> &points) const override;

  private:
    struct Grid
    {
      std::vector<double> s, t;
      std::vector<double> strain; ///< [t][s]
    };

    static Grid
    read(const std::string &name, double length, double end_time, const std::string &entry);

    explicit StrainTable(Grid grid);

    const CubicSpline in_s_, in_t_;
    const std::vector<double> strain_; ///< [t][s]
    std::vector<double> curvature_;    ///< [t][s], in s
  };
} // namespace crawler
