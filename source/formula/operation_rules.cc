// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/formula/enclosure.h>
#include <crawler/formula/operation_rules.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

namespace crawler
{
  namespace
  {
    using namespace interval_policies; // comparisons
    using Bound     = OperationRules::Bound;
    using Numbers   = std::span<const double *const>;
    using Arguments = std::span<const Enclosure>;

    const Enclosure anything{Interval::whole(), Interval::whole()};

    // Derivatives are written once, for numbers and for intervals, with these functions and those of both libraries.

    double
    square(const double x)
    {
      return x * x;
    }

    /// Quotient a/x; as an interval everything where x may be 0.
    double
    over(const double a, const double x)
    {
      return a / x;
    }
    Interval
    over(const double a, const Interval &x)
    {
      return zero_in(x) ? Interval::whole() : a * (1. / x);
    }

    /// Inverse root 1/sqrt(x).
    double
    inverse_root(const double x)
    {
      return 1. / std::sqrt(x);
    }
    Interval
    inverse_root(const Interval &x)
    {
      const Interval r = sqrt(x);
      return {1. / r.upper(), r.lower() > 0. ? 1. / r.lower() : std::numeric_limits<double>::infinity()};
    }

    bool
    is_constant(const Enclosure &x)
    {
      return singleton(x.value);
    }

    /// Chain rule: a value constant in the box has the rate 0, even where the derivative is unknown.
    Interval
    chain(const Interval &derivative, const Interval &rate)
    {
      return equal(rate, Interval(0.)) ? rate : derivative * rate;
    }

    /// Image of an interval under an increasing function.
    Interval
    increasing(double (*f)(double), const Interval &x)
    {
      return {f(x.lower()), f(x.upper())};
    }

    Interval
    whole_power(const Interval &x, const int n)
    {
      return n < 0 ? over(1., pow(x, -n)) : n > 0 ? pow(x, n) : 1.;
    }

    // Tangents: derivative of the result.

    /// Tangent of a function of one argument x with the value f, by f'(x).
    template <auto derivative>
    void
    tangent_by(const Numbers x, const Numbers dx, const double *f, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        df[i] = dx[0][i] == 0. ? 0. : derivative(x[0][i], f[i]) * dx[0][i];
    }

    /// Tangent of a function of two arguments x and y with the value f, by its derivative as a function of x, y, dx, dy
    /// and f.
    template <auto derivative>
    void
    tangent_of_two(const Numbers x, const Numbers dx, const double *f, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        df[i] = derivative(x[0][i], x[1][i], dx[0][i], dx[1][i], f[i]);
    }

    /// Derivative of f = x^y. Terms of a constant base or exponent are left out, so that (-1)^2 and 0^2 have a
    /// derivative.
    double
    power_derivative(const double x, const double y, const double dx, const double dy, const double f)
    {
      return (dx == 0. ? 0. : y * std::pow(x, y - 1.) * dx) + (dy == 0. ? 0. : f * std::log(x) * dy);
    }

    void
    select_tangent(const Numbers x, const Numbers dx, const double *, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        df[i] = x[0][i] != 0. ? dx[1][i] : dx[2][i];
    }

    /// Tangent of the smallest or largest argument: that of the argument equal to the result.
    void
    extreme_tangent(const Numbers x, const Numbers dx, const double *f, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = x.size(); j-- > 0;)
          if (x[j][i] == f[i])
            df[i] = dx[j][i];
    }

    void
    sum_tangent(const Numbers x, const Numbers dx, const double *, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
      {
        df[i] = 0.;
        for (std::size_t j = 0; j < x.size(); ++j)
          df[i] += dx[j][i];
      }
    }

    void
    average_tangent(const Numbers x, const Numbers dx, const double *f, double *df, const std::size_t n)
    {
      sum_tangent(x, dx, f, df, n);
      for (std::size_t i = 0; i < n; ++i)
        df[i] /= static_cast<double>(x.size());
    }

    // Enclosures: value and rate of the result from those of the arguments.

    /// Enclosure of a function of one argument x with the value f, by f'(x).
    template <auto value, auto derivative>
    Enclosure
    enclosure_by(const Arguments arguments)
    {
      const Interval x = arguments[0].value, f = value(x);
      return {f, chain(derivative(x, f), arguments[0].rate)};
    }

    Enclosure
    abs_rule(const Arguments arguments)
    {
      const Interval x = arguments[0].value, rate = arguments[0].rate;
      return {abs(x), x.lower() >= 0. ? rate : x.upper() <= 0. ? -rate : hull(rate, -rate)};
    }

    Enclosure
    operator+(const Enclosure &a, const Enclosure &b)
    {
      return {a.value + b.value, a.rate + b.rate};
    }

    Enclosure
    operator-(const Enclosure &a)
    {
      return {-a.value, -a.rate};
    }

    Enclosure
    times_rule(const Arguments x)
    {
      if (x[0].number == x[1].number && x[0].number != Enclosure::no_number) // a square
        return {square(x[0].value), 2. * x[0].value * x[0].rate};
      return {x[0].value * x[1].value, x[0].rate * x[1].value + x[0].value * x[1].rate};
    }

    Enclosure
    divide_rule(const Arguments x)
    {
      const Interval of_divisor = over(1., x[1].value), f = x[0].value * of_divisor;
      return {f, (x[0].rate - chain(f, x[1].rate)) * of_divisor};
    }

    Enclosure
    power_rule(const Arguments x)
    {
      const Interval base = x[0].value;
      const double y      = x[1].value.lower();
      if (is_constant(x[1]) && y == std::rint(y) && std::abs(y) <= 64.)
      {
        const int n = static_cast<int>(y);
        return {whole_power(base, n), n == 0 ? 0. : chain(y * whole_power(base, n - 1), x[0].rate)};
      }
      if (is_constant(x[1]) && base.lower() >= 0.)
      {
        const auto power = [base](const double exponent) {
          return hull(std::pow(base.lower(), exponent), Interval(std::pow(base.upper(), exponent)));
        };
        return {power(y), chain(y * power(y - 1.), x[0].rate)};
      }
      if (!(base.lower() > 0.))
        return anything;
      const Interval of_base = log(base), f = exp(x[1].value * of_base);
      return {f, f * (x[1].rate * of_base + chain(x[1].value * over(1., base), x[0].rate))};
    }

    /// Value of an operation that jumps, where the side is uncertain. Jumps at a time are infinitely fast, unless their
    /// times are known; those that depend on the place, too, move, and are searched for elsewhere.
    Enclosure
    jumping(const Interval &value, const Arguments x)
    {
      const bool is_known = std::ranges::any_of(x, &Enclosure::jumps_known);
      return {value, singleton(value) || is_known ? Interval(0.) : Interval::whole()};
    }

    template <double (*function)(double)>
    Enclosure
    step_rule(const Arguments x)
    {
      return jumping(increasing(function, x[0].value), x);
    }

    double
    sign_of_number(const double x)
    {
      return x > 0. ? 1. : x < 0. ? -1. : 0.;
    }

    Enclosure
    modulo_rule(const Arguments x)
    {
      if (!is_constant(x[1]) || !(x[1].value.lower() > 0.))
        return anything;
      const double y = x[1].value.lower(), first = std::floor(x[0].value.lower() / y),
                   last = std::floor(x[0].value.upper() / y);
      if (first == last)
        return {x[0].value - first * y, x[0].rate};
      const Enclosure jump = jumping({0., y}, x);
      return {jump.value, x[0].rate + jump.rate};
    }

    /// Truth value 1, 0 or either, from possibility and certainty.
    Enclosure
    truth(const bool is_possible, const bool is_certain, const Arguments x)
    {
      return jumping({is_certain ? 1. : 0., is_possible ? 1. : 0.}, x);
    }

    /// Comparison of two values by its possibility and certainty.
    template <bool (*may_be)(const Interval &, const Interval &), bool (*is)(const Interval &, const Interval &)>
    Enclosure
    comparison(const Arguments x)
    {
      return truth(may_be(x[0].value, x[1].value), is(x[0].value, x[1].value), x);
    }

    bool
    is_never_0(const Enclosure &x)
    {
      return !zero_in(x.value);
    }

    bool
    is_always_0(const Enclosure &x)
    {
      return equal(x.value, Interval(0.));
    }

    Enclosure
    and_rule(const Arguments x)
    {
      return truth(!is_always_0(x[0]) && !is_always_0(x[1]), is_never_0(x[0]) && is_never_0(x[1]), x);
    }

    Enclosure
    or_rule(const Arguments x)
    {
      return truth(!is_always_0(x[0]) || !is_always_0(x[1]), is_never_0(x[0]) || is_never_0(x[1]), x);
    }

    Enclosure
    select_rule(const Arguments x)
    {
      if (is_never_0(x[0]))
        return x[1];
      if (is_always_0(x[0]))
        return x[2];
      const Interval jump = jumping({0., 1.}, x.subspan(0, 1)).rate;
      return {hull(x[1].value, x[2].value), hull(hull(x[1].rate, x[2].rate), jump)};
    }

    Enclosure
    min_rule(const Arguments x)
    {
      Enclosure f = x[0];
      for (const Enclosure &e : x.subspan(1))
        f = {min(f.value, e.value),
             cerlt(f.value, e.value)   ? f.rate
             : cerlt(e.value, f.value) ? e.rate
                                       : hull(f.rate, e.rate)};
      return f;
    }

    Enclosure
    max_rule(const Arguments x)
    {
      std::vector<Enclosure> turned;
      for (const Enclosure &e : x)
        turned.push_back(-e);
      return -min_rule(turned);
    }

    /// Number of the argument that is least; of equal ones the first.
    Enclosure
    number_of_least(const Arguments x)
    {
      const auto may_be_least = [&](const Enclosure &e) {
        return std::ranges::none_of(x, [&](const Enclosure &other) {
          return &other < &e ? cerle(other.value, e.value) : cerlt(other.value, e.value);
        });
      };
      const auto first = std::ranges::find_if(x, may_be_least),
                 last  = std::find_if(x.rbegin(), x.rend(), may_be_least).base();
      return {{static_cast<double>(first - x.begin()), static_cast<double>(last - x.begin() - 1)}, 0.};
    }

    Enclosure
    number_of_largest(const Arguments x)
    {
      std::vector<Enclosure> turned;
      for (const Enclosure &e : x)
        turned.push_back(-e);
      return number_of_least(turned);
    }

    /// Number of the period of mod(a, b), if b is constant.
    Enclosure
    number_of_period(const Arguments x)
    {
      if (!is_constant(x[1]) || !(x[1].value.lower() > 0.))
        return {0., 0.};
      const Enclosure periods = {x[0].value / x[1].value, 0.};
      return step_rule<std::floor>({&periods, 1});
    }

    Enclosure
    sum_rule(const Arguments x)
    {
      Enclosure f = x[0];
      for (const Enclosure &e : x.subspan(1))
        f = f + e;
      return f;
    }

    Enclosure
    average_rule(const Arguments x)
    {
      const Enclosure f = sum_rule(x);
      const double part = 1. / static_cast<double>(x.size());
      return {part * f.value, part * f.rate};
    }

    Enclosure
    unknown_rule(const Arguments)
    {
      return anything;
    }

    // Functions of one argument x: their value f, for intervals, and their derivative, for numbers as well. Functions
    // of two arguments x and y: the derivative of their value f, for numbers.
#define CRAWLER_DERIVATIVE(expression) \
  []([[maybe_unused]] const auto &x, [[maybe_unused]] const auto &f) { return expression; }
#define CRAWLER_FUNCTION(value, derivative)                                                              \
  {                                                                                                      \
    tangent_by<CRAWLER_DERIVATIVE(derivative)>,                                                          \
      enclosure_by<[](const Interval &x) -> Interval { return value; }, CRAWLER_DERIVATIVE(derivative)>, \
  }
#define CRAWLER_TANGENT(expression)                  \
  tangent_of_two<[]([[maybe_unused]] const double x, \
                    [[maybe_unused]] const double y, \
                    const double dx,                 \
                    const double dy,                 \
                    [[maybe_unused]] const double f) { return expression; }>

    const double gauss = 2. * std::numbers::inv_sqrtpi; // erf'(x) = gauss exp(-x^2)

    /// Rules of an operation that is constant except for jumps: another value is another side.
    constexpr OperationRules
    steps(const Bound bound)
    {
      return {nullptr, bound, bound};
    }

    /// The list of all operations, kept only here.
    const std::map<std::string, OperationRules> &
    all_rules()
    {
      static const std::map<std::string, OperationRules> list = {
        {"sin", CRAWLER_FUNCTION(sin(x), cos(x))},
        {"cos", CRAWLER_FUNCTION(cos(x), -sin(x))},
        {"tan", CRAWLER_FUNCTION(tan(x), 1. + square(f))},
        {"asin", CRAWLER_FUNCTION(asin(x), inverse_root(1. - square(x)))},
        {"acos", CRAWLER_FUNCTION(acos(x), -inverse_root(1. - square(x)))},
        {"atan", CRAWLER_FUNCTION(atan(x), over(1., 1. + square(x)))},
        {"sinh", CRAWLER_FUNCTION(sinh(x), cosh(x))},
        {"cosh", CRAWLER_FUNCTION(cosh(x), sinh(x))},
        {"tanh", CRAWLER_FUNCTION(tanh(x), 1. - square(f))},
        {"asinh", CRAWLER_FUNCTION(increasing(std::asinh, x), inverse_root(1. + square(x)))},
        {"acosh", {tangent_by<CRAWLER_DERIVATIVE(inverse_root(square(x) - 1.))>, unknown_rule}},
        {"atanh", {tangent_by<CRAWLER_DERIVATIVE(1. / (1. - square(x)))>, unknown_rule}},
        {"log2", CRAWLER_FUNCTION(std::numbers::log2e * log(x), over(std::numbers::log2e, x))},
        {"log10", CRAWLER_FUNCTION(std::numbers::log10e * log(x), over(std::numbers::log10e, x))},
        {"log", CRAWLER_FUNCTION(log(x), over(1., x))},
        {"ln", CRAWLER_FUNCTION(log(x), over(1., x))},
        {"exp", CRAWLER_FUNCTION(exp(x), f)},
        {"sqrt", CRAWLER_FUNCTION(sqrt(x), 0.5 * inverse_root(x))},
        {"abs", {tangent_by<CRAWLER_DERIVATIVE(x < 0. ? -1. : 1.)>, abs_rule, step_rule<sign_of_number>}},
        {"-", CRAWLER_FUNCTION(-x, -1.)},
        {"erf", CRAWLER_FUNCTION(increasing(std::erf, x), gauss * exp(-square(x)))},
        {"erfc", CRAWLER_FUNCTION(1. - increasing(std::erf, x), -gauss * exp(-square(x)))},
        {"atan2", {CRAWLER_TANGENT((y * dx - x * dy) / (x * x + y * y)), unknown_rule}},
        {"pow", {tangent_of_two<power_derivative>, power_rule}},
        {"mod", {CRAWLER_TANGENT(dx - dy * std::floor(x / y)), modulo_rule, number_of_period}},
        {"min", {extreme_tangent, min_rule, number_of_least}},
        {"max", {extreme_tangent, max_rule, number_of_largest}},
        {"sum", {sum_tangent, sum_rule}},
        {"avg", {average_tangent, average_rule}},
        {"?", {select_tangent, select_rule}},
        {"a+b", {CRAWLER_TANGENT(dx + dy), [](const Arguments x) { return x[0] + x[1]; }}},
        {"a-b", {CRAWLER_TANGENT(dx - dy), [](const Arguments x) { return x[0] + -x[1]; }}},
        {"a*b", {CRAWLER_TANGENT(dx * y + x * dy), times_rule}},
        {"a/b", {CRAWLER_TANGENT((dx - f * dy) / y), divide_rule}},
        {"sign", steps(step_rule<sign_of_number>)},
        {"rint", steps(step_rule<std::rint>)},
        {"floor", steps(step_rule<std::floor>)},
        {"ceil", steps(step_rule<std::ceil>)},
        {"a<b", steps(comparison<poslt, cerlt>)},
        {"a<=b", steps(comparison<posle, cerle>)},
        {"a>b", steps(comparison<posgt, cergt>)},
        {"a>=b", steps(comparison<posge, cerge>)},
        {"a==b", steps(comparison<poseq, cereq>)},
        {"a!=b", steps(comparison<posne, cerne>)},
        {"a&&b", steps(and_rule)},
        {"a||b", steps(or_rule)},
      };
      return list;
    }
#undef CRAWLER_TANGENT
#undef CRAWLER_FUNCTION
#undef CRAWLER_DERIVATIVE
  } // namespace

  OperationRules
  rules_of(const std::string &operation)
  {
    const auto found = all_rules().find(operation);
    if (found == all_rules().end())
      throw std::logic_error("no rule for the operation " + operation);
    return found->second;
  }
} // namespace crawler
