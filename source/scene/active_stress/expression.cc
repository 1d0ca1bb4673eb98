// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/expression.h>
#include <crawler/scene/period.h>

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <sstream>

namespace crawler
{
  namespace
  {
    const std::string formula_entry   = "Active stress/Expression/Active stress";
    const std::string constants_entry = "Active stress/Expression/Constants";

    /// What muParser has against a formula, as one sentence with a position that counts from 1.
    std::string
    in_words(const mu::ParserError &error, const std::string &formula)
    {
      std::string problem = error.GetMsg();
      if (error.GetCode() == mu::ecINTERNAL_ERROR)
        problem = "the formula is not complete";
      // muParser's own positions count from 0.
      for (const char *position : {" found at position", " at expression position", " at position"})
        problem = problem.substr(0, problem.find(position));
      while (!problem.empty() && (problem.back() == '.' || problem.back() == '!'))
        problem.pop_back();
      const std::string token = error.GetToken();
      if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN && !token.empty() &&
          std::isalpha(static_cast<unsigned char>(token[0])))
      {
        const auto near = nearest_names(token,
                                        {"s",    "t",    "L",    "T",    "pi",   "sin",   "cos",  "tan",  "asin",
                                         "acos", "atan", "sinh", "cosh", "tanh", "exp",   "log",  "sqrt", "abs",
                                         "sign", "min",  "max",  "pow",  "mod",  "floor", "ceil", "erf",  "erfc"},
                                        1);
        problem += near.empty() ? "" : "; the nearest name is " + quoted_list(near);
      }
      return fmt::format("error in the formula \"{}\" at position {}: {}",
                         formula,
                         std::min<std::size_t>(error.GetPos(), formula.size()) + 1,
                         problem);
    }

    /// muParser takes "s = 3" for an assignment and "s, t" for two formulas; both are slips here.
    void
    require_one_value(const std::string &formula)
    {
      int depth = 0;
      for (std::size_t i = 0; i < formula.size(); ++i)
      {
        const char c = formula[i], before = i > 0 ? formula[i - 1] : ' ',
                   after = i + 1 < formula.size() ? formula[i + 1] : ' ';
        depth += (c == '(') - (c == ')');
        if (c == ',' && depth == 0)
          throw InputError(
            fmt::format("error in the formula \"{}\" at position {}: one formula is expected, but there are "
                        "several, separated by a comma",
                        formula,
                        i + 1),
            formula_entry);
        if (c == '=' && after != '=' && std::string("=<>!").find(before) == std::string::npos)
          throw InputError(
            fmt::format("error in the formula \"{}\" at position {}: \"=\" is found, but \"==\" is expected "
                        "for a comparison",
                        formula,
                        i + 1),
            formula_entry);
      }
    }

    Formula::Constants
    parse_constants(const std::string &text, const double length, const double end_time)
    {
      Formula::Constants constants = {{"pi", std::numbers::pi}, {"L", length}, {"T", end_time}};
      if (trimmed(text).empty())
        return constants;
      std::istringstream in(text + ",");
      std::string item;
      while (std::getline(in, item, ','))
      {
        const auto equals      = item.find('=');
        const std::string name = trimmed(item.substr(0, equals));
        const auto value   = equals == std::string::npos ? std::nullopt : to_number(trimmed(item.substr(equals + 1)));
        const bool is_name = !name.empty() && std::isalpha(static_cast<unsigned char>(name[0])) &&
                             std::all_of(name.begin(),
                                         name.end(),
                                         [](const unsigned char c)
                                         {
                                           return std::isalnum(c) || c == '_';
                                         });
        if (!is_name || !value)
          throw InputError(fmt::format("found \"{}\" among the constants of the formula, but \"name=number, "
                                       "name=number, ...\" is expected",
                                       trimmed(item)),
                           constants_entry);
        if (name == "s" || name == "t")
          throw InputError(fmt::format("\"{}\" is a variable of the formula and cannot be a constant", name),
                           constants_entry);
        for (const auto &[other, ignored] : constants)
          if (other == name)
            throw InputError(fmt::format("the constant \"{}\" is already defined", name), constants_entry);
        constants.emplace_back(name, *value);
      }
      return constants;
    }
  } // namespace


  void
  ExpressionParameters::add_parameters(Declarations &declarations)
  {
    declarations.enter("Expression");
    declarations.text("Active stress",
                      active_stress,
                      "a formula of s and t",
                      "The active stress m(s,t): s is the material coordinate, t the time; pi, L (body length) "
                      "and T (end time) are known, and sin, cos, tan, sinh, cosh, tanh, exp, log, sqrt, abs, "
                      "sign, min, max, pow, mod, floor, ceil, erf, erfc, ^, comparisons and a ? b : c.",
                      "force");
    declarations.text("Constants", constants, "a list name=number, name=number", "Constants that the formula may use.");
    declarations.leave();
  }

  Expression::Expression(const ExpressionParameters &parameters, const double length, const double end_time)
    : length_(length)
    , end_time_(end_time)
    , formula_(parameters.active_stress)
  {
    const auto constants = parse_constants(parameters.constants, length, end_time);
    if (formula_.empty())
      throw InputError("the formula of the active stress is empty; an expression of s and t is expected",
                       formula_entry);
    require_one_value(formula_);
    try
    {
      compiled_ = std::make_shared<const Formula>(formula_, constants);
    }
    catch (const mu::ParserError &error)
    {
      throw InputError(in_words(error, formula_), formula_entry);
    }
    require_finite_values(length, end_time);
  }

  void
  Expression::require_finite_values(const double length, const double end_time) const
  {
    constexpr unsigned int n = 16;
    std::vector<double> points(n + 1), m(n + 1);
    for (unsigned int i = 0; i <= n; ++i)
      points[i] = length * i / n;
    const auto at_points = at(points);
    for (unsigned int j = 0; j <= n; ++j)
    {
      const double t = end_time * j / n;
      at_points->values(t, m);
      for (unsigned int i = 0; i <= n; ++i)
        if (!std::isfinite(m[i]))
          throw InputError(fmt::format("the formula \"{}\" gives {} at s = {}, t = {}; a finite number is expected",
                                       formula_,
                                       m[i],
                                       points[i],
                                       t),
                           formula_entry);
    }
  }

  std::unique_ptr<ActiveStressAtPoints>
  Expression::at(const std::vector<double> &points) const
  {
    return std::make_unique<FormulaAtPoints>(compiled_, points);
  }

  std::optional<double>
  Expression::period() const
  {
    if (!period_)
      period_ = find_period(*this, length_, end_time_);
    return *period_;
  }
} // namespace crawler
