// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/expression.h>

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

    std::vector<std::pair<std::string, double>>
    parse_constants(const std::string &text, const double length, const double end_time)
    {
      std::vector<std::pair<std::string, double>> constants = {
        {"pi", std::numbers::pi}, {"L", length}, {"T", end_time}};
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


  /// The parser and the two variables it is bound to; neither can be copied.
  class Expression::Formula
  {
  public:
    Formula(const std::string &formula, const std::vector<std::pair<std::string, double>> &constants)
    {
      // What users of formulas expect besides muParser's own functions.
      parser_.DefineFun("pow",
                        [](const double x, const double y)
                        {
                          return std::pow(x, y);
                        });
      parser_.DefineFun("floor",
                        [](const double x)
                        {
                          return std::floor(x);
                        });
      parser_.DefineFun("ceil",
                        [](const double x)
                        {
                          return std::ceil(x);
                        });
      parser_.DefineFun("mod",
                        [](const double x, const double y)
                        {
                          return x - y * std::floor(x / y);
                        });
      parser_.DefineFun("erf",
                        [](const double x)
                        {
                          return std::erf(x);
                        });
      parser_.DefineFun("erfc",
                        [](const double x)
                        {
                          return std::erfc(x);
                        });
      for (const auto &[name, value] : constants)
        parser_.DefineConst(name, value);
      parser_.DefineVar("s", &s_);
      parser_.DefineVar("t", &t_);
      parser_.SetExpr(formula);
      parser_.Eval(); // finds syntax errors now
    }

    double
    value(const double s, const double t)
    {
      s_ = s;
      t_ = t;
      return parser_.Eval();
    }

  private:
    double s_ = 0., t_ = 0.;
    mu::Parser parser_;
  };

  class Expression::AtPoints : public ActiveStressAtPoints
  {
  public:
    AtPoints(std::shared_ptr<Formula> formula, std::vector<double> points)
      : formula_(std::move(formula))
      , points_(std::move(points))
    {
    }

    void
    values(const double t, const std::span<double> m) override
    {
      for (std::size_t i = 0; i < points_.size(); ++i)
        m[i] = formula_->value(points_[i], t);
    }

  private:
    const std::shared_ptr<Formula> formula_;
    const std::vector<double> points_;
  };


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
  {
    const std::string &formula = parameters.active_stress;
    const auto constants       = parse_constants(parameters.constants, length, end_time);
    if (formula.empty())
      throw InputError("the formula of the active stress is empty; an expression of s and t is expected",
                       formula_entry);
    require_one_value(formula);
    constexpr unsigned int n = 16;
    try
    {
      formula_ = std::make_shared<Formula>(formula, constants);
      for (unsigned int j = 0; j <= n; ++j)
        for (unsigned int i = 0; i <= n; ++i)
        {
          const double s = length * i / n, t = end_time * j / n, m = formula_->value(s, t);
          if (!std::isfinite(m))
            throw InputError(
              fmt::format(
                "the formula \"{}\" gives {} at s = {}, t = {}; a finite number is expected", formula, m, s, t),
              formula_entry);
        }
    }
    catch (const mu::ParserError &error)
    {
      throw InputError(in_words(error, formula), formula_entry);
    }
  }

  std::unique_ptr<ActiveStressAtPoints>
  Expression::at(const std::vector<double> &points) const
  {
    return std::make_unique<AtPoints>(formula_, points);
  }
} // namespace crawler
