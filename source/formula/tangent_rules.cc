// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/formula/operation_rules.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <stdexcept>

namespace crawler
{
  namespace
  {
    using Tangent = FormulaOperation::Tangent;
    using Numbers = std::span<const double *const>;

    /// Tangent of a function of one argument x with the value f, by f'(x).
    template <auto derivative>
    void
    chain(const Numbers x, const Numbers dx, const double *f, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        df[i] = dx[0][i] == 0. ? 0. : derivative(x[0][i], f[i]) * dx[0][i];
    }

    void
    plus(const Numbers, const Numbers dx, const double *, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        df[i] = dx[0][i] + dx[1][i];
    }

    void
    minus(const Numbers, const Numbers dx, const double *, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        df[i] = dx[0][i] - dx[1][i];
    }

    void
    times(const Numbers x, const Numbers dx, const double *, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        df[i] = dx[0][i] * x[1][i] + x[0][i] * dx[1][i];
    }

    void
    divide(const Numbers x, const Numbers dx, const double *f, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        df[i] = (dx[0][i] - f[i] * dx[1][i]) / x[1][i];
    }

    /// Tangent of x^y. Terms of a constant base or exponent are left out, so that (-1)^2 and 0^2 have a derivative.
    void
    power(const Numbers x, const Numbers dx, const double *f, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        df[i] = (dx[0][i] == 0. ? 0. : x[1][i] * std::pow(x[0][i], x[1][i] - 1.) * dx[0][i]) +
                (dx[1][i] == 0. ? 0. : f[i] * std::log(x[0][i]) * dx[1][i]);
    }

    /// x - y floor(x/y)
    void
    modulo(const Numbers x, const Numbers dx, const double *, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        df[i] = dx[0][i] - dx[1][i] * std::floor(x[0][i] / x[1][i]);
    }

    void
    arc_tangent_of_two(const Numbers x, const Numbers dx, const double *, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        df[i] = (x[1][i] * dx[0][i] - x[0][i] * dx[1][i]) / (x[0][i] * x[0][i] + x[1][i] * x[1][i]);
    }

    void
    select(const Numbers x, const Numbers dx, const double *, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        df[i] = x[0][i] != 0. ? dx[1][i] : dx[2][i];
    }

    /// Tangent of the smallest or largest argument: that of the argument equal to the result.
    void
    extreme(const Numbers x, const Numbers dx, const double *f, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = x.size(); j-- > 0;)
          if (x[j][i] == f[i])
            df[i] = dx[j][i];
    }

    void
    sum(const Numbers x, const Numbers dx, const double *, double *df, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
      {
        df[i] = 0.;
        for (std::size_t j = 0; j < x.size(); ++j)
          df[i] += dx[j][i];
      }
    }

    void
    average(const Numbers x, const Numbers dx, const double *f, double *df, const std::size_t n)
    {
      sum(x, dx, f, df, n);
      for (std::size_t i = 0; i < n; ++i)
        df[i] /= static_cast<double>(x.size());
    }

    const double gauss = 2. * std::numbers::inv_sqrtpi; // erf'(x) = gauss exp(-x^2)

#define CRAWLER_DERIVATIVE(expression) \
  chain<[]([[maybe_unused]] const double x, [[maybe_unused]] const double f) { return expression; }>
    const std::map<std::string, Tangent> &
    tangents()
    {
      static const std::map<std::string, Tangent> list = {
        {"sin", CRAWLER_DERIVATIVE(std::cos(x))},
        {"cos", CRAWLER_DERIVATIVE(-std::sin(x))},
        {"tan", CRAWLER_DERIVATIVE(1. + f * f)},
        {"asin", CRAWLER_DERIVATIVE(1. / std::sqrt(1. - x * x))},
        {"acos", CRAWLER_DERIVATIVE(-1. / std::sqrt(1. - x * x))},
        {"atan", CRAWLER_DERIVATIVE(1. / (1. + x * x))},
        {"sinh", CRAWLER_DERIVATIVE(std::cosh(x))},
        {"cosh", CRAWLER_DERIVATIVE(std::sinh(x))},
        {"tanh", CRAWLER_DERIVATIVE(1. - f * f)},
        {"asinh", CRAWLER_DERIVATIVE(1. / std::sqrt(x * x + 1.))},
        {"acosh", CRAWLER_DERIVATIVE(1. / std::sqrt(x * x - 1.))},
        {"atanh", CRAWLER_DERIVATIVE(1. / (1. - x * x))},
        {"log2", CRAWLER_DERIVATIVE(std::numbers::log2e / x)},
        {"log10", CRAWLER_DERIVATIVE(std::numbers::log10e / x)},
        {"log", CRAWLER_DERIVATIVE(1. / x)},
        {"ln", CRAWLER_DERIVATIVE(1. / x)},
        {"exp", CRAWLER_DERIVATIVE(f)},
        {"sqrt", CRAWLER_DERIVATIVE(0.5 / f)},
        {"abs", CRAWLER_DERIVATIVE(x < 0. ? -1. : 1.)},
        {"-", CRAWLER_DERIVATIVE(-1.)},
        {"erf", CRAWLER_DERIVATIVE(gauss * std::exp(-x * x))},
        {"erfc", CRAWLER_DERIVATIVE(-gauss * std::exp(-x * x))},
        {"atan2", arc_tangent_of_two},
        {"pow", power},
        {"mod", modulo},
        {"min", extreme},
        {"max", extreme},
        {"sum", sum},
        {"avg", average},
        {"?", select},
        {"a+b", plus},
        {"a-b", minus},
        {"a*b", times},
        {"a/b", divide},
        {"sign", nullptr},
        {"rint", nullptr},
        {"floor", nullptr},
        {"ceil", nullptr},
        {"a<b", nullptr},
        {"a<=b", nullptr},
        {"a>b", nullptr},
        {"a>=b", nullptr},
        {"a==b", nullptr},
        {"a!=b", nullptr},
        {"a&&b", nullptr},
        {"a||b", nullptr},
      };
      return list;
    }
#undef CRAWLER_DERIVATIVE
  } // namespace

  Tangent
  tangent_of(const std::string &operation)
  {
    const auto found = tangents().find(operation);
    if (found == tangents().end())
      throw std::logic_error("no rule of differentiation for the function " + operation);
    return found->second;
  }
} // namespace crawler
