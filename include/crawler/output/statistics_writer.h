// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/observer.h>
#include <crawler/scene/unit_names.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace crawler
{
  /// A table with a row for each accepted step and each snapshot, kept in memory.
  class Statistics : public Observer
  {
  public:
    explicit Statistics(bool with_energy_balance);

    void
    observe(const Snapshot &snapshot) override;

    void
    show(const StateWithoutMesh &state) override
    {
      if (state.pictures.is_snapshot)
        write(state);
    }

    /// Adds a row.
    virtual void
    write(const StateNumbers &row);

    /// Names with units, "time [time]".
    std::vector<std::string>
    column_names() const;
    /// Values [row][column]; unknown ones are NaN.
    const std::vector<double> &
    values() const
    {
      return values_;
    }

  private:
    std::vector<double> values_;

  protected:
    const std::size_t n_columns_;
  };

  /// Writes the table to statistics.csv instead of keeping it. Rank 0 writes.
  class StatisticsWriter : public Statistics
  {
  public:
    /// Takes the folder of the file, which is made with the first row.
    StatisticsWriter(bool is_first_rank,
                     const std::filesystem::path &folder,
                     bool with_energy_balance,
                     const UnitNames &units);

    void
    observe(const Snapshot &snapshot) override;
    void
    write(const StateNumbers &row) override;
    void
    end() override;
    void
    exchange(Archive &archive) override;

  private:
    void
    require_written() const;

    const bool writes_;
    const UnitNames units_;
    const std::filesystem::path path_;
    std::ofstream out_;
  };
} // namespace crawler
