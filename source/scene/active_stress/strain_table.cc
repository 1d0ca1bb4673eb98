// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/strain_table.h>

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace crawler
{
  namespace
  {
    /// The spline through the values over t at each point.
    class TableAtPoints : public StrainAtPoints
    {
    public:
      /// @param values [point][t]
      TableAtPoints(const CubicSpline &in_t, std::vector<double> values)
        : in_t_(in_t)
        , values_(std::move(values))
      {
        for (std::size_t first = 0; first < values_.size(); first += in_t_.size())
        {
          const auto M = in_t_.curvatures({values_.data() + first, in_t_.size()});
          curvatures_.insert(curvatures_.end(), M.begin(), M.end());
        }
      }

      void
      strain(const double t, const std::span<double> e) override
      {
        const auto p = in_t_.place(t);
        combine(p.i, {p.a, p.b, p.c, p.d}, e);
      }
      void
      rate(const double t, const std::span<double> e_t) override
      {
        const auto p = in_t_.place(t);
        combine(p.i, {p.da, p.db, p.dc, p.dd}, e_t);
      }

    private:
      struct Weights
      {
        double a, b, c, d;
      };

      void
      combine(const std::size_t i, const Weights &w, const std::span<double> result) const
      {
        for (std::size_t point = 0; point < result.size(); ++point)
        {
          const double *y = values_.data() + point * in_t_.size() + i, *M = curvatures_.data() + (y - values_.data());
          result[point] = w.a * y[0] + w.b * y[1] + w.c * M[0] + w.d * M[1];
        }
      }

      const CubicSpline &in_t_;
      const std::vector<double> values_;
      std::vector<double> curvatures_;
    };

    struct Row
    {
      double s, t, strain;
      unsigned int number; ///< in the file, the header being row 1
    };

    std::vector<Row>
    read_rows(const std::string &name, const std::string &entry)
    {
      std::ifstream in(name);
      if (!in)
        throw InputError("cannot read \"" + name + "\"; the name of a CSV file with the header s,t,strain is expected",
                         entry);
      std::string line;
      std::vector<Row> rows;
      for (unsigned int number = 1; std::getline(in, line); ++number)
      {
        line = trimmed(line); // of a carriage return, too
        if (line.empty())
          continue;
        std::vector<std::string> words;
        std::istringstream items(line);
        for (std::string item; std::getline(items, item, ',');)
          words.push_back(trimmed(item));
        if (number == 1)
        {
          if (words != std::vector<std::string>{"s", "t", "strain"})
            throw InputError(
              fmt::format("the first row of \"{}\" is \"{}\", but the header s,t,strain is expected", name, line),
              entry);
          continue;
        }
        Row row{0., 0., 0., number};
        double *const values[] = {&row.s, &row.t, &row.strain};
        bool good              = words.size() == 3;
        for (std::size_t i = 0; good && i < 3; ++i)
        {
          const auto value = to_number(words[i]);
          good             = value.has_value();
          *values[i]       = value.value_or(0.);
        }
        if (!good)
          throw InputError(
            fmt::format("row {} of \"{}\" is \"{}\", but three numbers s,t,strain are expected", number, name, line),
            entry);
        rows.push_back(row);
      }
      return rows;
    }

    std::vector<double>
    distinct(std::vector<double> values)
    {
      std::sort(values.begin(), values.end());
      values.erase(std::unique(values.begin(), values.end()), values.end());
      return values;
    }

    void
    require_range(const std::vector<double> &values,
                  const double end,
                  const char *name,
                  const char *what,
                  const std::string &file,
                  const std::string &entry)
    {
      constexpr double round_off = 1e-12;
      if (values.size() < 4)
        throw InputError(
          fmt::format("\"{}\" has {} different values of {}, but at least 4 are expected", file, values.size(), name),
          entry);
      if (values.front() > round_off * end || values.back() < end * (1. - round_off))
        throw InputError(fmt::format("\"{}\" has {} from {:g} to {:g}, but the whole {}, from 0 to {:g}, is expected",
                                     file,
                                     name,
                                     values.front(),
                                     values.back(),
                                     what,
                                     end),
                         entry);
    }
  } // namespace

  StrainTable::Grid
  StrainTable::read(const std::string &name, const double length, const double end_time, const std::string &entry)
  {
    const std::vector<Row> rows = read_rows(name, entry);
    Grid grid;
    for (const Row &row : rows)
    {
      grid.s.push_back(row.s);
      grid.t.push_back(row.t);
    }
    grid.s = distinct(std::move(grid.s));
    grid.t = distinct(std::move(grid.t));
    require_range(grid.s, length, "s", "body", name, entry);
    require_range(grid.t, end_time, "t", "duration", name, entry);
    const std::size_t n_s = grid.s.size(), n_t = grid.t.size();
    grid.strain.resize(n_s * n_t);
    std::vector<unsigned int> seen(n_s * n_t, 0); // the number of the row
    for (const Row &row : rows)
    {
      const auto i = static_cast<std::size_t>(std::lower_bound(grid.s.begin(), grid.s.end(), row.s) - grid.s.begin());
      const auto j = static_cast<std::size_t>(std::lower_bound(grid.t.begin(), grid.t.end(), row.t) - grid.t.begin());
      if (seen[j * n_s + i] != 0)
        throw InputError(fmt::format("row {} of \"{}\" gives s = {:g}, t = {:g} a second time, after row {}",
                                     row.number,
                                     name,
                                     row.s,
                                     row.t,
                                     seen[j * n_s + i]),
                         entry);
      seen[j * n_s + i]        = row.number;
      grid.strain[j * n_s + i] = row.strain;
    }
    const auto gap = std::find(seen.begin(), seen.end(), 0u);
    if (gap != seen.end())
    {
      const auto missing = static_cast<std::size_t>(gap - seen.begin());
      throw InputError(
        fmt::format("\"{}\" has {} rows after the header, but {} are expected, each of {} values of s with "
                    "each of {} values of t; the first that is missing is s = {:g}, t = {:g}",
                    name,
                    rows.size(),
                    n_s * n_t,
                    n_s,
                    n_t,
                    grid.s[missing % n_s],
                    grid.t[missing / n_s]),
        entry);
    }
    return grid;
  }

  StrainTable::StrainTable(const std::string &name,
                           const double length,
                           const double end_time,
                           const std::string &entry)
    : StrainTable(read(name, length, end_time, entry))
  {
  }

  StrainTable::StrainTable(Grid grid)
    : in_s_(std::move(grid.s))
    , in_t_(std::move(grid.t))
    , strain_(std::move(grid.strain))
  {
    for (std::size_t j = 0; j < in_t_.size(); ++j)
    {
      const auto M = in_s_.curvatures({strain_.data() + j * in_s_.size(), in_s_.size()});
      curvature_.insert(curvature_.end(), M.begin(), M.end());
    }
  }

  std::unique_ptr<StrainAtPoints>
  StrainTable::at(const std::vector<double> &points) const
  {
    std::vector<double> values;
    values.reserve(points.size() * in_t_.size());
    for (const double s : points)
    {
      const auto p = in_s_.place(s);
      for (std::size_t j = 0; j < in_t_.size(); ++j)
      {
        const double *y = strain_.data() + j * in_s_.size() + p.i, *M = curvature_.data() + j * in_s_.size() + p.i;
        values.push_back(p.a * y[0] + p.b * y[1] + p.c * M[0] + p.d * M[1]);
      }
    }
    return std::make_unique<TableAtPoints>(in_t_, std::move(values));
  }
} // namespace crawler
