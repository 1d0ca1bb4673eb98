// SPDX-License-Identifier: LGPL-2.1-or-later
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
    using Bound     = FormulaOperation::Bound;
    using Arguments = std::span<const Enclosure>;

    constexpr double infinite = std::numeric_limits<double>::infinity();
    constexpr Interval all{-infinite, infinite};
    constexpr Enclosure anything{all, all};

    Interval
    hull(const Interval a, const Interval b)
    {
      return {std::min(a.lower, b.lower), std::max(a.upper, b.upper)};
    }

    Interval
    operator+(const Interval a, const Interval b)
    {
      return {a.lower + b.lower, a.upper + b.upper};
    }

    Interval
    operator-(const Interval a)
    {
      return {-a.upper, -a.lower};
    }

    Interval
    operator*(const Interval a, const Interval b)
    {
      const auto product = [](const double x, const double y) // 0 times anything is 0
      { return x == 0. || y == 0. ? 0. : x * y; };
      const double p[] = {
        product(a.lower, b.lower), product(a.lower, b.upper), product(a.upper, b.lower), product(a.upper, b.upper)};
      return {*std::min_element(p, p + 4), *std::max_element(p, p + 4)};
    }

    Interval
    inverse(const Interval a)
    {
      return a.lower > 0. || a.upper < 0. ? Interval{1. / a.upper, 1. / a.lower} : all;
    }

    Interval
    square(const Interval a)
    {
      const double x = a.lower * a.lower, y = a.upper * a.upper;
      return {a.lower <= 0. && a.upper >= 0. ? 0. : std::min(x, y), std::max(x, y)};
    }

    Interval
    scaled(const Interval a, const double factor)
    {
      return a * Interval{factor, factor};
    }

    bool
    is_constant(const Enclosure &x)
    {
      return x.value.lower == x.value.upper;
    }

    /// What does not change in the box does not change in time, either, even where a derivative is not known.
    Interval
    chain(const Interval derivative, const Interval rate)
    {
      return rate.lower == 0. && rate.upper == 0. ? rate : derivative * rate;
    }

    /// Of a function that increases.
    Interval
    increasing(double (*f)(double), const Interval x)
    {
      return {f(x.lower), f(x.upper)};
    }

    // Interval extensions of functions of one argument.

    Interval
    sine(const Interval x)
    {
      constexpr double pi = std::numbers::pi;
      if (!(x.upper - x.lower < 2. * pi))
        return {-1., 1.};
      const auto contains = [x](const double phase) // one of phase + 2 pi n
      { return std::floor((x.upper - phase) / (2. * pi)) >= std::ceil((x.lower - phase) / (2. * pi)); };
      const double a = std::sin(x.lower), b = std::sin(x.upper);
      return {contains(-0.5 * pi) ? -1. : std::min(a, b), contains(0.5 * pi) ? 1. : std::max(a, b)};
    }

    Interval
    cosine(const Interval x)
    {
      constexpr double quarter = 0.5 * std::numbers::pi;
      return sine({x.lower + quarter, x.upper + quarter});
    }

    Interval
    hyperbolic_cosine(const Interval x)
    {
      const double a = std::cosh(x.lower), b = std::cosh(x.upper);
      return {x.lower <= 0. && x.upper >= 0. ? 1. : std::min(a, b), std::max(a, b)};
    }

    Interval
    exponential(const Interval x)
    {
      return {std::exp(x.lower), std::exp(x.upper)};
    }

    /// Where it is not defined it is not looked at: such values are refused elsewhere.
    Interval
    logarithm(const Interval x)
    {
      return {x.lower > 0. ? std::log(x.lower) : -infinite, x.upper > 0. ? std::log(x.upper) : -infinite};
    }

    Interval
    root(const Interval x)
    {
      return {std::sqrt(std::max(x.lower, 0.)), std::sqrt(std::max(x.upper, 0.))};
    }

    /// 1/sqrt(x)
    Interval
    inverse_root(const Interval x)
    {
      const Interval r = root(x);
      return {1. / r.upper, r.lower > 0. ? 1. / r.lower : infinite};
    }

    Interval
    integer_power(const Interval x, const int n)
    {
      if (n < 0)
        return inverse(integer_power(x, -n));
      const double a = std::pow(x.lower, n), b = std::pow(x.upper, n);
      if (n % 2 == 1 || x.lower >= 0.)
        return {a, b};
      return x.upper <= 0. ? Interval{b, a} : Interval{n == 0 ? 1. : 0., std::max(a, b)};
    }

    // Rules: value and rate of the result from those of the arguments.

#define CRAWLER_RULE(name, value_of, derivative)            \
  Enclosure name(const Arguments arguments)                 \
  {                                                         \
    const Interval x                  = arguments[0].value; \
    [[maybe_unused]] const Interval f = value_of;           \
    return {f, chain(derivative, arguments[0].rate)};       \
  }
    const Interval one{1., 1.};
    CRAWLER_RULE(sin_rule, sine(x), cosine(x))
    CRAWLER_RULE(cos_rule, cosine(x), -sine(x))
    CRAWLER_RULE(sinh_rule, increasing(std::sinh, x), hyperbolic_cosine(x))
    CRAWLER_RULE(cosh_rule, hyperbolic_cosine(x), increasing(std::sinh, x))
    CRAWLER_RULE(tanh_rule, increasing(std::tanh, x), one + -square(f))
    CRAWLER_RULE(atan_rule, increasing(std::atan, x), inverse(one + square(x)))
    CRAWLER_RULE(asinh_rule, increasing(std::asinh, x), inverse_root(one + square(x)))
    CRAWLER_RULE(exp_rule, exponential(x), f)
    CRAWLER_RULE(log_rule, logarithm(x), x.lower > 0. ? inverse(x) : all)
    CRAWLER_RULE(log2_rule,
                 scaled(logarithm(x), std::numbers::log2e),
                 x.lower > 0. ? scaled(inverse(x), std::numbers::log2e) : all)
    CRAWLER_RULE(log10_rule,
                 scaled(logarithm(x), std::numbers::log10e),
                 x.lower > 0. ? scaled(inverse(x), std::numbers::log10e) : all)
    CRAWLER_RULE(sqrt_rule, root(x), scaled(inverse_root(x), 0.5))
    CRAWLER_RULE(negative_rule, -x, -one)
    CRAWLER_RULE(erf_rule, increasing(std::erf, x), scaled(exponential(-square(x)), 2. * std::numbers::inv_sqrtpi))
    CRAWLER_RULE(erfc_rule,
                 one + -increasing(std::erf, x),
                 scaled(exponential(-square(x)), -2. * std::numbers::inv_sqrtpi))
#undef CRAWLER_RULE

    Enclosure
    tan_rule(const Arguments arguments)
    {
      const Interval x = arguments[0].value, c = cosine(x);
      if (!(c.lower > 0. || c.upper < 0.))
        return anything;
      const Interval f = {std::tan(x.lower), std::tan(x.upper)};
      return {f, chain(one + square(f), arguments[0].rate)};
    }

    Enclosure
    asin_rule(const Arguments arguments)
    {
      const Interval x = arguments[0].value;
      return {{std::asin(std::max(x.lower, -1.)), std::asin(std::min(x.upper, 1.))},
              chain(inverse_root(one + -square(x)), arguments[0].rate)};
    }

    Enclosure
    acos_rule(const Arguments arguments)
    {
      const Enclosure f        = asin_rule(arguments);
      constexpr double quarter = 0.5 * std::numbers::pi;
      return {Interval{quarter, quarter} + -f.value, -f.rate};
    }

    Enclosure
    abs_rule(const Arguments arguments)
    {
      const Interval x = arguments[0].value, rate = arguments[0].rate;
      if (x.lower >= 0.)
        return {x, rate};
      if (x.upper <= 0.)
        return {-x, -rate};
      return {{0., std::max(-x.lower, x.upper)}, hull(rate, -rate)};
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
    plus_rule(const Arguments x)
    {
      return x[0] + x[1];
    }

    Enclosure
    minus_rule(const Arguments x)
    {
      return x[0] + -x[1];
    }

    Enclosure
    times_rule(const Arguments x)
    {
      if (x[0].number == x[1].number && x[0].number != Enclosure::no_number) // a square
        return {square(x[0].value), scaled(x[0].value * x[0].rate, 2.)};
      return {x[0].value * x[1].value, x[0].rate * x[1].value + x[0].value * x[1].rate};
    }

    Enclosure
    divide_rule(const Arguments x)
    {
      const Interval of_divisor = inverse(x[1].value), f = x[0].value * of_divisor;
      return {f, (x[0].rate + -chain(f, x[1].rate)) * of_divisor};
    }

    Enclosure
    power_rule(const Arguments x)
    {
      const Interval base = x[0].value;
      const double y      = x[1].value.lower;
      if (is_constant(x[1]) && y == std::rint(y) && std::abs(y) <= 64.)
      {
        const int n = static_cast<int>(y);
        return {integer_power(base, n),
                n == 0 ? Interval{0., 0.} : chain(scaled(integer_power(base, n - 1), y), x[0].rate)};
      }
      if (is_constant(x[1]) && base.lower >= 0.)
      {
        const auto power = [base](const double exponent) -> Interval {
          const double a = std::pow(base.lower, exponent), b = std::pow(base.upper, exponent);
          return {std::min(a, b), std::max(a, b)};
        };
        return {power(y), chain(scaled(power(y - 1.), y), x[0].rate)};
      }
      if (!(base.lower > 0.))
        return anything;
      const Interval of_base = logarithm(base), f = exponential(x[1].value * of_base);
      return {f, f * (x[1].rate * of_base + chain(x[1].value * inverse(base), x[0].rate))};
    }

    /// The value of something that jumps where its argument does not tell on which side it is. Jumps at a time are
    /// infinitely fast; those that depend on the place, too, move, and are looked for elsewhere.
    Enclosure
    jumping(const Interval value, const Arguments x)
    {
      const bool at_a_time = std::all_of(x.begin(), x.end(), [](const Enclosure &e) { return !e.on_s; });
      return {value, value.lower == value.upper || !at_a_time ? Interval{0., 0.} : all};
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
      if (!is_constant(x[1]) || !(x[1].value.lower > 0.))
        return anything;
      const double y = x[1].value.lower, first = std::floor(x[0].value.lower / y),
                   last = std::floor(x[0].value.upper / y);
      if (first == last)
        return {{x[0].value.lower - first * y, x[0].value.upper - first * y}, x[0].rate};
      const Enclosure jump = jumping({0., y}, x);
      return {jump.value, x[0].rate + jump.rate};
    }

    /// 1, 0 or either, from the difference of two values that is sometimes positive or not.
    Enclosure
    truth(const bool is_possible, const bool is_certain, const Arguments x)
    {
      return jumping({is_certain ? 1. : 0., is_possible ? 1. : 0.}, x);
    }

    Enclosure
    less_rule(const Arguments x)
    {
      return truth(x[0].value.lower < x[1].value.upper, x[0].value.upper < x[1].value.lower, x);
    }

    Enclosure
    less_equal_rule(const Arguments x)
    {
      return truth(x[0].value.lower <= x[1].value.upper, x[0].value.upper <= x[1].value.lower, x);
    }

    /// With its two arguments the other way round.
    template <Enclosure (*rule)(Arguments)>
    Enclosure
    turned(const Arguments x)
    {
      const Enclosure other_way[] = {x[1], x[0]};
      return rule(Arguments(other_way));
    }

    Enclosure
    equal_rule(const Arguments x)
    {
      const bool may_be = x[0].value.lower <= x[1].value.upper && x[1].value.lower <= x[0].value.upper;
      return truth(may_be, may_be && is_constant(x[0]) && is_constant(x[1]), x);
    }

    Enclosure
    not_equal_rule(const Arguments x)
    {
      const Interval same = equal_rule(x).value;
      return truth(same.lower == 0., same.upper == 0., x);
    }

    bool
    is_never_0(const Enclosure &x)
    {
      return x.value.lower > 0. || x.value.upper < 0.;
    }

    bool
    is_always_0(const Enclosure &x)
    {
      return x.value.lower == 0. && x.value.upper == 0.;
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
        f = {{std::min(f.value.lower, e.value.lower), std::min(f.value.upper, e.value.upper)},
             f.value.upper < e.value.lower   ? f.rate
             : e.value.upper < f.value.lower ? e.rate
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
      return {scaled(f.value, part), scaled(f.rate, part)};
    }

    Enclosure
    unknown_rule(const Arguments)
    {
      return anything;
    }
  } // namespace

  Bound
  bound_of(const std::string &operation)
  {
    static const std::map<std::string, Bound> rules = {
      {"sin", sin_rule},
      {"cos", cos_rule},
      {"tan", tan_rule},
      {"asin", asin_rule},
      {"acos", acos_rule},
      {"atan", atan_rule},
      {"sinh", sinh_rule},
      {"cosh", cosh_rule},
      {"tanh", tanh_rule},
      {"asinh", asinh_rule},
      {"acosh", unknown_rule},
      {"atanh", unknown_rule},
      {"log2", log2_rule},
      {"log10", log10_rule},
      {"log", log_rule},
      {"ln", log_rule},
      {"exp", exp_rule},
      {"sqrt", sqrt_rule},
      {"abs", abs_rule},
      {"-", negative_rule},
      {"erf", erf_rule},
      {"erfc", erfc_rule},
      {"atan2", unknown_rule},
      {"pow", power_rule},
      {"mod", modulo_rule},
      {"min", min_rule},
      {"max", max_rule},
      {"sum", sum_rule},
      {"avg", average_rule},
      {"?", select_rule},
      {"sign", step_rule<sign_of_number>},
      {"rint", step_rule<std::rint>},
      {"floor", step_rule<std::floor>},
      {"ceil", step_rule<std::ceil>},
      {"a+b", plus_rule},
      {"a-b", minus_rule},
      {"a*b", times_rule},
      {"a/b", divide_rule},
      {"a<b", less_rule},
      {"a<=b", less_equal_rule},
      {"a>b", turned<less_rule>},
      {"a>=b", turned<less_equal_rule>},
      {"a==b", equal_rule},
      {"a!=b", not_equal_rule},
      {"a&&b", and_rule},
      {"a||b", or_rule},
    };
    const auto found = rules.find(operation);
    if (found == rules.end())
      throw std::logic_error("no rule for enclosures of the function " + operation);
    return found->second;
  }
} // namespace crawler
