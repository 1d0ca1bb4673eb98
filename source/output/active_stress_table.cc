// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/output/active_stress_table.h>

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
    constexpr double least = 2., most = 1e6, most_samples = 1e8;
    const std::string entry = "Output/Active stress table";
    if (size.empty())
      return;
    const bool good = size.size() == 2 && size[0] * size[1] <= most_samples &&
                      std::all_of(size.begin(), size.end(), [](const double n) {
                        return n >= least && n <= most && n == std::floor(n);
                      });
    if (!good)
      throw InputError(
        fmt::format("Active stress table is \"{}\", but the numbers of samples over s and over t are expected, "
                    "whole numbers from {:g} on with a product of at most {:g}",
                    fmt::join(size, ", "),
                    least,
                    most_samples),
        entry);
    if (stress.feedback() != nullptr)
      throw InputError(
        "Active stress table is wanted, but the active stress depends on the stretch besides s and t; nothing "
        "is expected here (the kymograph has the active stress of the run)",
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
    std::vector<double> points(n_s), m(n_s);
    for (unsigned int i = 0; i < n_s; ++i)
      points[i] = i + 1 == n_s ? length : length * i / (n_s - 1);
    const auto at    = stress.at(points);
    std::string text = "s,t,m\n";
    for (unsigned int j = 0; j < n_t; ++j)
    {
      const double t = j + 1 == n_t ? end_time : end_time * j / (n_t - 1);
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
} // namespace crawler
