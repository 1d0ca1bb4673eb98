// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/output/statistics_writer.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <iterator>

namespace crawler
{
  namespace
  {
    using Row = StateNumbers;

    struct StatisticsColumn
    {
      const char *name, *format;
      double (*value)(const Row &);
    };

    constexpr StatisticsColumn columns[] = {
      {"step [1]", "{}", [](const Row &r) { return 1. * r.step.number; }},
      {"time [time]", "{:.16g}", [](const Row &r) { return r.step.time; }},
      {"step size [time]", "{:.6g}", [](const Row &r) { return r.step.size; }},
      {"displacement [length]", "{:.16g}", [](const Row &r) { return r.displacement; }},
      {"min stretch [1]", "{:.9g}", [](const Row &r) { return r.stretch.min.value; }},
      {"min stretch at [length]", "{:.9g}", [](const Row &r) { return r.stretch.min.s; }},
      {"max stretch [1]", "{:.9g}", [](const Row &r) { return r.stretch.max.value; }},
      {"max stretch at [length]", "{:.9g}", [](const Row &r) { return r.stretch.max.s; }},
      {"rejected steps [1]", "{}", [](const Row &r) { return 1. * r.step.rejected; }},
      {"newton iterations [1]", "{}", [](const Row &r) { return 1. * r.step.newton_iterations; }},
      // Columns with the energy balance:
      {"velocity [length/time]", "{:.12g}", [](const Row &r) { return r.velocity; }},
      {"stress power [force length]", "{:.12g}", [](const Row &r) { return r.energy_balance.stress_work; }},
      {"dissipation [force length]", "{:.12g}", [](const Row &r) { return r.energy_balance.dissipation; }},
      {"elastic energy [force length]", "{:.12g}", [](const Row &r) { return r.energy_balance.elastic_energy; }},
      {"paper energy [force length]", "{:.12g}", [](const Row &r) { return r.energy_balance.paper_energy(); }},
      {"positive power [force length]", "{:.12g}", [](const Row &r) { return r.energy_balance.positive_work; }},
      {"ledger residual [1]", "{:.3g}", [](const Row &r) { return r.energy_balance.residual(); }},
      {"net friction [force]", "{:.3g}", [](const Row &r) { return r.net_friction; }}};
    constexpr std::size_t n_energy_columns = 8;
  } // namespace

  Statistics::Statistics(const bool with_energy_balance)
    : n_columns_(std::size(columns) - (with_energy_balance ? 0 : n_energy_columns))
  {
  }

  void
  Statistics::observe(const Snapshot &snapshot)
  {
    if (snapshot.is_step_end || (snapshot.pictures.is_snapshot && !snapshot.is_in_lost_step))
      write(snapshot);
  }

  void
  Statistics::write(const StateNumbers &row)
  {
    for (std::size_t i = 0; i < n_columns_; ++i)
      values_.push_back(columns[i].value(row) + 0.); // no -0
  }

  std::vector<std::string>
  Statistics::column_names() const
  {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < n_columns_; ++i)
      names.emplace_back(columns[i].name);
    return names;
  }

  StatisticsWriter::StatisticsWriter(const bool is_first_rank,
                                     const std::filesystem::path &folder,
                                     const bool with_energy_balance,
                                     const UnitNames &units)
    : Statistics(with_energy_balance)
    , writes_(is_first_rank)
    , units_(units)
    , path_(folder / "statistics.csv")
  {
  }

  void
  StatisticsWriter::require_written() const
  {
    if (!out_)
      throw FileError("cannot write \"" + path_.string() + "\": " + std::strerror(errno));
  }

  void
  StatisticsWriter::observe(const Snapshot &snapshot)
  {
    if (!writes_)
      return;
    Statistics::observe(snapshot);
    if (snapshot.pictures.is_snapshot)
      out_.flush();
    require_written();
  }

  void
  StatisticsWriter::write(const StateNumbers &row)
  {
    if (!out_.is_open())
    {
      out_.open(path_);
      out_ << units_.in_brackets(fmt::format("{}\n", fmt::join(column_names(), ",")));
    }
    std::string line;
    for (std::size_t i = 0; i < n_columns_; ++i)
    {
      line += i > 0 ? "," : "";
      if (const double value = columns[i].value(row); !std::isnan(value)) // unknown values stay empty
        line += fmt::format(fmt::runtime(columns[i].format), value);
    }
    out_ << with_plain_numbers(line) << '\n';
    require_written();
  }

  void
  StatisticsWriter::end()
  {
    if (writes_)
      out_.flush();
    require_written();
  }

  void
  StatisticsWriter::exchange(Archive &archive)
  {
    std::uintmax_t size = 0;
    if (out_.is_open())
    {
      out_.flush();
      require_written();
      size = static_cast<std::uintmax_t>(out_.tellp());
    }
    archive(size);
    if (!archive.reads() || size == 0 || !writes_)
      return;
    cut_file(path_, size);
    out_.open(path_, std::ios::in | std::ios::out | std::ios::ate);
    require_written();
  }
} // namespace crawler
