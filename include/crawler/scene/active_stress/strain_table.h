// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/evaluators.h>

#include <string>

namespace crawler
{
  /// A strain given on a grid over s and t, with cubic splines in both directions (tensor product).
  class StrainTable : public StrainByEvaluators
  {
  public:
    /**
     * Reads the file @p name, CSV with the header s,t,strain or HDF5 with the dataset strain (base/grid_table.h).
     * Throws InputError for @p entry if that cannot be read, if there are less than four values of s or t, or if the
     * grid does not reach from 0 to @p length and from 0 to @p end_time.
     */
    StrainTable(const std::string &name, double length, double end_time, const std::string &entry);
  };
} // namespace crawler
