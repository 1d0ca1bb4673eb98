// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/grid_interpolation.h>
#include <crawler/scene/active_stress/strain_table.h>

namespace crawler
{
  namespace
  {
    GridTable
    read(const std::string &name, const double length, const double end_time, const std::string &entry)
    {
      GridTable grid = read_grid_table(name, "strain", entry);
      require_number_of_values(grid.s, 4, "s", name, entry);
      require_number_of_values(grid.t, 4, "t", name, entry);
      require_reach(grid.s, length, "s", "body", name, entry);
      require_reach(grid.t, end_time, "t", "duration", name, entry);
      return grid;
    }
  } // namespace

  StrainTable::StrainTable(const std::string &name,
                           const double length,
                           const double end_time,
                           const std::string &entry)
    : StrainByEvaluators([table = std::make_shared<const GridInterpolation>(read(name, length, end_time, entry),
                                                                            GridInterpolation::Method::cubic,
                                                                            GridInterpolation::Outside::go_on)](
                           const std::vector<double> &points) -> Evaluators {
      const std::shared_ptr<GridInterpolation::AtPoints> at = table->at(points);
      return {stress_at_points([at](const double t, const std::span<double> e) { at->values(t, e); }),
              stress_at_points([at](const double t, const std::span<double> e_t) { at->rates(t, e_t); })};
    })
  {
  }
} // namespace crawler
