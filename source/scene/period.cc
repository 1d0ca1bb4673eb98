// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/scene/active_stress.h>
#include <crawler/scene/fast_changes.h>
#include <crawler/scene/period.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace crawler
{
  namespace
  {
    constexpr unsigned int few_times = 256, many_times = 1024, n_places = 5, n_random = 64;
    /// A change from one time to the next below this part of the largest |m| means that m is smooth on this grid.
    constexpr double smooth = 0.2;
    /// Two values are the same if they differ by less than this part of the largest |m|.
    constexpr double same = 1e-10;
    /// A start that takes a larger part of the duration is not looked behind.
    constexpr double longest_start = 0.25;

    class PeriodSearch
    {
    public:
      /// From @p begin to @p end_time.
      PeriodSearch(const ActiveStress &stress,
                   const double length,
                   const double begin,
                   const double end_time,
                   const unsigned int n_times)
        : owner_(stress)
        , length_(length)
        , begin_(begin)
        , end_(end_time)
        , T_(end_time - begin)
        , n_times_(n_times)
        , stress_(stress.at(places(length)))
        , grid_(n_times_ + 1)
      {
        for (unsigned int i = 0; i <= n_times_; ++i)
        {
          grid_[i] = at(begin_ + T_ * i / n_times_);
          for (const double value : grid_[i])
            largest_ = std::max(largest_, std::abs(value));
          if (i > 0)
            step_ = std::max(step_, difference(grid_[i - 1], grid_[i]));
        }
        mean_step_ = HUGE_VAL;
        mean_step_ = mismatch(1);
      }

      /// Multiples of a step of the grid that may be near a period: shifts by them change m as little as a shift by
      /// one step could, and less than their neighbours.
      std::vector<unsigned int>
      candidates(const double longest) const
      {
        const auto last = static_cast<unsigned int>(longest / T_ * n_times_);
        std::vector<double> mean(last + 2, 0.);
        for (unsigned int j = 1; j < mean.size(); ++j)
          mean[j] = mismatch(j);
        std::vector<unsigned int> list;
        for (unsigned int j = 2; j <= last; ++j)
          if (std::isfinite(mean[j]) && mean[j] <= mean[j - 1] && mean[j] <= mean[j + 1])
            list.push_back(j);
        return list;
      }

      bool
      is_steady() const
      {
        return step_ <= same * largest_;
      }
      bool
      is_smooth() const
      {
        return step_ <= smooth * largest_;
      }

      /// The smallest period near one of the candidates.
      std::optional<double>
      smallest(const std::vector<unsigned int> &candidates, const double longest)
      {
        constexpr std::size_t most_candidates = 64;
        for (std::size_t i = 0; i < std::min(candidates.size(), most_candidates); ++i)
          for (const double P : guesses(candidates[i]))
            if (P > 0. && P <= longest && is_period(P))
              return P;
        return std::nullopt;
      }

      /// At random times, at as many equally spaced ones as the grid has, and where m is faster than the grid shows.
      bool
      is_period(const double P)
      {
        std::mt19937 generator(20220610);
        const auto is_same_after = [&](const double t) { return difference(at(t), at(t + P)) <= same * largest_; };
        const double last        = T_ - P;
        for (unsigned int i = 0; i < n_random; ++i)
          if (!is_same_after(begin_ + static_cast<double>(generator()) / 4294967296. * last))
            return false;
        // Not where pulses may start and end: there round-off decides.
        for (unsigned int i = 0; i < n_times_; ++i)
          if (!is_same_after(begin_ + (i + 0.381966) / n_times_ * last))
            return false;
        const double known = step_ * n_times_ / T_;
        double largest     = largest_;
        for (const FastChange &change :
             find_fast_changes(
               owner_, length_, begin_, end_, [known](double, double) { return known; }, largest)
               .list)
          for (const double part : {0.27, 0.5, 0.81})
          {
            const double t = change.from + part * (change.to - change.from);
            if ((t + P <= end_ && !is_same_after(t)) || (t >= begin_ + P && !is_same_after(t - P)))
              return false;
          }
        return true;
      }

    private:
      using Values = std::array<double, n_places>;

      /// At both ends, and at places that no wave has its nodes at.
      static std::vector<double>
      places(const double length)
      {
        return {0., 0.1837 * length, 0.4142 * length, 0.7321 * length, length};
      }

      Values
      at(const double t)
      {
        Values m;
        stress_->values(t, m);
        return m;
      }

      static double
      difference(const Values &a, const Values &b)
      {
        double largest = 0.;
        for (unsigned int p = 0; p < n_places; ++p)
          largest = std::max(largest, std::abs(a[p] - b[p]));
        return largest;
      }

      /// The mean of |m(t + P) - m(t)| for P of j steps of the grid, which jumps spoil less than the largest value;
      /// infinite if it is much larger than that for one step.
      double
      mismatch(const unsigned int j) const
      {
        const double n = n_times_ + 1 - j, most = 2. * mean_step_ * n;
        double sum = 0.;
        for (unsigned int i = 0; i + j <= n_times_ && sum <= most; ++i)
          for (unsigned int p = 0; p < n_places; ++p)
            sum += std::abs(grid_[i + j][p] - grid_[i][p]);
        return sum <= most ? sum / n : HUGE_VAL;
      }

      /// What the period may be if it is near j steps of the grid.
      std::vector<double>
      guesses(const unsigned int j)
      {
        const double near = T_ * j / n_times_, around = T_ / n_times_;
        // A whole part of the duration, or the shortest decimal number; the only ways to find the period of pulses.
        std::vector<double> list = {end_ / std::round(end_ / near)};
        for (int digits = 1; digits < 8; ++digits)
        {
          const double decimal = std::stod(fmt::format("{:.{}e}", near, digits - 1));
          if (std::abs(decimal - near) <= around)
          {
            list.push_back(decimal);
            break;
          }
        }
        list.push_back(refined(near));
        return list;
      }

      /// The least squares of m(t + P) - m(t) by the Gauss-Newton method; where this does not converge, as if there is
      /// no period, @p near.
      double
      refined(const double near)
      {
        constexpr unsigned int most_iterations = 10, n = 8;
        const double around = 2. * T_ / n_times_, delta = 1e-6 * T_ / n_times_;
        double P = near, change_before = around;
        for (unsigned int iteration = 0; iteration < most_iterations; ++iteration)
        {
          double r_d = 0., d_d = 0.;
          for (unsigned int i = 0; i < n; ++i)
          {
            const double t   = begin_ + (i + 0.37) / n * (T_ - near - around);
            const Values now = at(t), later = at(t + P), before = at(t + P - delta), after = at(t + P + delta);
            for (unsigned int p = 0; p < n_places; ++p)
            {
              const double slope = (after[p] - before[p]) / (2. * delta);
              r_d += (later[p] - now[p]) * slope;
              d_d += slope * slope;
            }
          }
          const double change = r_d / d_d;
          if (!(std::abs(P - change - near) <= around) || (iteration > 2 && std::abs(change) > 0.5 * change_before))
            return std::abs(change) <= 1e-12 * P ? P : near;
          P -= change;
          change_before = std::abs(change);
          if (std::abs(change) <= 1e-15 * P)
            break;
        }
        return P;
      }

      const ActiveStress &owner_;
      const double length_;
      const double begin_, end_, T_; ///< times, and how long it is between them
      const unsigned int n_times_;
      const std::unique_ptr<ActiveStressAtPoints> stress_;
      std::vector<Values> grid_;
      double largest_ = 0., step_ = 0., mean_step_ = 0.; ///< |m|; change over a step of the grid
    };
  } // namespace

  namespace
  {
    std::optional<double>
    find_period(const ActiveStress &stress, const double length, const double begin, const double end_time)
    {
      const double longest = (end_time - begin) / 2.;
      const PeriodSearch coarse(stress, length, begin, end_time, few_times);
      if (coarse.is_smooth() && (coarse.is_steady() || coarse.candidates(longest).empty()))
        return std::nullopt;
      PeriodSearch fine(stress, length, begin, end_time, many_times);
      return fine.is_steady() ? std::nullopt : fine.smallest(fine.candidates(longest), longest);
    }
  } // namespace

  std::optional<ActiveStress::Repetition>
  find_repetition(const ActiveStress &stress, const double length, const double end_time)
  {
    if (const auto P = find_period(stress, length, 0., end_time))
      return ActiveStress::Repetition{*P, 0.};
    const auto P = find_period(stress, length, longest_start * end_time, end_time);
    if (!P)
      return std::nullopt;
    double from = longest_start * end_time;
    while (from / 2. > *P / 2. && PeriodSearch(stress, length, from / 2., end_time, many_times).is_period(*P))
      from /= 2.;
    return ActiveStress::Repetition{*P, from};
  }

  std::optional<double>
  common_period(const std::vector<double> &periods)
  {
    constexpr double largest = 1000., tolerance = 1e-10;
    double common = periods.front();
    for (const double P : periods)
    {
      // The convergents p/q of the ratio's continued fraction.
      const double ratio = common / P;
      double rest = ratio, p = std::floor(ratio), q = 1., p_before = 1., q_before = 0.;
      while (std::abs(ratio - p / q) > tolerance * ratio)
      {
        rest = 1. / (rest - std::floor(rest));
        if (!(std::max(p, q) <= largest) || !std::isfinite(rest))
          return std::nullopt;
        const double digit = std::floor(rest), p_next = digit * p + p_before, q_next = digit * q + q_before;
        p_before = p;
        q_before = q;
        p        = p_next;
        q        = q_next;
      }
      if (std::max(p, q) > largest)
        return std::nullopt;
      common *= q; // q times the one is p times the other
    }
    return common;
  }

  double
  shortest_period(const ActiveStress &stress, const double length, const double period, const double from)
  {
    constexpr unsigned int n         = 256;
    const std::vector<double> points = {0., 0.1837 * length, 0.4142 * length, 0.7321 * length, length};
    const auto at                    = stress.at(points);
    std::vector<double> now(points.size()), later(points.size());
    double largest           = 0.;
    const auto repeats_after = [&](const double P) {
      for (unsigned int i = 0; i < n; ++i)
      {
        const double t = from + (i + 0.381966) / n * period;
        at->values(t, now);
        at->values(t + P, later);
        for (std::size_t p = 0; p < points.size(); ++p)
          if (!(std::abs(later[p] - now[p]) <= same * largest))
            return false;
      }
      return true;
    };
    for (unsigned int i = 0; i < n; ++i)
    {
      at->values(from + (i + 0.381966) / n * period, now);
      for (std::size_t p = 0; p < points.size(); ++p)
        largest = std::max(largest, std::abs(now[p]));
    }
    constexpr unsigned int most = 10; // times each factor
    double shortest             = period;
    for (const unsigned int factor : {2, 3, 5, 7})
      for (unsigned int i = 0; i < most && repeats_after(shortest / factor); ++i)
        shortest /= factor;
    return shortest;
  }
} // namespace crawler
