// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Parts that a page in a browser does not have, besides those of contrib/one_process/left_out.cc: tables in files,
// muParser's formulas. Each is refused in a sentence.
#include <crawler/base/exceptions.h>
#include <crawler/base/grid_table.h>
#include <crawler/scene/active_stress/formula_input.h>

namespace crawler
{
  namespace
  {
    [[noreturn]] void
    refuse(const std::string &entry, const std::string &kind = "names a file")
    {
      throw InputError("\"" + entry + "\" " + kind + ", " CRAWLER_LEFT_OUT, entry);
    }

    constexpr const char *formula = "is a formula, read by muParser";
  } // namespace

  GridTable
  read_grid_table(const std::string &, const std::string &, std::size_t, const std::string &entry)
  {
    refuse(entry);
  }
  void
  reach_ends(std::vector<double> &,
             double,
             const std::string &,
             const std::string &,
             const std::string &,
             const std::string &entry)
  {
    refuse(entry);
  }

  std::shared_ptr<const Formula>
  read_formula(const FormulaInput &input, double, double)
  {
    refuse(input.formula_entry, formula);
  }
  void
  require_finite_values(const ActiveStress &, const FormulaInput &input, const std::string &, double, double)
  {
    refuse(input.formula_entry, formula);
  }
} // namespace crawler
