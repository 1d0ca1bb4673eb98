// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/csv_numbers.h>
#include <crawler/base/exceptions.h>
#include <crawler/studies/table/unit_factor.h>

#include <fmt/format.h>

#include <optional>
#include <utility>

namespace crawler
{
  namespace
  {
    struct Unit
    {
      std::string base;
      double size;
    };

    std::optional<Unit>
    unit_of(const std::string &name)
    {
      if (name == "1" || name == "-")
        return Unit{"1", 1.};
      if (name == "%")
        return Unit{"1", 0.01};
      if (name == "min")
        return Unit{"s", 60.};
      if (name == "h")
        return Unit{"s", 3600.};
      for (const char *base : {"Pa", "m", "s", "N", "g"})
      {
        if (name == base)
          return Unit{base, 1.};
        for (const auto &[prefix, size] : {std::pair{"n", 1e-9},
                                           std::pair{"u", 1e-6},
                                           std::pair{"µ", 1e-6},
                                           std::pair{"μ", 1e-6},
                                           std::pair{"m", 1e-3},
                                           std::pair{"c", 1e-2},
                                           std::pair{"k", 1e3},
                                           std::pair{"M", 1e6}})
          if (name == std::string(prefix) + base)
            return Unit{base, size};
      }
      return std::nullopt;
    }
  } // namespace

  double
  unit_factor(const std::string &found, const std::string &wanted, const std::string &option)
  {
    if (const auto number = number_in(wanted))
    {
      if (*number == 0.)
        throw InputError(fmt::format("\"{}\" is 0, but another factor is expected", option));
      return *number;
    }
    const auto to = unit_of(wanted);
    if (!to)
      throw InputError(
        fmt::format("\"{}\" is \"{}\", but a number or a unit is expected: m, s, min, h, N, Pa, g, %, or one "
                    "of them with n, u, m, c, k or M before it",
                    option,
                    wanted));
    const auto from = unit_of(found);
    if (!from || from->base != to->base)
      throw InputError(fmt::format("\"{}\" is \"{}\", but the file has {}, which cannot be turned into it; a factor is "
                                   "expected",
                                   option,
                                   wanted,
                                   found.empty() ? "no unit" : "the unit \"" + found + "\""));
    return from->size / to->size;
  }
} // namespace crawler
