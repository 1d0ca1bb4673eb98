// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/grid_interpolation.h>
#include <crawler/scene/strain_history.h>

#include <string>

namespace crawler
{
  /// A strain given on a grid over s and t, with cubic splines in both directions (tensor product).
  class StrainTable : public StrainHistory
  {
  public:
    /**
     * Reads the file @p name, CSV with the header s,t,strain or HDF5 with the dataset strain (base/grid_table.h).
     * Throws InputError for @p entry if that cannot be read, if there are less than four values of s or t, or if the
     * grid does not reach from 0 to @p length and from 0 to @p end_time.
     */
    StrainTable(const std::string &name, double length, double end_time, const std::string &entry);

    std::unique_ptr<StrainAtPoints>
    at(const std::vector<double> &points) const override;

  private:
    const GridInterpolation table_;
  };
} // namespace crawler
