// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/scene/active_stress.h>
#include <crawler/scene/breaks.h>
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
    constexpr unsigned int few_times = 256, many_times = 1024, n_random = 64;
    /// Largest change of m between neighbouring times, relative to the largest |m|, with which m counts as smooth on
    /// this grid.
    constexpr double smooth = 0.2;
    /// Difference below which two values are equal, relative to the largest |m|.
    constexpr double same = 1e-10;
    /// Fractions of the duration after which m may repeat. A start is often shorter than the first of them.
    constexpr double first_start = 0.25, starts[] = {0., first_start, 0.5, 0.75};

    /// The active stress at both ends, and at places where no wave has its nodes.
    class StressAtPlaces
    {
    public:
      static constexpr unsigned int n = 5;
      using Values                    = std::array<double, n>;

      StressAtPlaces(const ActiveStress &stress, const double length)
        : stress_(stress.at({0., 0.1837 * length, 0.4142 * length, 0.7321 * length, length}))
      {
      }

      Values
      at(const double t)
      {
        Values m;
        stress_->values(t, m);
        return m;
      }

      static double
      size(const Values &m)
      {
        return difference(m, Values{});
      }

      static double
      difference(const Values &a, const Values &b)
      {
        double largest = 0.;
        for (unsigned int p = 0; p < n; ++p)
          largest = std::max(largest, std::abs(a[p] - b[p]));
        return largest;
      }

    private:
      const std::unique_ptr<ActiveStressAtPoints> stress_;
    };

    /// Tests whether an active stress repeats after a time P, throughout from @p begin to @p end_time.
    class PeriodTest
    {
    public:
      PeriodTest(const ActiveStress &stress, const double length, const double begin, const double end_time)
        : stress_(stress)
        , length_(length)
        , begin_(begin)
        , end_(end_time)
        , m_(stress, length)
      {
      }

      /// Notes that |m| reaches this value somewhere.
      void
      knows(const double largest)
      {
        largest_ = std::max(largest_, largest);
      }

      /// Tests at random times, at times where m is faster than in a period, and at many times in each period. Fails if
      /// there are too many fast changes to check, and once max_misses times P have passed only the random test.
      bool
      holds(const double P)
      {
        if (n_misses_ >= max_misses)
          return false;
        std::mt19937 generator(20220610);
        const double last = end_ - begin_ - P;
        knows(largest_in_first(P));
        for (unsigned int i = 0; i < n_random; ++i)
          if (!is_same_after(begin_ + static_cast<double>(generator()) / 4294967296. * last, P))
            return false;
        const bool repeats = pieces_repeat(P) &&
                             (!stress_.bounds({0., length_, begin_, end_}) || fast_changes_repeat(P)) &&
                             all_periods_are_the_same(P);
        if (!repeats)
          ++n_misses_;
        return repeats;
      }

    private:
      bool
      is_same_after(const double t, const double P)
      {
        return StressAtPlaces::difference(m_.at(t), m_.at(t + P)) <= same * largest_;
      }

      /// True if m is the same P later and P earlier, as far as these are within the time.
      bool
      is_same_beside(const double t, const double P)
      {
        return (t + P > end_ || is_same_after(t, P)) && (t - P < begin_ || is_same_after(t - P, P));
      }

      /// True if m is the same after P between all breaks in time, however close these are: bounds leave out its jumps.
      bool
      pieces_repeat(const double P)
      {
        std::vector<double> ends = stress_.breaks_in_time();
        ends.insert(ends.end(), {begin_, end_});
        std::ranges::sort(ends);
        for (std::size_t i = 1; i < ends.size(); ++i)
        {
          const double t = std::lerp(ends[i - 1], ends[i], 0.381966);
          if (t <= begin_ || t >= end_ || ends[i] - ends[i - 1] < 4. * min_time_between_breaks * end_)
            continue;
          if (!is_same_beside(t, P))
            return false;
        }
        return true;
      }

      bool
      all_periods_are_the_same(const double P)
      {
        constexpr double in_period = 16.18, most = 65536.; // irrational: different times of each
        const double last = end_ - begin_ - P;
        const auto n =
          static_cast<unsigned int>(std::clamp(in_period * last / P, static_cast<double>(many_times), most));
        // Times at which pulses may start and end are avoided: there round-off decides.
        for (unsigned int i = 0; i < n; ++i)
          if (!is_same_after(begin_ + (i + 0.381966) / n * last, P))
            return false;
        return true;
      }

      double
      largest_in_first(const double P)
      {
        double largest = 0.;
        for (unsigned int i = 0; i < n_random; ++i)
          largest = std::max(largest, StressAtPlaces::size(m_.at(begin_ + (i + 0.381966) / n_random * P)));
        return largest;
      }

      /// Bound of |m_t| in the period that begins at @p from, without the parts of it where m jumps.
      double
      rate_in_period(const double from, const double P) const
      {
        const auto bound = [&](const double start, const double end) {
          return stress_.bounds({0., length_, from + start * P, from + end * P})->rate;
        };
        if (const double rate = bound(0., 1.); std::isfinite(rate))
          return rate;
        constexpr unsigned int n_parts = 64;
        double largest                 = 0.;
        for (unsigned int i = 0; i < n_parts; ++i)
          if (const double rate = bound(1. * i / n_parts, (i + 1.) / n_parts); std::isfinite(rate))
            largest = std::max(largest, rate);
        return largest;
      }

      /// Smallest of these bounds for the first, a middle and the last period: an event may be in one of them.
      double
      rate_in_period(const double P) const
      {
        const double later = std::floor((end_ - begin_) / P * (1. + 1e-12)) - 1.;
        double least       = HUGE_VAL;
        for (const double period : {0., std::floor(later / 2.), later})
          least = std::min(least, rate_in_period(begin_ + period * P, P));
        return least;
      }

      bool
      fast_changes_repeat(const double P)
      {
        constexpr unsigned int max_bounds = 200000;
        constexpr double round_off = 1e-6, times_in_change = 8., min_times = 3., max_times = 1024.;
        const double explained    = rate_in_period(P) * (1. + round_off);
        double largest            = largest_;
        const FastChanges changes = find_fast_changes(
          stress_, length_, begin_, end_, [=](double, double) { return explained; }, largest, {max_bounds, same});
        for (const FastChange &change : changes.list)
        {
          // Times beside the change are included: m differs after a jump.
          const double time = 3. * (change.to - change.from), from = change.from - time / 3.;
          const auto n = static_cast<unsigned int>(
            std::ceil(std::clamp(times_in_change * time * change.rate / largest, min_times, max_times)));
          for (unsigned int i = 0; i < n; ++i)
          {
            const double t = std::clamp(from + (i + 0.381966) / n * time, begin_, end_);
            if (!is_same_beside(t, P))
              return false;
          }
        }
        if (!changes.is_complete)
          n_misses_ = max_misses;
        return changes.is_complete;
      }

      const ActiveStress &stress_;
      const double length_, begin_, end_;
      StressAtPlaces m_;
      double largest_                          = 0.; ///< |m|
      unsigned int n_misses_                   = 0;  ///< times P that passed only the random test
      static constexpr unsigned int max_misses = 2;
    };

    /// Searches a period by comparing the samples of a grid.
    class PeriodSearch
    {
    public:
      /// Samples from @p begin to @p end, in a run until @p end_time.
      PeriodSearch(const ActiveStress &stress,
                   const double length,
                   const double begin,
                   const double end,
                   const unsigned int n_times,
                   const double end_time)
        : m_(stress, length)
        , begin_(begin)
        , T_(end - begin)
        , end_time_(end_time)
        , n_times_(n_times)
        , grid_(n_times_ + 1)
      {
        for (unsigned int i = 0; i <= n_times_; ++i)
        {
          grid_[i] = m_.at(begin_ + T_ * i / n_times_);
          largest_ = std::max(largest_, StressAtPlaces::size(grid_[i]));
          if (i > 0)
            step_ = std::max(step_, StressAtPlaces::difference(grid_[i - 1], grid_[i]));
        }
        if (const auto bounds = stress.bounds({0., length, begin_, end}))
          rate_ = bounds->rate;
        mean_step_ = HUGE_VAL;
        mean_step_ = mismatch(1);
      }

      /// Multiples of the grid step that may be near a period: shifts by them change m as little as a shift by one step
      /// could, and less than their neighbours.
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
      /// True if m is smooth on the grid. A wave of nearly one period per step looks smooth, too; bounds of |m_t|
      /// exclude it.
      bool
      is_smooth() const
      {
        constexpr double too_large = 4.; // factor by which bounds may be too large
        return step_ <= smooth * largest_ && rate_ * T_ / n_times_ <= too_large * smooth * largest_;
      }

      /// The smallest period near one of the candidates that passes the test.
      std::optional<double>
      smallest(const std::vector<unsigned int> &candidates, const double longest, PeriodTest &test)
      {
        constexpr std::size_t max_candidates = 64;
        test.knows(largest_);
        for (std::size_t i = 0; i < std::min(candidates.size(), max_candidates); ++i)
          for (const double P : guesses(candidates[i]))
            if (P > 0. && P <= longest && test.holds(P))
              return P;
        return std::nullopt;
      }

    private:
      /// Mean of |m(t + P) - m(t)| for P of j grid steps, which jumps affect less than the maximum; infinite if it is
      /// much larger than for one step.
      double
      mismatch(const unsigned int j) const
      {
        const double n = n_times_ + 1 - j, most = 2. * mean_step_ * n;
        double sum = 0.;
        for (unsigned int i = 0; i + j <= n_times_ && sum <= most; ++i)
          for (unsigned int p = 0; p < StressAtPlaces::n; ++p)
            sum += std::abs(grid_[i + j][p] - grid_[i][p]);
        return sum <= most ? sum / n : HUGE_VAL;
      }

      /// Guesses of a period near j grid steps.
      std::vector<double>
      guesses(const unsigned int j)
      {
        const double near = T_ * j / n_times_, around = T_ / n_times_;
        // A whole part of the duration, or the shortest decimal number: the only ways to find the period of pulses.
        std::vector<double> list = {end_time_ / std::round(end_time_ / near)};
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

      /// Minimises the squares of m(t + P) - m(t) by the Gauss-Newton method; @p near if this does not converge, as
      /// when there is no period.
      double
      refined(const double near)
      {
        constexpr unsigned int max_iterations = 10, n = 8;
        const double around = 2. * T_ / n_times_, delta = 1e-6 * T_ / n_times_;
        double P = near, change_before = around;
        for (unsigned int iteration = 0; iteration < max_iterations; ++iteration)
        {
          double r_d = 0., d_d = 0.;
          for (unsigned int i = 0; i < n; ++i)
          {
            const double t                   = begin_ + (i + 0.37) / n * (T_ - near - around);
            const StressAtPlaces::Values now = m_.at(t), later = m_.at(t + P), before = m_.at(t + P - delta),
                                         after = m_.at(t + P + delta);
            for (unsigned int p = 0; p < StressAtPlaces::n; ++p)
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

      StressAtPlaces m_;
      const double begin_, T_;
      const double end_time_; ///< of the run
      const unsigned int n_times_;
      std::vector<StressAtPlaces::Values> grid_;
      double largest_ = 0., step_ = 0., mean_step_ = 0.; ///< |m|; change over a step of the grid
      double rate_ = 0.;                                 ///< a bound of |m_t|, if known
    };

    std::optional<double>
    find_period(const ActiveStress &stress, const double length, const double begin, const double end_time)
    {
      PeriodTest test(stress, length, begin, end_time);
      bool is_smooth = false;
      // Search in a window of time from `begin` on; a period found by a grid there must pass the test.
      const auto look = [&](const double window, PeriodTest &repeats) -> std::optional<double> {
        const double end = begin + window, longest = window / 2.;
        const PeriodSearch coarse(stress, length, begin, end, few_times, end_time);
        is_smooth = coarse.is_smooth();
        if (is_smooth && (coarse.is_steady() || coarse.candidates(longest).empty()))
          return std::nullopt;
        PeriodSearch fine(stress, length, begin, end, many_times, end_time);
        is_smooth = fine.is_smooth();
        return fine.is_steady() ? std::nullopt : fine.smallest(fine.candidates(longest), longest, repeats);
      };
      double window = end_time - begin;
      auto found    = look(window, test);
      // Too coarse a grid shows none of many periods, or several as one.
      constexpr double shorter         = 0.25;
      constexpr unsigned int n_shorter = 6;
      for (unsigned int i = 0; i < n_shorter && !found && !is_smooth; ++i)
        found = look(window *= shorter, test);
      while (found && !is_smooth)
      {
        PeriodTest in_two(stress, length, begin, begin + 2. * *found);
        const auto part = look(2. * *found, in_two);
        if (!part || *part > 0.75 * *found)
          break;
        found = part;
      }
      return found;
    }
  } // namespace

  std::optional<ActiveStress::Repetition>
  find_repetition(const ActiveStress &stress, const double length, const double end_time)
  {
    for (const double part : starts)
      if (const auto P = find_period(stress, length, part * end_time, end_time))
      {
        double from       = part * end_time;
        const auto before = [&](const double earlier) {
          return PeriodTest(stress, length, earlier, end_time).holds(*P);
        };
        if (part == first_start)
          while (from / 2. > *P / 2. && before(from / 2.))
            from /= 2.;
        return ActiveStress::Repetition{*P, from};
      }
    return std::nullopt;
  }

  std::optional<double>
  common_period(const std::vector<double> &periods)
  {
    constexpr double largest = 1000., tolerance = 1e-10;
    double common = periods.front();
    for (const double P : periods)
    {
      const double ratio    = common / P;
      const auto is_product = [ratio](const double q) {
        return std::abs(ratio - std::round(ratio * q) / q) <= tolerance * ratio;
      };
      double q = 1.;
      while (q <= largest && !is_product(q))
        ++q;
      if (std::max(q, std::round(ratio * q)) > largest)
        return std::nullopt;
      common *= q; // q times the one is p times the other
    }
    return common;
  }

  double
  shortest_period(const ActiveStress &stress, const double length, const double period, const double from)
  {
    constexpr unsigned int most = 10; // times each factor
    const auto repeats_after = [&](const double P) { return PeriodTest(stress, length, from, from + period).holds(P); };
    double shortest          = period;
    if (repeats_after(0.381966 * period)) // steady
      return period;
    for (const unsigned int factor : {2, 3, 5, 7})
      for (unsigned int i = 0; i < most && repeats_after(shortest / factor); ++i)
        shortest /= factor;
    return shortest;
  }
} // namespace crawler
