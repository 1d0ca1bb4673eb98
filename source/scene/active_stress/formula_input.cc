// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/grid_samples.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress.h>
#include <crawler/scene/active_stress/formula_input.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>

namespace crawler
{
  namespace
  {
    /// muParser's objection to a formula, as one sentence with a position that counts from 1.
    std::string
    in_words(const mu::ParserError &error, const FormulaInput &input, const Formula::Constants &constants)
    {
      const std::string &formula = input.formula;
      std::string problem        = error.GetMsg();
      if (error.GetCode() == mu::ecINTERNAL_ERROR)
        problem = "the formula is not complete";
      // Positions of muParser count from 0.
      for (const char *position : {" found at position", " at expression position", " at position"})
        problem = problem.substr(0, problem.find(position));
      while (!problem.empty() && (problem.back() == '.' || problem.back() == '!'))
        problem.pop_back();
      const std::string &token = error.GetToken();
      if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN && !token.empty() &&
          std::isalpha(static_cast<unsigned char>(token[0])))
      {
        std::vector<std::string> names = {"sin",  "cos", "tan",   "asin", "acos", "atan", "sinh", "cosh",
                                          "tanh", "exp", "log",   "sqrt", "abs",  "sign", "min",  "max",
                                          "pow",  "mod", "floor", "ceil", "erf",  "erfc"};
        std::vector<std::string> known = input.variables;
        for (const auto &[name, value] : constants)
          known.push_back(name);
        names.insert(names.end(), known.begin(), known.end());
        const auto near = nearly_alike(token, names);
        problem += near.empty() ? fmt::format("; it may use {}, and functions", fmt::join(known, ", "))
                                : "; the nearest name is " + quoted_list(near);
        const bool is_called =
          trimmed(formula.substr(std::min(error.GetPos() + token.size(), formula.size()))).starts_with("(");
        if (!is_called && input.constants_entry != input.formula_entry)
          problem += fmt::format("; a constant is expected in \"{}\", like {}=1", input.constants_entry, token);
      }
      return fmt::format("error in the formula \"{}\" at position {}: {}",
                         formula,
                         std::min<std::size_t>(error.GetPos(), formula.size()) + 1,
                         problem);
    }

    /// Refuses "s = 3", which muParser takes for an assignment, and "s, t", which it takes for two formulas.
    void
    require_one_value(const std::string &formula, const std::string &formula_entry)
    {
      int depth = 0;
      for (std::size_t i = 0; i < formula.size(); ++i)
      {
        const auto refuse = [&](const std::string &why) {
          crawler::refuse(formula_entry, "error in the formula \"{}\" at position {}: {}", formula, i + 1, why);
        };
        const char c = formula[i], before = i > 0 ? formula[i - 1] : ' ',
                   after = i + 1 < formula.size() ? formula[i + 1] : ' ';
        depth += (c == '(') - (c == ')');
        if (c == '*' && after == '*')
          refuse("found \"**\", but \"^\" is expected for a power");
        if (c == ',' && depth == 0)
          refuse("one formula is expected, but there are several, separated by a comma");
        if (c == '=' && after != '=' && std::string("=<>!").find(before) == std::string::npos)
          refuse("found \"=\", but \"==\" is expected for a comparison");
      }
    }

    Formula::Constants
    parse_constants(const std::string &text,
                    const std::vector<std::string> &variables,
                    const double length,
                    const double end_time,
                    const std::string &constants_entry)
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
        const auto value = to_number(equals == std::string::npos ? std::string() : trimmed(item.substr(equals + 1)));
        const bool is_name =
          !name.empty() && std::isalpha(static_cast<unsigned char>(name[0])) &&
          std::all_of(name.begin(), name.end(), [](const unsigned char c) { return std::isalnum(c) || c == '_'; });
        if (!is_name || !value)
          refuse(constants_entry,
                 "found \"{}\" among the constants of the formula, but \"name=number, "
                 "name=number, ...\" is expected",
                 trimmed(item));
        if (std::find(variables.begin(), variables.end(), name) != variables.end())
          refuse(constants_entry, "\"{}\" is a variable of the formula and cannot be a constant", name);
        for (const auto &[other, ignored] : constants)
          if (other == name)
            refuse(constants_entry, "the constant \"{}\" is already defined", name);
        constants.emplace_back(name, *value);
      }
      return constants;
    }

    /// Equal parts of [0, @p end], and the middle between each two breaks.
    std::vector<double>
    samples(std::vector<double> breaks, const double end)
    {
      constexpr unsigned int n    = 16;
      std::vector<double> samples = equal_parts(0., end, n);
      std::ranges::sort(breaks);
      for (std::size_t i = 1; i < breaks.size(); ++i)
        samples.push_back(std::midpoint(breaks[i - 1], breaks[i]));
      return samples;
    }
  } // namespace

  std::shared_ptr<const Formula>
  read_formula(const FormulaInput &input, const double length, const double end_time)
  {
    const auto constants = parse_constants(input.constants, input.variables, length, end_time, input.constants_entry);
    if (input.formula.empty())
      refuse(input.formula_entry,
             "the formula of the {} is empty; an expression of {} is expected",
             input.quantity,
             fmt::join(input.variables, input.variables.size() > 2 ? ", " : " and "));
    require_one_value(input.formula, input.formula_entry);
    try
    {
      return std::make_shared<const Formula>(input.formula, constants, input.variables);
    }
    catch (const mu::ParserError &error)
    {
      throw InputError(in_words(error, input, constants), input.formula_entry);
    }
  }

  void
  require_finite_values(const ActiveStress &stress,
                        const FormulaInput &input,
                        const std::string &where,
                        const double length,
                        const double end_time)
  {
    const std::vector<double> points = samples(stress.breaks_in_space(), length);
    std::vector<double> m(points.size());
    const auto at_points = stress.at(points);
    for (const double t : samples(stress.breaks_in_time(), end_time))
    {
      at_points->values(t, m);
      for (std::size_t i = 0; i < m.size(); ++i)
        if (!std::isfinite(m[i]))
          refuse(input.formula_entry,
                 "the formula \"{}\" gives {}{} at s = {}, t = {}; a finite number is expected",
                 input.formula,
                 m[i],
                 where,
                 points[i],
                 t);
    }
  }
} // namespace crawler
