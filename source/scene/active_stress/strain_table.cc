// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/scene/active_stress/strain_table.h>

namespace crawler
{
  namespace
  {
    class TableAtPoints : public StrainAtPoints
    {
    public:
      explicit TableAtPoints(std::unique_ptr<GridInterpolation::AtPoints> table)
        : table_(std::move(table))
      {
      }

      void
      strain(const double t, const std::span<double> e) override
      {
        table_->values(t, e);
      }
      void
      rate(const double t, const std::span<double> e_t) override
      {
        table_->rates(t, e_t);
      }

    private:
      const std::unique_ptr<GridInterpolation::AtPoints> table_;
    };

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
    : table_(read(name, length, end_time, entry), GridInterpolation::Method::cubic, GridInterpolation::Outside::go_on)
  {
  }

  std::unique_ptr<StrainAtPoints>
  StrainTable::at(const std::vector<double> &points) const
  {
    return std::make_unique<TableAtPoints>(table_.at(points));
  }
} // namespace crawler
