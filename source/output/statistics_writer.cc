// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/output/statistics_writer.h>

#include <fmt/format.h>

#include <cmath>

namespace crawler
{
  namespace
  {
    /// Nothing for what is not known.
    std::string
    text(const fmt::format_string<const double &> format, const double value)
    {
      return std::isnan(value) ? "" : fmt::format(format, value);
    }
  } // namespace

  StatisticsWriter::StatisticsWriter(const double length,
                                     const bool is_first_rank,
                                     const std::filesystem::path &folder,
                                     const bool with_energy_balance)
    : length_(length)
    , writes_(is_first_rank)
    , with_energy_balance_(with_energy_balance)
    , path_(folder / "statistics.csv")
  {
    if (!writes_)
      return;
    out_.open(path_);
    out_ << "step [1],time [time],step size [time],displacement [length],min stretch [1],min stretch at [length],"
            "max stretch [1],max stretch at [length],rejected steps [1],newton iterations [1]";
    if (with_energy_balance)
      out_ << ",velocity [length/time],stress power [force length],dissipation [force length],"
              "elastic energy [force length],paper energy [force length],positive power [force length],"
              "ledger residual [1],net friction [force]";
    out_ << '\n';
    if (!out_)
      throw FileError("cannot write \"" + path_.string() + "\"");
  }

  void
  StatisticsWriter::observe(const Snapshot &snapshot)
  {
    if (!writes_ || !(snapshot.is_step_end || snapshot.pictures.is_snapshot))
      return;
    write({snapshot.step,
           snapshot.integrals.displacement / length_,
           snapshot.stretch,
           snapshot.integrals.velocity / length_,
           snapshot.energy_balance,
           snapshot.integrals.net_friction});
    if (snapshot.pictures.is_snapshot)
      out_.flush();
  }

  void
  StatisticsWriter::write(const Row &row)
  {
    std::string line = fmt::format("{},{:.16g},{:.6g},{:.16g},{:.9g},{:.9g},{:.9g},{:.9g},{},{}",
                                   row.step.number,
                                   row.step.time,
                                   row.step.size,
                                   row.displacement,
                                   row.stretch.min.value,
                                   row.stretch.min.s,
                                   row.stretch.max.value,
                                   row.stretch.max.s,
                                   row.step.rejected,
                                   row.step.newton_iterations);
    if (with_energy_balance_)
      line += fmt::format(",{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{},{:.3g},{}",
                          row.velocity,
                          row.energy_balance.stress_work,
                          row.energy_balance.dissipation,
                          row.energy_balance.elastic_energy,
                          row.energy_balance.paper_energy(),
                          text("{:.12g}", row.energy_balance.positive_work),
                          row.energy_balance.residual(),
                          text("{:.3g}", row.net_friction));
    out_ << with_plain_numbers(line) << '\n';
    if (!out_)
      throw FileError("cannot write \"" + path_.string() + "\" (is the disk full?)");
  }

  void
  StatisticsWriter::end()
  {
    if (writes_)
      out_.flush();
  }
} // namespace crawler
