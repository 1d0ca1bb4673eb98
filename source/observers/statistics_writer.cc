// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/observers/statistics_writer.h>

#include <fmt/format.h>

namespace crawler
{
  StatisticsWriter::StatisticsWriter(const double length,
                                     const bool is_first_rank,
                                     const std::filesystem::path &folder,
                                     const bool with_ledger)
    : length_(length)
    , writes_(is_first_rank)
    , with_ledger_(with_ledger)
    , path_(folder / "statistics.csv")
  {
    if (!writes_)
      return;
    out_.open(path_);
    out_ << "step [1],time [time],step size [time],displacement [length],min stretch [1],min stretch at [length],"
            "max stretch [1],max stretch at [length],rejected steps [1],newton iterations [1]";
    if (with_ledger)
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
    if (!writes_)
      return;
    out_ << fmt::format("{},{:.16g},{:.6g},{:.16g},{:.9g},{:.9g},{:.9g},{:.9g},{},{}",
                        snapshot.step.number,
                        snapshot.step.time,
                        snapshot.step.size,
                        snapshot.integrals.displacement / length_,
                        snapshot.stretch.min.value,
                        snapshot.stretch.min.s,
                        snapshot.stretch.max.value,
                        snapshot.stretch.max.s,
                        snapshot.step.rejected,
                        snapshot.step.newton_iterations);
    if (with_ledger_)
      out_ << fmt::format(",{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.3g},{:.3g}",
                          snapshot.integrals.velocity / length_,
                          snapshot.ledger.stress_power,
                          snapshot.ledger.dissipation,
                          snapshot.ledger.elastic_energy,
                          snapshot.ledger.paper_energy(),
                          snapshot.ledger.positive_power,
                          snapshot.ledger.residual(),
                          snapshot.integrals.net_friction);
    out_ << '\n';
    if (snapshot.is_frame)
      out_.flush();
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
