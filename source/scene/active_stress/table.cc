// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/table.h>
#include <crawler/scene/breaks.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace crawler
{
  namespace
  {
    const std::string table_section = "Active stress/Table/", table_file_entry = table_section + "File";

    double
    largest(const std::vector<double> &values)
    {
      double result = 0.;
      for (const double value : values)
        result = std::max(result, std::abs(value));
      return result;
    }

    /// Throws InputError unless held samples overlap with the scene.
    void
    require_overlap(const std::vector<double> &values, const double end, const char *name, const std::string &file)
    {
      if (values.front() >= end || values.back() <= 0.)
        refuse(table_file_entry,
               "\"{0}\" has {1} from {2:g} to {3:g}, none of it between 0 and {4:g}, where it is "
               "needed; check \"{5}Unit of {1}\"",
               file,
               name,
               values.front(),
               values.back(),
               end,
               table_section);
    }

    /// Replaces the last samples in time by the first ones, from which they may differ by round-off.
    void
    close_period(GridTable &grid, const std::string &file)
    {
      constexpr double round_off = 1e-9;
      const std::size_t n = grid.s.size(), last = grid.values.size() - n;
      const double most = round_off * largest(grid.values);
      for (std::size_t i = 0; i < n; ++i)
      {
        if (std::abs(grid.values[i] - grid.values[last + i]) > most)
          refuse(table_section + "Outside",
                 "\"{}\" has m = {:g} at s = {:g}, t = {:g} but m = {:g} at its last time, t = {:g}; "
                 "equal values are expected, the period being the difference of these times (\"crawler table IN OUT "
                 "--period whole\" closes it within the noise)",
                 file,
                 grid.values[i],
                 grid.s[i],
                 grid.t.front(),
                 grid.values[last + i],
                 grid.t.back());
        grid.values[last + i] = grid.values[i];
      }
    }

    GridTable
    read(const TableParameters &p, const double length, const double end_time)
    {
      GridTable grid = read_grid_table(p.file, "m", p.interpolation == "cubic" ? 4 : 2, table_file_entry);
      for (double &s : grid.s)
        s *= p.unit_of_s;
      for (double &t : grid.t)
        t *= p.unit_of_t;
      for (double &m : grid.values)
        m *= p.unit_of_m;
      if (p.outside_in_s == "error")
        reach_ends(grid.s, length, "s", "body", p.file, table_section + "Outside in s");
      else
        require_overlap(grid.s, length, "s", p.file);
      if (p.outside == "error")
        reach_ends(grid.t, end_time, "t", "duration", p.file, table_section + "Outside");
      else if (p.outside == "hold")
        require_overlap(grid.t, end_time, "t", p.file);
      else
        close_period(grid, p.file);
      return grid;
    }

    GridInterpolation::Outside
    outside_in_t(const TableParameters &p)
    {
      if (p.outside == "periodic")
        return GridInterpolation::Outside::periodic;
      return p.outside == "hold" ? GridInterpolation::Outside::hold : GridInterpolation::Outside::go_on;
    }

    /// Places of kinks: the samples in (0, L), at most 256 if linear and max_knots_of_splines if cubic; if there are
    /// more, the places where a held table begins and ends.
    std::vector<double>
    kinks_in_space(const std::vector<double> &s, const bool linear, const double length)
    {
      constexpr std::size_t most = 256;
      auto knots                 = within(s, length);
      if (knots.size() <= (linear ? most : max_knots_of_splines))
        return knots;
      return within({s.front(), s.back()}, length); // ends of a held table
    }

    /// Times of kinks: for linear interpolation the samples, at most 4096; otherwise the times at which a table that is
    /// not periodic begins and ends.
    std::vector<double>
    kinks_in_time(const std::vector<double> &t, const bool linear, const bool periodic, const double end_time)
    {
      constexpr std::size_t most = 4096;
      if (linear && !periodic)
        if (auto knots = within(t, end_time); knots.size() <= most)
          return knots;
      if (linear && periodic)
      {
        const double P = t.back() - t.front();
        std::vector<double> knots;
        for (double n = -std::ceil(t.back() / P); t.front() + n * P < end_time && knots.size() <= 2 * most; ++n)
          for (std::size_t j = 0; j + 1 < t.size(); ++j)
            knots.push_back(t[j] + n * P);
        if (knots = within(knots, end_time); knots.size() <= most)
          return knots;
      }
      return periodic ? std::vector<double>() : within({t.front(), t.back()}, end_time);
    }

    /// Period of a periodic table, or a whole part of it after which equally spaced samples repeat.
    ActiveStress::Repetition
    repetition_of(const GridTable &grid)
    {
      const std::size_t n = grid.t.size() - 1, n_s = grid.s.size();
      const double whole         = grid.t.back() - grid.t.front();
      constexpr double same_step = 1e-9, same_value = 1e-10;
      for (std::size_t j = 0; j < n; ++j)
        if (std::abs(grid.t[j + 1] - grid.t[j] - whole / static_cast<double>(n)) > same_step * whole)
          return {whole, 0.};
      const double most        = same_value * largest(grid.values);
      const auto repeats_after = [&](const std::size_t steps) {
        for (std::size_t i = 0; i + steps * n_s < grid.values.size(); ++i)
          if (std::abs(grid.values[i + steps * n_s] - grid.values[i]) > most)
            return false;
        return true;
      };
      for (std::size_t steps = 2; steps < n; ++steps) // one step would mean a steady m
        if (n % steps == 0 && repeats_after(steps))
          return {whole * static_cast<double>(steps) / static_cast<double>(n), 0.};
      return {whole, 0.};
    }
  } // namespace

  void
  TableParameters::add_parameters(Declarations &declarations)
  {
    declarations.file("File", file, "the name of a CSV or HDF5 file")
      .means("CSV with the header s,t,m and a row for each point of a full grid, in any order; or HDF5 with the "
             "datasets s[ns], t[nt] and m[nt,ns], s and t increasing.");
    declarations.choice("Interpolation", interpolation, {"cubic", "linear"})
      .means("Interpolation between the samples in s and t: cubic splines, or linear.");
    declarations.choice("Outside", outside, {"error", "hold", "periodic"})
      .means("What happens before the first and after the last time of the table: an error if m is needed there; m "
             "keeps its values at these times; or it repeats, with equal values at both times.");
    declarations.choice("Outside in s", outside_in_s, {"error", "hold"})
      .means("What happens beyond the places of the table, if it does not reach both ends of the body: an error, or m "
             "keeps its values there.");
    declarations.number("Unit of s", unit_of_s, positive(), "length")
      .means("Factor that converts s of the table into a length.");
    declarations.number("Unit of t", unit_of_t, positive(), "time")
      .means("Factor that converts t of the table into a time.");
    declarations.number("Unit of m", unit_of_m, any_number(), "force")
      .means("Factor that converts m of the table into an active stress; a negative one if the table has contractions "
             "as positive numbers.");
  }

  ActiveStressTable::ActiveStressTable(const TableParameters &parameters, const double length, const double end_time)
    : parameters_(parameters)
    , length_(length)
    , table_(read(parameters, length, end_time),
             parameters.interpolation == "cubic" ? GridInterpolation::Method::cubic : GridInterpolation::Method::linear,
             outside_in_t(parameters))
  {
    const GridTable &grid = table_.grid;
    const std::size_t n_s = grid.s.size();
    largest_              = largest(grid.values);
    for (std::size_t j = 0; j + 1 < grid.t.size(); ++j)
    {
      double change = 0.;
      for (std::size_t i = j * n_s; i < (j + 1) * n_s; ++i)
        change = std::max(change, std::abs(grid.values[i + n_s] - grid.values[i]));
      changes_.push_back(change / (grid.t[j + 1] - grid.t[j]));
    }
    const bool linear = parameters.interpolation == "linear";
    if (parameters.outside == "periodic")
      facts_.search = [this]() { return repetition_of(table_.grid); };
    facts_.breaks_in_space = kinks_in_space(grid.s, linear, length);
    facts_.breaks_in_time  = kinks_in_time(grid.t, linear, parameters.outside == "periodic", end_time);
  }

  std::unique_ptr<ActiveStressAtPoints>
  ActiveStressTable::evaluator(const std::vector<double> &points, const bool rate) const
  {
    return stress_at_points([table = table_.at(points), rate](const double t, const std::span<double> m) {
      rate ? table->rates(t, m) : table->values(t, m);
    });
  }

  /// Bounds from the samples; a spline may be steeper than the steepest of its neighbours.
  std::optional<ActiveStress::Bounds>
  ActiveStressTable::bounds(const Box &box) const
  {
    const bool is_cubic          = parameters_.interpolation == "cubic";
    const double more            = is_cubic ? 2. : 1.;
    const std::vector<double> &t = table_.grid.t;
    const double whole           = t.back() - t.front();
    const auto n                 = static_cast<std::ptrdiff_t>(changes_.size());
    const auto largest_change    = [&](const double from, const double to) {
      if (to <= t.front() || from >= t.back())
        return 0.;
      const std::ptrdiff_t beside = is_cubic ? 2 : 0;
      const auto first            = std::upper_bound(t.begin(), t.end(), from) - t.begin() - 1 - beside,
                 last             = std::lower_bound(t.begin(), t.end(), to) - t.begin() + beside;
      return *std::max_element(changes_.begin() + std::clamp<std::ptrdiff_t>(first, 0, n - 1),
                               changes_.begin() + std::clamp<std::ptrdiff_t>(last, 1, n));
    };
    double rate = 0.;
    if (parameters_.outside != "periodic" || box.t_to - box.t_from >= whole)
      rate =
        box.t_to - box.t_from >= whole ? largest_change(t.front(), t.back()) : largest_change(box.t_from, box.t_to);
    else
    {
      const double shift = whole * std::floor((box.t_from - t.front()) / whole), from = box.t_from - shift,
                   to = box.t_to - shift;
      rate            = std::max(largest_change(from, to), largest_change(from - whole, to - whole));
    }
    return Bounds{more * largest_, more * rate};
  }

  void
  ActiveStressTable::report(std::ostream &out) const
  {
    const GridTable &grid        = table_.grid;
    const auto [least, greatest] = std::minmax_element(grid.values.begin(), grid.values.end());
    out << fmt::format(
      "Table \"{}\": {} x {} samples, s from {:g} to {:g}, t from {:g} to {:g}{}, m from {:.6g} to {:.6g}, "
      "{}\n",
      parameters_.file,
      grid.s.size(),
      grid.t.size(),
      grid.s.front(),
      grid.s.back(),
      grid.t.front(),
      grid.t.back(),
      parameters_.outside == "periodic" ? " and again" : "",
      *least,
      *greatest,
      parameters_.interpolation);
    if (grid.s.back() > 1.001 * length_)
      out << fmt::format("Note: the table reaches to s = {:g}, but the body ends at {:g}; check \"{}Unit of s\"\n",
                         grid.s.back(),
                         length_,
                         table_section);
  }
} // namespace crawler
