// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/pack.h>

namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// p-model of friction with gamma = 1, g = w^a: by products where a is a small integer. Each lane is computed in the
  /// same way whatever the others are.
  template <typename Pack>
  struct LaneFriction
  {
    using Mask = typename PackTraits<Pack>::Mask;

    Pack a{};
    static constexpr int max_bits = 4;
    Mask whole, negative, bits[max_bits]; ///< |a| is an integer, a < 0; binary digits of |a|
    bool any_whole, any_other;
    int n_bits;

    /// Sets the exponent of a lane, and sorts them all.
    void
    set(const int lane, const double own)
    {
      set_lane(a, lane, own);
      any_whole           = false;
      any_other           = false;
      n_bits              = 0;
      constexpr int bound = (1 << max_bits) - 1;
      Pack is_whole{}, is_negative{}, has_bit[max_bits] = {};
      for (int l = 0; l < PackTraits<Pack>::size; ++l)
      {
        const double exponent = get_lane(a, l), size = exponent < 0. ? -exponent : exponent;
        const bool is = size <= bound && size == static_cast<int>(size);
        set_lane(is_whole, l, is);
        set_lane(is_negative, l, exponent < 0.);
        any_whole = any_whole || is;
        any_other = any_other || !is;
        for (int b = 0; b < max_bits; ++b)
          if (is && (static_cast<int>(size) >> b & 1) != 0)
          {
            set_lane(has_bit[b], l, 1.);
            n_bits = b + 1 > n_bits ? b + 1 : n_bits;
          }
      }
      whole    = is_whole > 0.;
      negative = is_negative > 0.;
      for (int b = 0; b < max_bits; ++b)
        bits[b] = has_bit[b] > 0.;
    }

    void
    operator()(const Pack *w, Pack *g, const int n) const
    {
      if (any_other)
        power_at_points(w, a, g, n);
      if (any_whole)
        for (int p = 0; p < n; ++p)
        {
          Pack by_products = broadcast<Pack>(1.), x = negative ? 1. / w[p] : w[p];
          for (int b = 0; b < n_bits; ++b, x *= x)
            by_products *= bits[b] ? x : broadcast<Pack>(1.);
          g[p] = any_other ? (whole ? by_products : g[p]) : by_products;
        }
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
