// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/instruction_set.h>

#include <cmath>

/**
 * Packs: numbers of several bodies side by side, by GCC's vector types (clang has them too) with + - * / and
 * comparisons, and the operations that these lack. A plain double is a pack of one.
 */
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  using pack2 = double __attribute__((vector_size(16)));
  using pack4 = double __attribute__((vector_size(32)));
  using pack8 = double __attribute__((vector_size(64)));

  template <typename Pack>
  struct PackTraits
  {
    static constexpr int size = sizeof(Pack) / sizeof(double);
    using Mask                = decltype(Pack{} < Pack{});
  };

  template <typename Pack>
  inline double
  get_lane(const Pack &pack, const int l)
  {
    if constexpr (PackTraits<Pack>::size == 1)
      return pack;
    else
      return pack[l];
  }

  template <typename Pack>
  inline void
  set_lane(Pack &pack, const int l, const double value)
  {
    if constexpr (PackTraits<Pack>::size == 1)
      pack = value;
    else
      pack[l] = value;
  }

  template <typename Pack>
  inline Pack
  broadcast(const double value)
  {
    return Pack{} + value;
  }

  /// Returns b if they cannot be compared.
  template <typename Pack>
  inline Pack
  smaller(const Pack &a, const Pack &b)
  {
    return a < b ? a : b;
  }

#ifdef __x86_64__
  // Vector variants of functions of the C library (libmvec, x86-64 vector function ABI).
  extern "C"
  {
    pack2 _ZGVbN2v_exp(pack2);
    pack2 _ZGVbN2v_log(pack2);
#  ifdef __AVX2__
    pack4 _ZGVdN4v_exp(pack4);
    pack4 _ZGVdN4v_log(pack4);
#  endif
#  ifdef __AVX512F__
    pack8 _ZGVeN8v_exp(pack8);
    pack8 _ZGVeN8v_log(pack8);
#  endif
  }
#endif

  template <typename Pack>
  inline Pack
  exponential(const Pack &x)
  {
#ifdef __x86_64__
    if constexpr (PackTraits<Pack>::size == 2)
      return _ZGVbN2v_exp(x);
#  ifdef __AVX2__
    if constexpr (PackTraits<Pack>::size == 4)
      return _ZGVdN4v_exp(x);
#  endif
#  ifdef __AVX512F__
    if constexpr (PackTraits<Pack>::size == 8)
      return _ZGVeN8v_exp(x);
#  endif
#endif
    Pack result{};
    for (int l = 0; l < PackTraits<Pack>::size; ++l)
      set_lane(result, l, ::exp(get_lane(x, l)));
    return result;
  }

  template <typename Pack>
  inline Pack
  logarithm(const Pack &x)
  {
#ifdef __x86_64__
    if constexpr (PackTraits<Pack>::size == 2)
      return _ZGVbN2v_log(x);
#  ifdef __AVX2__
    if constexpr (PackTraits<Pack>::size == 4)
      return _ZGVdN4v_log(x);
#  endif
#  ifdef __AVX512F__
    if constexpr (PackTraits<Pack>::size == 8)
      return _ZGVeN8v_log(x);
#  endif
#endif
    Pack result{};
    for (int l = 0; l < PackTraits<Pack>::size; ++l)
      set_lane(result, l, ::log(get_lane(x, l)));
    return result;
  }

  /// Applies @p function to x and y at n points, for any pack. For one body the points take the place of lanes, so that
  /// its values are those of a batch to the last bit.
  template <typename Pack, typename Function>
  inline void
  at_points(const Function &function, const Pack *x, const Pack &y, Pack *result, const int n)
  {
    if constexpr (PackTraits<Pack>::size == 1)
    {
      using Points        = CRAWLER_PACK;
      constexpr int width = PackTraits<Points>::size;
      for (int i = 0; i < n; i += width)
      {
        auto some = broadcast<Points>(1.);
        for (int j = 0; j < width && i + j < n; ++j)
          some[j] = x[i + j];
        some = function(some, broadcast<Points>(y));
        for (int j = 0; j < width && i + j < n; ++j)
          result[i + j] = some[j];
      }
    }
    else
      for (int i = 0; i < n; ++i)
        result[i] = function(x[i], y);
  }

  /// Power x^y = exp(y log x) at n points, x > 0: half the cost of pow, without its last digits if y log x is large.
  template <typename Pack>
  inline void
  power_at_points(const Pack *x, const Pack &y, Pack *result, const int n)
  {
    at_points(
      [](const auto &base, const auto &exponent) { return exponential(exponent * logarithm(base)); }, x, y, result, n);
  }

  /// tanh(x/y) at n points.
  template <typename Pack>
  inline void
  tanh_at_points(const Pack *x, const Pack &y, Pack *result, const int n)
  {
    const auto function = [](const auto &numerator, const auto &denominator) {
      constexpr double far = 20.; // tanh is 1 to the last bit
      const auto ratio = numerator / denominator, none = ratio - ratio;
      const auto inside = ratio < -far ? none - far : ratio > far ? none + far : ratio;
      return 1. - 2. / (exponential(2. * inside) + 1.);
    };
    at_points(function, x, y, result, n);
  }

  /// Complex number in each lane; without the checks for infinities of std::complex.
  template <typename Pack>
  struct Complex
  {
    Pack re, im;
  };

  template <typename Pack>
  inline Complex<Pack>
  operator*(const Complex<Pack> &a, const Complex<Pack> &b)
  {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  template <typename Pack>
  inline Complex<Pack>
  operator+(const Complex<Pack> &a, const Complex<Pack> &b)
  {
    return {a.re + b.re, a.im + b.im};
  }
  template <typename Pack>
  inline void
  operator-=(Complex<Pack> &a, const Complex<Pack> &b)
  {
    a = {a.re - b.re, a.im - b.im};
  }
  template <typename Pack>
  inline void
  operator+=(Complex<Pack> &a, const Complex<Pack> &b)
  {
    a = {a.re + b.re, a.im + b.im};
  }
  template <typename Pack>
  inline void
  operator*=(Complex<Pack> &a, const Complex<Pack> &b)
  {
    a = a * b;
  }
  /// Quotient one/b, for one = 1.
  template <typename Pack>
  inline Complex<Pack>
  operator/(const double one, const Complex<Pack> &b)
  {
    const Pack scale = one / (b.re * b.re + b.im * b.im);
    return {b.re * scale, -b.im * scale};
  }
} // namespace crawler::CRAWLER_INSTRUCTION_SET
