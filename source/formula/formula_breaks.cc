// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/formula/formula_bound.h>
#include <crawler/formula/formula_breaks.h>

#include <algorithm>
#include <functional>

namespace crawler
{
  namespace
  {
    using Places = std::optional<std::vector<double>>;

    constexpr double same = 1e-14; ///< breaks are closer by round-off, relative to the end

    /// Search for the points of [0, end] at which the sides of operations change.
    struct BreakSearch
    {
      const std::function<std::vector<Interval>(const Interval &)> sides;
      const double end;
      std::size_t n_bounds       = 0;
      std::vector<double> breaks = {};

      Places
      find()
      {
        look(0., end);
        return n_bounds <= allowed() ? Places(breaks) : std::nullopt;
      }

      /// Number of bounds that may be computed; a break takes about a hundred.
      std::size_t
      allowed() const
      {
        constexpr std::size_t first = 20000, of_break = 400, most_breaks = 5000;
        return breaks.size() <= most_breaks ? first + of_break * breaks.size() : 0;
      }

      void
      look(const double from, const double to)
      {
        if (++n_bounds > allowed())
          return;
        const std::vector<Interval> between = sides({from, to});
        if (std::ranges::all_of(between, [](const Interval &side) { return singleton(side); }))
          return;
        const double middle = 0.5 * (from + to);
        if (middle > from && middle < to && to > same * end) // neighbours: `to` is the first number on its side
        {
          look(from, middle);
          look(middle, to);
        }
        else if ((breaks.empty() || to - breaks.back() > same * end) &&
                 !std::ranges::equal(sides(from), sides(to), [](const Interval &a, const Interval &b) {
                   return a.lower() == b.lower() && a.upper() == b.upper();
                 }))
          breaks.push_back(from > 0. ? to : 0.);
      }
    };

    /// Breaks of a formula in one variable; the other one is called u.
    struct BreaksInVariable
    {
      FormulaBound &bound;
      const FormulaBound::Variable variable;
      const double end;

      /// Breaks of operations that do not depend on u.
      Places
      alone() const
      {
        return BreakSearch{[this](const Interval &x) { return sides(x, 0., false); }, end}.find();
      }

      /// Breaks of all operations on each piece between those of u, in [0, end_of_u], where it does not matter.
      Places
      on_pieces(const Places &alone, const Places &breaks_of_u, const double end_of_u) const
      {
        if (!alone || !breaks_of_u || sides(0., 0., true).size() == sides(0., 0., false).size())
          return alone;
        std::vector<double> all, ends = {0.};
        ends.insert(ends.end(), breaks_of_u->begin(), breaks_of_u->end());
        ends.push_back(end_of_u);
        for (std::size_t i = 1; i < ends.size(); ++i)
        {
          if (ends[i] - ends[i - 1] <= same * end_of_u)
            continue;
          const double u = 0.5 * (ends[i - 1] + ends[i]);
          const auto its = BreakSearch{[&](const Interval &x) { return sides(x, u, true); }, end}.find();
          if (!its)
            return std::nullopt;
          all.insert(all.end(), its->begin(), its->end());
        }
        std::ranges::sort(all);
        const auto is_same = [&](const double a, const double b) { return b - a <= same * end; };
        all.erase(std::unique(all.begin(), all.end(), is_same), all.end());
        return all;
      }

      std::vector<Interval>
      sides(const Interval &x, const double u, const bool in_steps) const
      {
        return variable == FormulaBound::Variable::s ? bound.sides(variable, x, u, in_steps)
                                                     : bound.sides(variable, u, x, in_steps);
      }
    };
  } // namespace

  FormulaBreaks
  formula_breaks(const std::shared_ptr<const Formula> &formula, const double length, const double end_time)
  {
    FormulaBound bound(formula);
    const BreaksInVariable in_space{bound, FormulaBound::Variable::s, length},
      in_time{bound, FormulaBound::Variable::t, end_time};
    const Places places = in_space.alone(), times = end_time > 0. ? in_time.alone() : Places(std::vector<double>());
    return {in_space.on_pieces(places, times, end_time), in_time.on_pieces(times, places, length)};
  }
} // namespace crawler
