// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/formula/formula.h>

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

namespace crawler
{
  namespace
  {
    using Operand  = Formula::Operand;
    using Function = Formula::Operation::Function;

    // Loops of operations: result_i = operation(arguments_i).

    template <typename Operation>
    void
    binary(Function, const std::span<const Operand> arguments, double *result, const std::size_t n)
    {
      const Operation operation{};
      const double *x = arguments[0].values, *y = arguments[1].values;
      if (arguments[0].is_scalar && arguments[1].is_scalar)
        std::fill_n(result, n, operation(*x, *y));
      else if (arguments[0].is_scalar)
        for (std::size_t i = 0; i < n; ++i)
          result[i] = operation(*x, y[i]);
      else if (arguments[1].is_scalar)
        for (std::size_t i = 0; i < n; ++i)
          result[i] = operation(x[i], *y);
      else
        for (std::size_t i = 0; i < n; ++i)
          result[i] = operation(x[i], y[i]);
    }

    using Power = decltype([](const double x, const double y) { return std::pow(x, y); });

    void
    select(Function, const std::span<const Operand> arguments, double *result, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        result[i] = arguments[0][i] != 0. ? arguments[1][i] : arguments[2][i];
    }

    void
    function_of_one(const Function function,
                    const std::span<const Operand> arguments,
                    double *result,
                    const std::size_t n)
    {
      const auto f = reinterpret_cast<mu::fun_type1>(function);
      for (std::size_t i = 0; i < n; ++i)
        result[i] = f(arguments[0].values[i]);
    }

    void
    function_of_two(const Function function,
                    const std::span<const Operand> arguments,
                    double *result,
                    const std::size_t n)
    {
      const auto f = reinterpret_cast<mu::fun_type2>(function);
      for (std::size_t i = 0; i < n; ++i)
        result[i] = f(arguments[0][i], arguments[1][i]);
    }

    /// min, max, sum, avg of any number of arguments.
    void
    function_of_many(const Function function,
                     const std::span<const Operand> arguments,
                     double *result,
                     const std::size_t n)
    {
      const auto f = reinterpret_cast<mu::multfun_type>(function);
      std::vector<double> values(arguments.size());
      for (std::size_t i = 0; i < n; ++i)
      {
        for (std::size_t j = 0; j < values.size(); ++j)
          values[j] = arguments[j][i];
        result[i] = f(values.data(), static_cast<int>(values.size()));
      }
    }

    /// An operator between two values: its code in muParser, the name of its rules, and its loop.
    struct Operator
    {
      mu::ECmdCode code;
      const char *name;
      Formula::Operation::Loop loop;
    };
    constexpr Operator operators[] = {{mu::cmLE, "a<=b", binary<std::less_equal<double>>},
                                      {mu::cmGE, "a>=b", binary<std::greater_equal<double>>},
                                      {mu::cmNEQ, "a!=b", binary<std::not_equal_to<double>>},
                                      {mu::cmEQ, "a==b", binary<std::equal_to<double>>},
                                      {mu::cmLT, "a<b", binary<std::less<double>>},
                                      {mu::cmGT, "a>b", binary<std::greater<double>>},
                                      {mu::cmADD, "a+b", binary<std::plus<double>>},
                                      {mu::cmSUB, "a-b", binary<std::minus<double>>},
                                      {mu::cmMUL, "a*b", binary<std::multiplies<double>>},
                                      {mu::cmDIV, "a/b", binary<std::divides<double>>},
                                      {mu::cmPOW, "pow", binary<Power>},
                                      {mu::cmLAND, "a&&b", binary<std::logical_and<double>>},
                                      {mu::cmLOR, "a||b", binary<std::logical_or<double>>}};

    /// Defines the functions and constants that users expect besides muParser's own.
    void
    define_functions(mu::Parser &parser)
    {
      parser.DefineFun("pow", [](const double x, const double y) { return std::pow(x, y); });
      parser.DefineFun("floor", [](const double x) { return std::floor(x); });
      parser.DefineFun("ceil", [](const double x) { return std::ceil(x); });
      parser.DefineFun("mod", [](const double x, const double y) { return x - y * std::floor(x / y); });
      parser.DefineFun("erf", [](const double x) { return std::erf(x); });
      parser.DefineFun("erfc", [](const double x) { return std::erfc(x); });
    }
  } // namespace

  /// Translates muParser's byte code, a program for a stack machine, into operations between numbered values.
  class FormulaReader
  {
  public:
    /// Starts with the variables: @p variables are the values of the @p names that the byte code points to.
    FormulaReader(Formula &formula,
                  const mu::Parser &parser,
                  const std::vector<std::string> &names,
                  const std::vector<double> &variables)
      : formula_(formula)
      , variables_(variables)
    {
      for (const auto &[name, function] : parser.GetFunDef())
        names_[reinterpret_cast<Function>(function.GetAddr())] = name;
      for (const std::string &name : names)
        add_value({name != "t", name != "s"}); // other variables may change with place and time
    }

    void
    read(const mu::SToken *token)
    {
      for (; token->Cmd != mu::cmEND; ++token)
        read_token(*token);
      formula_.result_ = pop();
      keep(formula_.result_);
    }

  private:
    /// A "c ? a : b" during reading: the skips over a and over b.
    struct Condition
    {
      unsigned int value;
      std::size_t skip_a, skip_b = 0;
    };

    void
    read_token(const mu::SToken &token)
    {
      const auto variable = [&]() {
        const auto number      = static_cast<unsigned int>(token.Val.ptr - variables_.data());
        formula_.used_[number] = true;
        return number;
      };
      switch (token.Cmd)
      {
        case mu::cmVAL:
          return stack_.push_back(constant(token.Val.data2));
        case mu::cmVAR:
          return stack_.push_back(variable());
        case mu::cmVARMUL: // x data + data2
          stack_.insert(stack_.end(), {variable(), constant(token.Val.data)});
          apply(mu::cmMUL);
          stack_.push_back(constant(token.Val.data2));
          return apply(mu::cmADD);
        case mu::cmVARPOW2:
          return power(variable(), 2);
        case mu::cmVARPOW3:
          return power(variable(), 3);
        case mu::cmVARPOW4:
          return power(variable(), 4);
        case mu::cmFUNC:
          return call(token.Fun.cb, token.Fun.argc);
        case mu::cmIF:
          conditions_.push_back({pop(), 0});
          conditions_.back().skip_a = skip(true);
          return;
        case mu::cmELSE:
          formula_.of_both_[conditions_.back().skip_a].target = formula_.of_both_.size();
          conditions_.back().skip_b                           = skip(false);
          return;
        case mu::cmENDIF:
          return end_condition();
        default:
          return apply(token.Cmd);
      }
    }

    void
    apply(const mu::ECmdCode code)
    {
      for (const auto &[own_code, name, loop] : operators)
        if (own_code == code)
          return add({.loop = loop, .rules = rules_of(name)}, 2);
      throw mu::ParserError(mu::ecINTERNAL_ERROR);
    }

    /// Power by repeated multiplication from the left, as in muParser.
    void
    power(const unsigned int variable, const unsigned int exponent)
    {
      stack_.push_back(variable);
      for (unsigned int i = 1; i < exponent; ++i)
      {
        stack_.push_back(variable);
        apply(mu::cmMUL);
      }
    }

    /// Calls a function; @p count is negative for functions of any number of arguments.
    void
    call(const mu::generic_callable_type &function, const int count)
    {
      if (function._pUserData != nullptr || count == 0 || count > 2)
        throw mu::ParserError(mu::ecINTERNAL_ERROR);
      const auto loop = count < 0 ? function_of_many : count == 1 ? function_of_one : function_of_two;
      // Functions without a name are the sign: -x (muParser defines no other).
      const auto name         = names_.find(reinterpret_cast<Function>(function._pRawFun));
      const std::string known = name == names_.end() ? "-" : name->second;
      add({.loop = loop, .rules = rules_of(known), .function = function._pRawFun},
          static_cast<std::size_t>(std::abs(count)));
    }

    /// Adds a skip and returns its position.
    std::size_t
    skip(const bool branch)
    {
      const unsigned int condition = conditions_.back().value;
      keep(condition);
      formula_.of_both_.push_back({.arguments = {condition}, .branch = branch});
      return formula_.of_both_.size() - 1;
    }

    void
    end_condition()
    {
      const Condition condition                  = conditions_.back();
      formula_.of_both_[condition.skip_b].target = formula_.of_both_.size();
      conditions_.pop_back();
      stack_.insert(stack_.end() - 2, condition.value);
      add({.loop = select, .rules = rules_of("?")}, 3);
    }

    /// Takes the arguments from the stack, puts the result there and adds the operation to its list.
    void
    add(Formula::Operation operation, const std::size_t n_arguments)
    {
      if (stack_.size() < n_arguments)
        throw mu::ParserError(mu::ecINTERNAL_ERROR);
      operation.arguments.assign(stack_.end() - static_cast<std::ptrdiff_t>(n_arguments), stack_.end());
      stack_.resize(stack_.size() - n_arguments);
      const Formula::Dependence on = dependence(operation);
      operation.result             = add_value(on);
      stack_.push_back(operation.result);
      if (on.on_s && on.on_t)
        for (const unsigned int argument : operation.arguments)
          keep(argument);
      auto &list = !on.on_s ? formula_.of_time_ : !on.on_t ? formula_.of_place_ : formula_.of_both_;
      list.push_back(std::move(operation));
    }

    Formula::Dependence
    dependence(const Formula::Operation &operation) const
    {
      Formula::Dependence on = {false, false, true, true};
      for (const unsigned int argument : operation.arguments)
      {
        const Formula::Dependence &its = formula_.dependence_[argument];
        on.on_s |= its.on_s;
        on.on_t |= its.on_t;
        on.on_s_in_steps &= its.on_s_in_steps || !its.on_s;
        on.on_t_in_steps &= its.on_t_in_steps || !its.on_t;
      }
      const bool is_step = operation.rules.tangent == nullptr;
      on.on_s_in_steps |= is_step && !on.on_t;
      on.on_t_in_steps |= is_step && !on.on_s;
      return on;
    }

    unsigned int
    add_value(const Formula::Dependence on)
    {
      formula_.dependence_.push_back(on);
      formula_.scalars_.push_back(0.);
      formula_.kept_.push_back(false);
      return static_cast<unsigned int>(formula_.dependence_.size() - 1);
    }

    unsigned int
    constant(const double value)
    {
      const unsigned int number = add_value({false, false});
      formula_.scalars_[number] = value;
      return number;
    }

    void
    keep(const unsigned int value)
    {
      formula_.kept_[value] = formula_.dependence_[value].on_s && !formula_.dependence_[value].on_t;
    }

    unsigned int
    pop()
    {
      if (stack_.empty())
        throw mu::ParserError(mu::ecINTERNAL_ERROR);
      const unsigned int value = stack_.back();
      stack_.pop_back();
      return value;
    }

    Formula &formula_;
    const std::vector<double> &variables_;
    std::map<Function, std::string> names_; ///< Names of muParser's functions and of the program's own.
    std::vector<unsigned int> stack_;       ///< Values.
    std::vector<Condition> conditions_;
  };

  Formula::Formula(const std::string &text, const Constants &constants, const std::vector<std::string> &variables)
    : used_(variables.size(), false)
  {
    std::vector<double> values(variables.size(), 0.);
    mu::Parser parser;
    define_functions(parser);
    for (const auto &[name, value] : constants)
      parser.DefineConst(name, value);
    for (std::size_t i = 0; i < variables.size(); ++i)
      parser.DefineVar(variables[i], &values[i]);
    parser.SetExpr(text);
    parser.Eval(); // finds syntax errors and makes the byte code
    FormulaReader(*this, parser, variables, values).read(parser.GetByteCode().GetBase());
  }
} // namespace crawler
