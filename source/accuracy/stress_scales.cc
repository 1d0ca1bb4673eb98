// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/stress_scales.h>
#include <crawler/base/grid_samples.h>
#include <crawler/scene/fast_changes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace crawler
{
  namespace
  {
    /// Number of places or times between samples where they are close; number of these intervals over which differences
    /// show smoothness, not round-off.
    constexpr unsigned int fine = 512, near = 4;

    /// Largest |x_i|, i < @p n, of the values of @p x; several maxima are formed side by side, so that none waits for
    /// itself.
    template <typename Numbers>
    double
    largest_size(const std::size_t n, const Numbers &x)
    {
      constexpr std::size_t together = 8;
      std::array<double, together> largest{};
      std::size_t i = 0;
      for (; i + together <= n; i += together)
        for (std::size_t j = 0; j < together; ++j)
          largest[j] = std::max(largest[j], std::abs(x(i + j)));
      for (; i < n; ++i)
        largest[0] = std::max(largest[0], std::abs(x(i)));
      return *std::ranges::max_element(largest);
    }

    /// True if one of @p breaks (ascending) is between @p from and @p to.
    bool
    any_between(const std::vector<double> &breaks, const double from, const double to)
    {
      const auto next = std::lower_bound(breaks.begin(), breaks.end(), from);
      return next != breaks.end() && *next <= to;
    }

    /// Place where m jumps by more than @p least at the time @p t, without being one of the breaks @p in_space: where
    /// the largest difference of neighbours of a sampling does not shrink when the neighbours come closer.
    std::optional<double>
    undeclared_jump(const Scene &scene, const std::vector<double> &in_space, const double t, const double least)
    {
      constexpr unsigned int n = 512, n_bisections = 30;
      const std::vector<double> points = equal_parts(0., scene.body.length, n);
      std::vector<double> m(n + 1);
      scene.active_stress->at(points)->values(t, m);
      double left = 0., right = 0., m_left = 0., m_right = 0.;
      const auto change = [&]() { return std::abs(m_right - m_left); };
      for (unsigned int i = 0; i < n; ++i)
        if (std::abs(m[i + 1] - m[i]) > change() && !any_between(in_space, points[i], points[i + 1]))
        {
          left    = points[i];
          right   = points[i + 1];
          m_left  = m[i];
          m_right = m[i + 1];
        }
      std::vector<double> value(1);
      for (unsigned int i = 0; i < n_bisections && change() > least; ++i)
      {
        const double middle = 0.5 * (left + right);
        scene.active_stress->at({middle})->values(t, value);
        const bool in_left           = std::abs(value[0] - m_left) > std::abs(m_right - value[0]);
        (in_left ? right : left)     = middle;
        (in_left ? m_right : m_left) = value[0];
      }
      return change() > least ? std::optional(0.5 * (left + right)) : std::nullopt;
    }

    /// True if undeclared jumps are at different places at different times.
    bool
    jumps_that_move(const Scene &scene, const std::vector<double> &in_space, const double least)
    {
      constexpr unsigned int n_times = 8;
      constexpr double golden        = 0.6180339887498949; // not a multiple of a period
      const double L = scene.body.length, beside = 1e-6 * L;
      struct Jump
      {
        double place, time;
      };
      const auto is_there = [&](const double place, const double t) {
        const std::vector<double> points = {std::max(0., place - beside), std::min(L, place + beside)};
        std::vector<double> m(2);
        scene.active_stress->at(points)->values(t, m);
        return std::abs(m[1] - m[0]) > 0.5 * least;
      };
      std::vector<Jump> jumps;
      for (unsigned int i = 1; i <= n_times; ++i)
      {
        const double t = scene.end_time * std::fmod(i * golden, 1.);
        if (const auto place = undeclared_jump(scene, in_space, t, least))
          jumps.push_back({*place, t});
      }
      for (std::size_t i = 1; i < jumps.size(); ++i)
        if (!is_there(jumps[i].place, jumps[i - 1].time) && !is_there(jumps[i - 1].place, jumps[i].time))
          return true;
      return false;
    }

    /// Samples of m on two grids: many places at few times, and many times at few places.
    class Samples
    {
    public:
      /// @p duration is a period of m or the whole time; @p in_time are breaks relative to it.
      Samples(const Scene &scene,
              const double duration,
              const std::vector<double> &in_space,
              const std::vector<double> &in_time)
        : scene_(scene)
        , T_(duration)
        , in_space_(in_space)
        , in_time_(in_time)
      {
        constexpr unsigned int coarse = 16, very_fine = 8192;
        look(fine, coarse);
        look(coarse, fine);
        // Short events may have been missed where m is nearly 0 most of the time, unless the generator can tell.
        if (is_often_quiet() && !scene.active_stress->bounds({0., scene.body.length, 0., T_}))
          look(coarse, very_fine);
      }

      /// Examines m between samples, which do not show its rate if they are too far apart; bounds at points do. Where
      /// an event lies between samples its stress has not been seen either.
      void
      look_between()
      {
        constexpr unsigned int n_places = 3;
        constexpr double between        = 0.381966; // fraction of the distance of two samples that is not simple
        const ActiveStress &stress      = *scene_.active_stress;
        const double L = scene_.body.length, dt = T_ / static_cast<double>(rates_.size());
        if (const auto all = stress.bounds({0., L, 0., T_}); !all || all->rate * dt <= largest)
          return;
        std::vector<double> places;
        for (unsigned int i = 0; i < n_places; ++i)
          places.push_back(L * (i + between) / n_places);
        const auto at = stress.at(places);
        std::vector<double> m(n_places);
        for (std::size_t j = 0; j < rates_.size(); ++j)
        {
          const double t = dt * (static_cast<double>(j) + between);
          for (const double s : places)
            if (const double rate = stress.bounds({s, s, t, t})->rate; std::isfinite(rate))
              rates_[j] = std::max(rates_[j], rate);
          at->values(t, m);
          largest = std::max(largest, largest_size(m.size(), [&](const std::size_t i) { return m[i]; }));
        }
      }

      /// Samples many places at one more time.
      void
      look_at(const double t)
      {
        sample(at_places(fine).get(), fine, t);
      }

      double
      largest_rate(const double from, const double to) const
      {
        const auto n = static_cast<double>(rates_.size());
        const auto i = static_cast<std::size_t>(std::clamp(std::floor(from / T_ * n), 0., n - 1.)),
                   j = static_cast<std::size_t>(std::clamp(std::ceil(to / T_ * n), 1., n));
        return *std::max_element(rates_.begin() + static_cast<std::ptrdiff_t>(i),
                                 rates_.begin() + static_cast<std::ptrdiff_t>(std::max(j, i + 1)));
      }

      /// Largest |m_t| except for rare times, a tenth of all at the most, in which it is far larger.
      double
      usual_rate() const
      {
        constexpr double rare = 0.1, far = 4.;
        std::vector<double> rates = rates_;
        const auto usual =
          rates.begin() + static_cast<std::ptrdiff_t>(std::floor((1. - rare) * static_cast<double>(rates.size() - 1)));
        std::nth_element(rates.begin(), usual, rates.end());
        double largest = *usual;
        for (const double rate : rates)
          if (rate <= far * *usual)
            largest = std::max(largest, rate);
        return largest;
      }

      /// Changes at the rare times.
      std::vector<FastChange>
      rare_changes(const double usual) const
      {
        std::vector<FastChange> list;
        const double dt = T_ / static_cast<double>(rates_.size());
        for (std::size_t j = 0; j < rates_.size(); ++j)
          if (rates_[j] > usual) // includes a sample before and after
            list.push_back({dt * (static_cast<double>(j) - 1.), dt * (static_cast<double>(j) + 2.), rates_[j]});
        return list;
      }

      /// True if differences along the body fall like those of a function with many derivatives, between the breaks.
      bool
      is_smooth() const
      {
        constexpr double min_order = 5., nothing = 1e-10;
        return coarse_difference_ <= nothing * largest || fine_difference_ * std::exp2(min_order) <= coarse_difference_;
      }

      double largest = 0.; ///< |m|
      double along   = 0.; ///< |m_s| between the breaks

    private:
      /// Largest sixth difference of neighbours that are @p apart near samples from each other.
      double
      sixth_difference(const std::vector<double> &m, const std::size_t apart) const
      {
        return largest_difference(m.size(), 6 * apart, [&](const std::size_t i) {
          const double *x = m.data() + i;
          return x[0] + x[6 * apart] - 6. * (x[apart] + x[5 * apart]) + 15. * (x[2 * apart] + x[4 * apart]) -
                 20. * x[3 * apart];
        });
      }

      /// Largest of the differences of samples i to i + @p reach along the body that have no break between them.
      template <typename Difference>
      double
      largest_difference(const std::size_t n_samples, const std::size_t reach, const Difference &difference) const
      {
        if (in_space_.empty())
          return largest_size(n_samples - reach, difference);
        const double h = scene_.body.length / static_cast<double>(n_samples - 1);
        double found   = 0.;
        for (std::size_t i = 0; i + reach < n_samples; ++i)
          if (!any_between(in_space_, h * static_cast<double>(i), h * static_cast<double>(i + reach)))
            found = std::max(found, std::abs(difference(i)));
        return found;
      }

      std::unique_ptr<ActiveStressAtPoints>
      at_places(const unsigned int n) const
      {
        return scene_.active_stress->at(equal_parts(0., scene_.body.length, n));
      }

      void
      sample(ActiveStressAtPoints *stress, const unsigned int n_points, const double t)
      {
        m_.resize(n_points + 1);
        stress->values(t, m_);
        largest = std::max(largest, largest_size(m_.size(), [this](const std::size_t i) { return m_[i]; }));
        const double change =
          largest_difference(m_.size(), 1, [this](const std::size_t i) { return m_[i + 1] - m_[i]; });
        along = std::max(along, change * n_points / scene_.body.length);
        if (n_points != fine)
          return;
        std::vector<double> near_samples;
        for (unsigned int i = 0; i <= n_points; i += near)
          near_samples.push_back(m_[i]);
        fine_difference_   = std::max(fine_difference_, sixth_difference(near_samples, 1));
        coarse_difference_ = std::max(coarse_difference_, sixth_difference(near_samples, 2));
      }

      void
      look(const unsigned int n_points, const unsigned int n_times)
      {
        const auto stress = at_places(n_points);
        std::vector<double> before, rates(n_times, 0.);
        for (unsigned int j = 0; j <= n_times; ++j)
        {
          before.swap(m_);
          sample(stress.get(), n_points, T_ * j / n_times);
          if (j > 0 && !any_between(in_time_, (j - 1.) / n_times, 1. * j / n_times))
            rates[j - 1] =
              largest_size(m_.size(), [&](const std::size_t i) { return m_[i] - before[i]; }) * n_times / T_;
        }
        rates_.swap(rates); // finer than the previous ones
      }

      /// True if the active stress is nearly 0 for more than a tenth of the time.
      bool
      is_often_quiet() const
      {
        constexpr unsigned int n = 128, n_places = 4;
        constexpr double quiet = 1e-6, often = 0.1;
        std::vector<double> m(n_places + 1);
        const auto stress    = at_places(n_places);
        unsigned int n_quiet = 0;
        for (unsigned int j = 0; j < n; ++j)
        {
          stress->values(T_ * j / n, m);
          n_quiet +=
            std::all_of(m.begin(), m.end(), [&](const double value) { return std::abs(value) <= quiet * largest; });
        }
        return n_quiet > often * n;
      }

      const Scene &scene_;
      const double T_;
      const std::vector<double> &in_space_, &in_time_;
      std::vector<double> m_, rates_; ///< |m_t| between samples, largest along the body
      double fine_difference_ = 0., coarse_difference_ = 0.;
    };

    /// Limits of steps to the time in which m can change by the largest |m|: where it is fast, and elsewhere.
    std::vector<StepLimit>
    step_limits(const std::vector<FastChange> &changes,
                const double largest,
                const double usual,
                const double period,
                const double end_time)
    {
      constexpr double unlimited       = std::numeric_limits<double>::infinity();
      constexpr double similar         = 2.;
      constexpr std::size_t max_limits = 100000;
      if (largest == 0.)
        return {};
      const double longest = usual > 0. ? largest / usual : unlimited;
      // Starts and ends of changes; the fastest of those in progress counts. The step before one ends `lead` steps
      // earlier so that it does not see how the change begins: all runs would have the same error there.
      constexpr double lead = 8.;
      std::map<double, std::vector<std::pair<double, bool>>> edges; // time -> rates, and flags of those that begin
      for (const FastChange &change : changes)
        if (change.rate > usual && change.from < period && change.to > 0.)
        {
          edges[std::max(change.from - lead * largest / change.rate, 0.)].emplace_back(change.rate, true);
          edges[std::min(change.to, period)].emplace_back(change.rate, false);
        }
      std::vector<StepLimit> limits = {{0., longest}};
      double opened = longest; // initial value of the last limit: many similar ones in a row may be far apart
      std::multiset<double> rates;
      for (const auto &[time, list] : edges)
      {
        for (const auto &[rate, begins] : list)
          if (begins)
            rates.insert(rate);
          else
            rates.erase(rates.find(rate));
        const double now = rates.empty() ? longest : largest / *rates.rbegin();
        StepLimit &last  = limits.back();
        if (last.from >= time)
          opened = last.longest = now;
        else if (!rates.empty() && opened < longest && std::max(now, opened) <= similar * std::min(now, opened))
          last.longest = std::min(now, last.longest);
        else
        {
          limits.push_back({time, now});
          opened = now;
        }
      }
      const std::size_t n = limits.size();
      if (n == 1)
        return longest < unlimited ? limits : std::vector<StepLimit>();
      const double n_periods = std::ceil(end_time / period * (1. - 1e-12));
      if (static_cast<double>(n) * n_periods > static_cast<double>(max_limits))
        return {{0., std::min(longest, std::ranges::min_element(limits, {}, &StepLimit::longest)->longest)}};
      for (double i = 1.; i < n_periods; ++i)
        for (std::size_t j = 0; j < n; ++j)
          limits.push_back({limits[j].from + i * period, limits[j].longest});
      return limits;
    }

    struct SuddenChange
    {
      double at_start, later;
    };

    /// Largest sudden changes of m at the ends and of its jumps at the breaks in space. At the start m meets a body
    /// whose initial stretch w balances -k (w - 1).
    SuddenChange
    largest_sudden_change(const Scene &scene, const std::vector<double> &in_space)
    {
      const double L = scene.body.length, T = scene.end_time, beside = 2. * min_space_between_breaks * L;
      std::vector<double> points = {0., L};
      for (const double s : in_space)
        points.insert(points.end(), {s - beside, s + beside});
      const auto stress = scene.active_stress->at(points);
      std::vector<double> m(points.size());
      const std::size_t n = 2 + in_space.size();
      std::vector<double> before(n), now(n);
      SuddenChange largest{0., 0.};
      const auto keep_changes = [&](std::vector<double> &changes) {
        changes[0] = m[0];
        changes[1] = m[1];
        for (std::size_t i = 0; i < in_space.size(); ++i)
          changes[2 + i] = m[3 + 2 * i] - m[2 + 2 * i];
      };
      const auto look = [&](const double t) {
        stress->values(t * T, m);
        keep_changes(now);
      };
      const std::vector<double> w = profile_at(scene.profiles.initial_stretch, points),
                                k = profile_at(scene.profiles.elastic_modulus, points);
      for (std::size_t i = 0; i < points.size(); ++i)
        m[i] = -scene.body.elastic_modulus * k[i] * (w[i] - 1.);
      keep_changes(before);
      TimeSegments pieces(*scene.active_stress, T);
      for (double start = 0.;; pieces.go_on())
      {
        look(pieces.inside(start));
        for (std::size_t i = 0; i < n; ++i)
        {
          double &known = start == 0. ? largest.at_start : largest.later;
          known         = std::max(known, std::abs(now[i] - before[i]));
        }
        if (pieces.is_last())
          return largest;
        start = pieces.end();
        look(pieces.inside(start));
        before = now;
      }
    }
  } // namespace

  StressScales
  stress_scales(const Scene &scene)
  {
    constexpr unsigned int max_looks = 64;
    constexpr double jump_part       = 0.05; // smaller jumps, relative to the largest |m|, are not searched
    const ActiveStress &stress       = *scene.active_stress;
    const double L = scene.body.length, T = scene.end_time;
    // Single period, which shows everything.
    const double P                     = std::min(stress.period().value_or(T), T);
    const std::vector<double> in_space = scene.breaks_in_space(), in_time = TimeSegments(stress, T).breaks();
    std::vector<double> in_period;
    for (const double t : in_time)
      if (t * T < P)
        in_period.push_back(t * T / P);

    Samples samples(scene, P, in_space, in_period);
    samples.look_between();
    const double usual              = samples.usual_rate();
    std::vector<FastChange> changes = samples.rare_changes(usual);
    const FastChanges found         = find_fast_changes(
      stress,
      L,
      0.,
      P,
      [&](const double from, const double to) {
        return rates_explain * std::max(usual, samples.largest_rate(from, to));
      },
      samples.largest);
    changes.insert(changes.end(), found.list.begin(), found.list.end());
    std::sort(changes.begin(), changes.end(), [](const FastChange &a, const FastChange &b) { return a.from < b.from; });
    for (std::size_t i = 0; i < changes.size(); i += 1 + changes.size() / max_looks)
      samples.look_at(0.5 * (changes[i].from + changes[i].to));
    for (std::size_t i = 1; i < in_period.size(); ++i)
      if (in_period[i] - in_period[i - 1] < 2. / fine) // a sampling may miss what is between these breaks
        samples.look_at(0.5 * P * (in_period[i] + in_period[i - 1]));

    const double largest = samples.largest, along = samples.along;
    const bool is_moved       = largest > 0. || scene.profiles.initial_stretch;
    const SuddenChange change = is_moved ? largest_sudden_change(scene, in_space) : SuddenChange{0., 0.};
    const double unit         = largest > 0. ? largest : scene.body.elastic_modulus;
    const bool may_jump       = along * L / fine > jump_part * largest;
    // Fast changes were searched when a repetition was found.
    const auto repetition = stress.repetition();
    const bool sees_all   = found.is_complete || (repetition && repetition->from == 0.);
    return {std::min(largest * L / scene.body.elastic_modulus, largest * T / (L * scene.body.friction_coefficient)),
            along > 0. ? largest / along : L,
            step_limits(changes, largest, usual, P, T),
            largest,
            sees_all,
            samples.is_smooth(),
            std::max(change.at_start, change.later) / unit,
            change.later / unit,
            in_space.size(),
            in_time.size(),
            may_jump && jumps_that_move(scene, in_space, jump_part * largest)};
  }

  std::vector<StepLimit>
  similar_step_limits(const Scene &scene, const std::vector<StepLimit> &known, double largest)
  {
    const ActiveStress &stress = *scene.active_stress;
    const double L = scene.body.length, T = scene.end_time, P = std::min(stress.period().value_or(T), T);
    if (!stress.bounds({0., L, 0., P})) // stresses without bounds are sampled, if there are events
    {
      std::vector<StepLimit> limits = known;
      if (limits.size() > 1)
        limits = stress_scales(scene).step_limits;
      return limits;
    }
    double longest = 0.;
    for (const StepLimit &limit : known)
      longest = std::max(longest, limit.longest);
    const double usual      = longest > 0. ? largest / longest : 0.;
    const FastChanges found = find_fast_changes(
      stress, L, 0., P, [usual](double, double) { return rates_explain * usual; }, largest);
    if (found.list.empty())
      return known.empty() ? known : std::vector<StepLimit>{{0., longest}};
    return step_limits(found.list, largest, usual, P, T);
  }
} // namespace crawler
