// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/grid_samples.h>
#include <crawler/output/active_stress_table.h>
#include <crawler/scene/active_stress/segments.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace crawler
{
  void
  require_table_fits(const std::vector<double> &size, const ActiveStress &stress)
  {
    constexpr double least = 2., most = 1e6, max_samples = 1e8;
    const std::string entry = "Output/Active stress table";
    if (size.empty())
      return;
    const bool good =
      size.size() == 2 && size[0] * size[1] <= max_samples && std::all_of(size.begin(), size.end(), [](const double n) {
        return n >= least && n <= most && n == std::floor(n);
      });
    if (!good)
      refuse(entry,
             "Active stress table is \"{}\", but the numbers of samples over s and over t are expected, "
             "whole numbers from {:g} on with a product of at most {:g}",
             fmt::join(size, ", "),
             least,
             max_samples);
    if (stress.feedback() != nullptr)
      throw InputError("Active stress table is wanted, but the active stress depends on the stretch besides s and t; "
                       "an empty entry is expected here (the kymograph has the active stress of the run)",
                       entry);
  }

  std::string
  write_active_stress_table(const std::filesystem::path &path,
                            const ActiveStress &stress,
                            const double length,
                            const double end_time,
                            const unsigned int n_s,
                            const unsigned int n_t)
  {
    const std::vector<double> points = equal_parts(0., length, n_s - 1);
    std::vector<double> m(n_s);
    const auto at    = stress.at(points);
    std::string text = "s,t,m\n";
    for (const double t : equal_parts(0., end_time, n_t - 1))
    {
      at->values(t, m);
      for (unsigned int i = 0; i < n_s; ++i)
      {
        if (!std::isfinite(m[i]))
          return fmt::format("the active stress at s = {:g}, t = {:g} is not a finite number", points[i], t);
        fmt::format_to(std::back_inserter(text), "{},{},{}\n", points[i], t, m[i]);
      }
    }
    write_file(path, text);
    return "";
  }

  void
  require_segment_table_fits(const unsigned int n_parts, const ActiveStress &stress)
  {
    const std::string entry = "Output/Segment table";
    constexpr double most   = 1e8;
    if (n_parts == 0)
      return;
    const auto *const segments = dynamic_cast<const Segments *>(&stress);
    if (segments == nullptr)
      throw InputError(
        "Segment table is wanted, but the active stress has no segments; 0, or \"Active stress/Generator\" "
        "= segments, is expected",
        entry);
    if (const double n = static_cast<double>(n_parts) * static_cast<double>(segments->middles().size()); n > most)
      refuse(entry, "the segment table would have {:.3g} numbers, but at most {:g} are expected", n, most);
  }

  void
  write_segment_tables(const std::filesystem::path &folder,
                       const ActiveStress &stress,
                       const double end_time,
                       const unsigned int n_parts,
                       const UnitNames &units)
  {
    const auto &segments             = dynamic_cast<const Segments &>(stress);
    const std::vector<double> places = segments.middles();
    const auto at                    = segments.at(places);
    std::vector<double> before(places.size()), now(places.size());
    std::string text = "t [time]";
    for (std::size_t i = 0; i < places.size(); ++i)
      text += fmt::format(",segment {} [force]", i + 1);
    text           = units.in_brackets(text + "\n");
    const auto add = [&](const double t, const std::vector<double> &m) {
      fmt::format_to(std::back_inserter(text), "{},{}\n", t, fmt::join(m, ","));
    };
    std::vector<double> times = segments.breaks_in_time();
    std::ranges::copy(equal_parts(0., end_time, n_parts), std::back_inserter(times));
    std::ranges::sort(times);
    const double beside = 1e-9 * end_time; // just before a jump
    for (std::size_t j = 0; j < times.size(); ++j)
    {
      const double t = times[j];
      if (j > 0 && t - times[j - 1] <= beside)
        continue;
      at->values(t, now);
      if (t > beside)
      {
        at->values(t - beside, before);
        double change = 0., size = 0.;
        for (std::size_t i = 0; i < now.size(); ++i)
        {
          change = std::max(change, std::abs(now[i] - before[i]));
          size   = std::max({size, std::abs(now[i]), std::abs(before[i])});
        }
        if (change > 1e-3 * size)
          add(t, before);
      }
      add(t, now);
    }
    write_file(folder / "segments.csv", text);
    text = units.in_brackets("t [time],segment,on\n");
    for (const Segments::SwitchingTime &one : segments.switching_times(end_time))
      fmt::format_to(std::back_inserter(text), "{},{},{}\n", one.time, one.segment + 1, one.on ? 1 : 0);
    write_file(folder / "segment_switching.csv", text);
  }
} // namespace crawler
