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
    using Bound     = FormulaOperation::Bound;
    using Arguments = std::span<const Enclosure>;

    const Enclosure anything{Interval::whole(), Interval::whole()};

    Interval
    inverse(const Interval &a)
    {
      return zero_in(a) ? Interval::whole() : 1. / a;
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

    /// 1/sqrt(x)
    Interval
    inverse_root(const Interval &x)
    {
      const Interval r = sqrt(x);
      return {1. / r.upper(), r.lower() > 0. ? 1. / r.lower() : std::numeric_limits<double>::infinity()};
    }

    Interval
    whole_power(const Interval &x, const int n)
    {
      return n < 0 ? inverse(pow(x, -n)) : n > 0 ? pow(x, n) : 1.;
    }

    // Rules: value and rate of the result from those of the arguments.

#define CRAWLER_RULE(name, value_of, derivative)            \
  Enclosure name(const Arguments arguments)                 \
  {                                                         \
    const Interval x                  = arguments[0].value; \
    [[maybe_unused]] const Interval f = value_of;           \
    return {f, chain(derivative, arguments[0].rate)};       \
  }
    CRAWLER_RULE(sin_rule, sin(x), cos(x))
    CRAWLER_RULE(cos_rule, cos(x), -sin(x))
    CRAWLER_RULE(tan_rule, tan(x), 1. + square(f))
    CRAWLER_RULE(asin_rule, asin(x), inverse_root(1. - square(x)))
    CRAWLER_RULE(acos_rule, acos(x), -inverse_root(1. - square(x)))
    CRAWLER_RULE(sinh_rule, sinh(x), cosh(x))
    CRAWLER_RULE(cosh_rule, cosh(x), sinh(x))
    CRAWLER_RULE(tanh_rule, tanh(x), 1. - square(f))
    CRAWLER_RULE(atan_rule, atan(x), inverse(1. + square(x)))
    CRAWLER_RULE(asinh_rule, increasing(std::asinh, x), inverse_root(1. + square(x)))
    CRAWLER_RULE(exp_rule, exp(x), f)
    CRAWLER_RULE(log_rule, log(x), inverse(x))
    CRAWLER_RULE(log2_rule, std::numbers::log2e *log(x), std::numbers::log2e *inverse(x))
    CRAWLER_RULE(log10_rule, std::numbers::log10e *log(x), std::numbers::log10e *inverse(x))
    CRAWLER_RULE(sqrt_rule, sqrt(x), 0.5 * inverse_root(x))
    CRAWLER_RULE(negative_rule, -x, -1.)
    CRAWLER_RULE(erf_rule, increasing(std::erf, x), 2. * std::numbers::inv_sqrtpi * exp(-square(x)))
    CRAWLER_RULE(erfc_rule, 1. - increasing(std::erf, x), -2. * std::numbers::inv_sqrtpi * exp(-square(x)))
#undef CRAWLER_RULE

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
        return {square(x[0].value), 2. * x[0].value * x[0].rate};
      return {x[0].value * x[1].value, x[0].rate * x[1].value + x[0].value * x[1].rate};
    }

    Enclosure
    divide_rule(const Arguments x)
    {
      const Interval of_divisor = inverse(x[1].value), f = x[0].value * of_divisor;
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
      return {f, f * (x[1].rate * of_base + chain(x[1].value * inverse(base), x[0].rate))};
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
      {"a<b", comparison<poslt, cerlt>},
      {"a<=b", comparison<posle, cerle>},
      {"a>b", comparison<posgt, cergt>},
      {"a>=b", comparison<posge, cerge>},
      {"a==b", comparison<poseq, cereq>},
      {"a!=b", comparison<posne, cerne>},
      {"a&&b", and_rule},
      {"a||b", or_rule},
    };
    const auto found = rules.find(operation);
    if (found == rules.end())
      throw std::logic_error("no rule for enclosures of the function " + operation);
    return found->second;
  }

  Bound
  side_of(const std::string &operation)
  {
    static const std::map<std::string, Bound> rules = {{"abs", step_rule<sign_of_number>},
                                                       {"min", number_of_least},
                                                       {"max", number_of_largest},
                                                       {"mod", number_of_period}};
    const auto found                                = rules.find(operation);
    if (found != rules.end())
      return found->second;
    return tangent_of(operation) == nullptr ? bound_of(operation) : nullptr;
  }
} // namespace crawler
