/* SPDX-License-Identifier: LGPL-2.1-or-later */
#pragma once

/**
 * What the program uses of the C++20 library and Debian 12's emscripten does not have yet (libc++ 13): algorithms on
 * ranges with projections, std::from_chars for numbers, the order of vectors, and Legendre polynomials.
 */
#ifdef __cplusplus
#  include <version>
#  if defined(_LIBCPP_VERSION) && _LIBCPP_VERSION < 15000
#    include <algorithm>
#    include <charconv>
#    include <compare>
#    include <cstdlib>
#    include <functional>
#    include <iterator>
#    include <string>
#    include <vector>

namespace std
{
  inline from_chars_result
  from_chars(const char *first, const char *last, double &value)
  {
    const string text(first, last);
    char *end           = nullptr;
    const double number = strtod(text.c_str(), &end);
    if (end == text.c_str())
      return {first, errc::invalid_argument};
    value = number;
    return {first + (end - text.c_str()), errc()};
  }

  inline partial_ordering
  operator<=>(const vector<double> &a, const vector<double> &b)
  {
    for (size_t i = 0; i < a.size() && i < b.size(); ++i)
      if (const partial_ordering order = a[i] <=> b[i]; order != 0)
        return order;
    return a.size() <=> b.size();
  }

  /// P_n(x)
  inline double
  legendre(const unsigned int n, const double x)
  {
    double before = 0., value = 1.;
    for (unsigned int k = 1; k <= n; ++k)
    {
      const double next = k == 1 ? x : 2. * x * value - before - (x * value - before) / k;
      before            = value;
      value             = next;
    }
    return value;
  }

  namespace ranges
  {
    struct Itself
    {
      template <typename X>
      constexpr X &&
      operator()(X &&x) const noexcept
      {
        return std::forward<X>(x);
      }
    };

    template <typename Predicate, typename Projection>
    auto
    after_projection(Predicate &predicate, Projection &projection)
    {
      return [&](auto &&...x) -> decltype(auto) {
        return std::invoke(predicate, std::invoke(projection, std::forward<decltype(x)>(x))...);
      };
    }

#    define CRAWLER_WITH_PREDICATE(name)                                                               \
      template <typename Range, typename Predicate, typename Projection = Itself>                      \
      auto name(Range &&range, Predicate predicate, Projection projection = {})                        \
      {                                                                                                \
        return std::name(std::begin(range), std::end(range), after_projection(predicate, projection)); \
      }
    CRAWLER_WITH_PREDICATE(all_of)
    CRAWLER_WITH_PREDICATE(any_of)
    CRAWLER_WITH_PREDICATE(none_of)
    CRAWLER_WITH_PREDICATE(find_if)
    CRAWLER_WITH_PREDICATE(count_if)
#    undef CRAWLER_WITH_PREDICATE

#    define CRAWLER_WITH_ORDER(name)                                                               \
      template <typename Range, typename Order = std::less<>, typename Projection = Itself>        \
      auto name(Range &&range, Order order = {}, Projection projection = {})                       \
      {                                                                                            \
        return std::name(std::begin(range), std::end(range), after_projection(order, projection)); \
      }
    CRAWLER_WITH_ORDER(min_element)
    CRAWLER_WITH_ORDER(max_element)
    CRAWLER_WITH_ORDER(sort)
    CRAWLER_WITH_ORDER(stable_sort)
    CRAWLER_WITH_ORDER(is_sorted)
#    undef CRAWLER_WITH_ORDER

    template <typename First, typename Second, typename Relation>
    bool
    equal(First &&first, Second &&second, Relation relation)
    {
      return std::equal(first.begin(), first.end(), second.begin(), second.end(), relation);
    }

    template <typename Range, typename Value, typename Projection = Itself>
    auto
    find(Range &&range, const Value &value, Projection projection = {})
    {
      return std::find_if(
        std::begin(range), std::end(range), [&](const auto &x) { return std::invoke(projection, x) == value; });
    }
    template <typename Range, typename Value, typename Projection = Itself>
    auto
    count(Range &&range, const Value &value, Projection projection = {})
    {
      return std::count_if(
        std::begin(range), std::end(range), [&](const auto &x) { return std::invoke(projection, x) == value; });
    }
    template <typename Range, typename Value, typename Order = std::less<>, typename Projection = Itself>
    auto
    upper_bound(Range &&range, const Value &value, Order order = {}, Projection projection = {})
    {
      return std::upper_bound(std::begin(range), std::end(range), value, [&](const auto &bound, const auto &x) {
        return std::invoke(order, bound, std::invoke(projection, x));
      });
    }
    template <typename Range>
    void
    reverse(Range &&range)
    {
      std::reverse(std::begin(range), std::end(range));
    }
    template <typename Range, typename Value>
    void
    fill(Range &&range, const Value &value)
    {
      std::fill(std::begin(range), std::end(range), value);
    }
    template <typename Range, typename Out>
    void
    copy(Range &&range, Out out)
    {
      std::copy(std::begin(range), std::end(range), out);
    }
    template <typename Range, typename Out, typename Predicate>
    void
    copy_if(Range &&range, Out out, Predicate predicate)
    {
      std::copy_if(std::begin(range), std::end(range), out, predicate);
    }
    template <typename Range, typename Out, typename Function>
    void
    transform(Range &&range, Out out, Function function)
    {
      std::transform(std::begin(range), std::end(range), out, function);
    }
  } // namespace ranges
} // namespace std
#  endif
#endif
