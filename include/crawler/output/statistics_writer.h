// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/observer.h>

#include <filesystem>
#include <fstream>

namespace crawler
{
  /// Writes statistics.csv: a row for each accepted step, units in the header. Rank 0 writes.
  class StatisticsWriter : public Observer
  {
  public:
    /// Throws FileError.
    StatisticsWriter(double length, bool is_first_rank, const std::filesystem::path &folder, bool with_energy_balance);

    void
    observe(const Snapshot &snapshot) override;
    void
    end() override;

    /// A row of the table, in the user's units.
    struct Row
    {
      const Step &step;
      double displacement;
      StretchRange stretch;
      double velocity; ///< of the centre of mass
      const EnergyBalance &energy_balance;
      double net_friction;
    };

    void
    write(const Row &row);

  private:
    const double length_;
    const bool writes_, with_energy_balance_;
    const std::filesystem::path path_;
    std::ofstream out_;
  };
} // namespace crawler
