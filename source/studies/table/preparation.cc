// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/csv_numbers.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/base/smoothing_spline.h>
#include <crawler/base/told_apart.h>
#include <crawler/studies/table/marker_strain.h>
#include <crawler/studies/table/period_search.h>
#include <crawler/studies/table/preparation.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace crawler
{
  namespace
  {
    constexpr std::size_t least    = 4; // samples of a spline
    constexpr double much_of_noise = 5.;

    double
    median_step(const std::vector<double> &t)
    {
      std::vector<double> steps;
      for (std::size_t j = 1; j < t.size(); ++j)
        steps.push_back(t[j] - t[j - 1]);
      const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
      std::nth_element(steps.begin(), middle, steps.end());
      return *middle;
    }

    /// One place over time: a spline through the samples that are there, and where it may not be used.
    struct Series
    {
      SplineCurve curve;
      std::vector<std::pair<double, double>> holes;
      double begin = 0., period = 0.; ///< of a period: where its curve begins

      double
      value(double t) const
      {
        if (period > 0.)
          t -= period * std::floor((t - begin) / period);
        for (const auto &[from, to] : holes)
          if (t > from && t < to)
            return gap;
        return curve.value(t);
      }
    };

    struct Filled
    {
      std::size_t n = 0, longest = 0;
      std::size_t n_along_body = 0, n_at_worst = 0; ///< filled from the places beside; at the place with most of them
      double worst_place    = 0.;
      double square         = 0.; ///< of what the smoothing takes away
      std::size_t n_samples = 0;
    };

    /// Nothing if too few samples are there. Gaps of up to @p most samples are filled.
    std::optional<Series>
    series_of(const std::vector<double> &t,
              const std::vector<double> &y,
              const double width,
              const std::size_t most,
              Filled &filled)
    {
      std::vector<double> knots, values;
      std::vector<std::pair<double, double>> holes;
      double last = -HUGE_VAL;
      for (std::size_t j = 0, missing = 0; j <= t.size(); ++j)
      {
        const bool is_end = j == t.size();
        if (!is_end && std::isnan(y[j]))
        {
          ++missing;
          continue;
        }
        const bool is_inside = !knots.empty() && !is_end;
        if (missing > 0 && (missing > most || !is_inside))
          holes.emplace_back(last, is_end ? HUGE_VAL : t[j]);
        else if (missing > 0)
        {
          filled.n += missing;
          filled.longest = std::max(filled.longest, missing);
        }
        missing = 0;
        if (is_end)
          break;
        last = t[j];
        knots.push_back(t[j]);
        values.push_back(y[j]);
      }
      if (knots.size() < least)
        return std::nullopt;
      Series result{SmoothingSpline(knots, width).curve(values), std::move(holes)};
      for (std::size_t j = 0; j < knots.size(); ++j)
        filled.square += std::pow(values[j] - result.curve.values()[j], 2);
      filled.n_samples += knots.size();
      return result;
    }

    /// What the cycles of a period have in common, at one place.
    struct Cycles
    {
      std::vector<double> means, counts;
      double square = 0., n_free = 0.; ///< of the differences from the means

      Cycles(const Samples &samples, const std::size_t i, const double period, const std::size_t n)
        : means(n, gap)
        , counts(n, 0.)
      {
        Filled none;
        const auto series = series_of(samples.t, samples.over_time(i), 0., 0, none);
        if (!series)
          return;
        const double end = samples.t.back() + 1e-9 * period;
        for (std::size_t j = 0; j < n; ++j)
        {
          double sum = 0., squares = 0.;
          for (double t = samples.t.front() + period * static_cast<double>(j) / static_cast<double>(n); t <= end;
               t += period)
            if (const double y = series->value(std::min(t, samples.t.back())); !std::isnan(y))
            {
              sum += y;
              squares += y * y;
              counts[j] += 1.;
            }
          if (counts[j] == 0.)
            continue;
          means[j] = sum / counts[j];
          square += std::max(0., squares - counts[j] * means[j] * means[j]);
          n_free += counts[j] - 1.;
        }
      }

      /// A periodic spline through the means.
      std::optional<Series>
      series(const double begin, const double period, const double width, const std::size_t most, Filled &filled) const
      {
        const std::size_t n = means.size();
        const double step   = period / static_cast<double>(n);
        std::vector<double> knots, values, weights;
        std::vector<std::pair<double, double>> holes;
        std::size_t first = 0;
        while (first < n && std::isnan(means[first]))
          ++first;
        for (std::size_t k = first, missing = 0; k <= first + n && first < n; ++k)
        {
          const std::size_t j = k % n;
          if (std::isnan(means[j]))
          {
            ++missing;
            continue;
          }
          const double t = begin + step * static_cast<double>(k);
          if (missing > most)
            holes.emplace_back(knots.back(), t);
          else if (missing > 0)
          {
            filled.n += missing;
            filled.longest = std::max(filled.longest, missing);
          }
          missing = 0;
          knots.push_back(t);
          values.push_back(means[j]);
          weights.push_back(counts[j]);
        }
        if (knots.size() < least + 1)
          return std::nullopt;
        const double mean_weight = [&]() {
          double sum = 0.;
          for (std::size_t j = 0; j + 1 < weights.size(); ++j)
            sum += weights[j] / static_cast<double>(weights.size() - 1);
          return sum;
        }();
        for (double &weight : weights)
          weight /= mean_weight;
        const double start = knots.front();
        return Series{
          SmoothingSpline(knots, width, CubicSpline::Ends::periodic, weights).curve(values), holes, start, period};
      }
    };

    double
    root_mean_square(const double square, const double n)
    {
      return n > 0. ? std::sqrt(square / n) : 0.;
    }

    /// The period wanted, or the one that is there.
    double
    period_of(const Samples &full, const std::string &wanted, std::vector<std::string> &words)
    {
      const double duration = full.t.back() - full.t.front();
      if (wanted == "whole")
        return duration;
      if (wanted == "find")
      {
        const auto found = find_period(full);
        if (!found)
          throw InputError(
            fmt::format("no period was found from t = {:g} to {:g}, but at least 1.25 cycles of a motion that "
                        "repeats itself are expected; \"--period whole\" takes all of it as one cycle",
                        full.t.front(),
                        full.t.back()));
        words.push_back(fmt::format("period {:.6g} found, {:.3g} cycles", *found, duration / *found));
        return *found;
      }
      const auto number = number_in(wanted);
      if (!number || !(*number > 0.))
        throw InputError(
          fmt::format("\"--period\" is \"{}\", but \"find\", \"whole\" or a positive number is expected", wanted));
      if (*number > duration * (1. + 1e-9))
        throw InputError(fmt::format("\"--period\" is {}, but the samples last from t = {:g} to {:g} only, {} in all",
                                     told_apart(*number, {duration}),
                                     full.t.front(),
                                     full.t.back(),
                                     told_apart(duration, {*number})));
      return std::min(*number, duration);
    }

    /// The cycles must agree within the noise where there is little more than one of them, and roughly if there are
    /// more.
    void
    require_agreement(const Samples &samples,
                      const std::vector<Cycles> &cycles,
                      const double period,
                      const double noise,
                      std::vector<std::string> &words)
    {
      double square = 0., n = 0., sum = 0., squares = 0., n_all = 0., largest = 0.;
      for (const Cycles &one : cycles)
      {
        square += one.square;
        n += one.n_free;
      }
      for (const double y : samples.values)
        if (!std::isnan(y))
        {
          sum += y;
          squares += y * y;
          n_all += 1.;
          largest = std::max(largest, std::abs(y));
        }
      const double scatter = root_mean_square(square, n), duration = samples.t.back() - samples.t.front();
      const double spread      = std::sqrt(std::max(0., squares / n_all - std::pow(sum / n_all, 2)));
      const std::string column = column_of(samples.quantity);
      if (duration < 1.25 * period && scatter > std::max(much_of_noise * noise, 1e-9 * largest))
        throw InputError(
          fmt::format("{} at the begin and the end of the period {:g} differs by {:.3g} (as a standard "
                      "deviation), which is more than {:g} times the noise of {:.3g}; another \"--period\", or a "
                      "larger \"--noise\", is expected",
                      column,
                      period,
                      scatter,
                      much_of_noise,
                      noise));
      if (duration >= 1.25 * period && scatter > 0.7 * spread)
        throw InputError(
          fmt::format("the cycles of the period {:g} differ from each other by {:.3g}, nearly as much as all "
                      "samples ({:.3g}), so that this is no period; \"--period find\" looks for one",
                      period,
                      scatter,
                      spread));
      words.push_back(
        fmt::format("period {:.6g} closed: where cycles meet or repeat, {} differs by {:.3g} (noise {:.3g}), and "
                    "the mean is taken",
                    period,
                    column,
                    scatter,
                    noise));
    }

    /// What the sentence about a gap says of its place.
    [[noreturn]] void
    refuse_gap(const Samples &samples, const std::size_t i, const double t, const unsigned int most)
    {
      std::size_t from = 0;
      for (std::size_t j = 0; j < samples.t.size(); ++j)
        if (std::isnan(samples.at(j, i)) && std::abs(samples.t[j] - t) <= std::abs(samples.t[from] - t))
          from = j;
      std::size_t to = from;
      while (from > 0 && std::isnan(samples.at(from - 1, i)))
        --from;
      while (to + 1 < samples.t.size() && std::isnan(samples.at(to + 1, i)))
        ++to;
      const char *const place = samples.quantity == MeasuredQuantity::marker ? "marker" : "s";
      if (from == 0 || to + 1 == samples.t.size())
        throw InputError(
          fmt::format("{} is missing at {} = {:g} from t = {:g} to {:g}, the {} of the samples, but only "
                      "what lies between measured ones is filled; without these times, or without this "
                      "place, the rest can be read",
                      column_of(samples.quantity),
                      place,
                      samples.s[i],
                      samples.t[from],
                      samples.t[to],
                      from == 0 ? "beginning" : "end"));
      throw InputError(
        fmt::format("{} is missing at {} = {:g} from t = {:g} to {:g}, {} in a row, but at most {} between "
                    "measured ones are filled (\"--gap\"), in time or else along the body",
                    column_of(samples.quantity),
                    place,
                    samples.s[i],
                    samples.t[from],
                    samples.t[to],
                    counted(to - from + 1, "sample"),
                    most));
    }

    /// What is missing at a time, from the places beside it.
    void
    fill_along_body(const std::vector<double> &s, std::vector<double> &y, const std::size_t most, Filled &filled)
    {
      if (std::none_of(y.begin(), y.end(), [](const double v) { return std::isnan(v); }))
        return;
      const auto series = series_of(s, y, 0., most, filled);
      for (std::size_t i = 0; i < s.size() && series; ++i)
        if (std::isnan(y[i]))
          y[i] = series->value(s[i]);
    }

    std::vector<double>
    equal_steps(const double from, const double to, const std::size_t n)
    {
      std::vector<double> result;
      for (std::size_t i = 0; i < n; ++i)
        result.push_back(i + 1 == n ? to : from + (to - from) * static_cast<double>(i) / static_cast<double>(n - 1));
      return result;
    }

    void
    require_steps(const std::vector<double> &t, const unsigned int most)
    {
      const double step = median_step(t);
      for (std::size_t j = 1; j < t.size(); ++j)
        if (t[j] - t[j - 1] > (most + 1.5) * step)
          throw InputError(
            fmt::format("from t = {} to {} there are no samples, {:.3g} times the usual step, but at most "
                        "{} missing samples are filled (\"--gap\")",
                        told_apart(t[j - 1], {t[j]}),
                        told_apart(t[j], {t[j - 1]}),
                        (t[j] - t[j - 1]) / step,
                        most));
    }

    /// The samples with all gaps filled, those in time first; smoothed with @p width if @p is_smoothed.
    Samples
    without_gaps(
      const Samples &samples, const double width, const bool is_smoothed, const unsigned int most, Filled &filled)
    {
      Samples full = samples;
      for (std::size_t i = 0; i < samples.s.size(); ++i)
        if (const auto series = series_of(samples.t, samples.over_time(i), width, most, filled))
          for (std::size_t j = 0; j < samples.t.size(); ++j)
            if (is_smoothed || std::isnan(full.at(j, i)))
              full.at(j, i) = series->value(samples.t[j]);
      std::vector<std::size_t> missing(samples.s.size());
      for (std::size_t j = 0; j < samples.t.size(); ++j)
      {
        std::vector<double> y = full.over_body(j);
        for (std::size_t i = 0; i < y.size(); ++i)
          missing[i] += std::isnan(y[i]) ? 1 : 0;
        if (samples.quantity != MeasuredQuantity::marker)
          fill_along_body(samples.s, y, most, filled);
        for (std::size_t i = 0; i < y.size(); ++i)
        {
          if (std::isnan(y[i]))
            refuse_gap(samples, i, samples.t[j], most);
          full.at(j, i) = y[i];
        }
      }
      const auto worst    = std::ranges::max_element(missing);
      filled.n_along_body = std::accumulate(missing.begin(), missing.end(), std::size_t{0});
      filled.n_at_worst   = *worst;
      filled.worst_place  = samples.s[static_cast<std::size_t>(worst - missing.begin())];
      return full;
    }

    /// Tracks from the first to the last frame that has all markers, if no more than @p most are left out at an end.
    Samples
    without_ragged_ends(const Samples &tracks, const unsigned int most, std::vector<std::string> &words)
    {
      const auto is_complete = [&](const std::size_t j) {
        const std::vector<double> x = tracks.over_body(j);
        return std::none_of(x.begin(), x.end(), [](const double place) { return std::isnan(place); });
      };
      std::size_t begin = 0, end = tracks.t.size();
      while (begin + least < end && begin < most && !is_complete(begin))
        ++begin;
      while (begin + least < end && tracks.t.size() - end < most && !is_complete(end - 1))
        --end;
      const std::size_t n = tracks.s.size(), n_left_out = tracks.t.size() - (end - begin);
      if (n_left_out == 0)
        return tracks;
      words.push_back(
        fmt::format("{} at the begin or end left out, in which markers are missing", counted(n_left_out, "frame")));
      const auto frame = [&](const std::size_t j) {
        return tracks.values.begin() + static_cast<std::ptrdiff_t>(j * n);
      };
      Samples result = tracks;
      result.t.assign(tracks.t.begin() + static_cast<std::ptrdiff_t>(begin),
                      tracks.t.begin() + static_cast<std::ptrdiff_t>(end));
      result.values.assign(frame(begin), frame(end));
      return result;
    }

    /// One period from all cycles, at n + 1 times.
    Samples
    one_period(const Samples &samples,
               const PreparationSettings &settings,
               const double period,
               const double noise,
               PreparedTable &result,
               Filled &filled)
    {
      const double begin = samples.t.front();
      const auto n =
        settings.n_t > 0
          ? settings.n_t - 1
          : std::max<std::size_t>(8, static_cast<std::size_t>(std::lround(period / median_step(samples.t))));
      std::vector<Cycles> cycles;
      for (std::size_t i = 0; i < samples.s.size(); ++i)
        cycles.emplace_back(samples, i, period, n);
      require_agreement(samples, cycles, period, noise, result.words);
      Samples table;
      table.quantity = samples.quantity;
      table.s        = samples.s;
      table.t        = equal_steps(begin, begin + period, n + 1);
      table.values.assign(table.s.size() * table.t.size(), gap);
      for (std::size_t i = 0; i < samples.s.size(); ++i)
        if (const auto series = cycles[i].series(begin, period, settings.width_t, settings.largest_gap, filled))
        {
          for (std::size_t j = 0; j < n; ++j)
            table.at(j, i) = series->value(table.t[j]);
          for (std::size_t j = 0; j < samples.t.size(); ++j)
            if (const double y = samples.at(j, i), f = series->value(samples.t[j]); !std::isnan(y) && !std::isnan(f))
            {
              filled.square += (y - f) * (y - f);
              ++filled.n_samples;
            }
        }
      for (std::size_t j = 0; j < n; ++j)
      {
        std::vector<double> y = table.over_body(j);
        fill_along_body(table.s, y, settings.largest_gap, filled);
        for (std::size_t i = 0; i < y.size(); ++i)
        {
          if (std::isnan(y[i]))
            refuse_gap(samples, i, table.t[j], settings.largest_gap);
          table.at(j, i) = y[i];
        }
      }
      for (std::size_t i = 0; i < table.s.size(); ++i)
        table.at(n, i) = table.at(0, i);
      return table;
    }

    /// Smoothing and equal steps along the body, and the steps in time.
    Samples
    resampled(const Samples &samples, const double width_s, const unsigned int n_s, const unsigned int n_t)
    {
      Samples result;
      result.quantity = samples.quantity;
      result.s        = n_s > 0 ? equal_steps(samples.s.front(), samples.s.back(), n_s) : samples.s;
      result.t        = n_t > 0 ? equal_steps(samples.t.front(), samples.t.back(), n_t) : samples.t;
      const SmoothingSpline over_t(samples.t, 0.), over_s(samples.s, width_s);
      std::vector<SplineCurve> curves;
      for (std::size_t i = 0; i < samples.s.size() && n_t > 0; ++i)
        curves.push_back(over_t.curve(samples.over_time(i)));
      for (std::size_t j = 0; j < result.t.size(); ++j)
      {
        std::vector<double> y = n_t > 0 ? std::vector<double>() : samples.over_body(j);
        for (const SplineCurve &curve : curves)
          y.push_back(curve.value(result.t[j]));
        if (n_s > 0 || width_s > 0.)
        {
          const SplineCurve curve = over_s.curve(y);
          y.clear();
          for (const double s : result.s)
            y.push_back(curve.value(s));
        }
        result.values.insert(result.values.end(), y.begin(), y.end());
      }
      return result;
    }

    void
    repeat(Samples &samples, const unsigned int n_cycles)
    {
      const std::size_t n = samples.t.size() - 1, n_s = samples.s.size();
      const double begin = samples.t.front(), period = samples.t.back() - begin;
      const std::vector<double> t = samples.t;
      for (unsigned int k = 1; k < n_cycles; ++k)
        for (std::size_t j = 1; j <= n; ++j)
        {
          samples.t.push_back(t[j] + k * period);
          for (std::size_t i = 0; i < n_s; ++i)
            samples.values.push_back(samples.values[j * n_s + i]);
        }
    }

    /// The shape in the first frame is that without strain, after the smoothing, too.
    void
    begin_at_rest(Samples &strain)
    {
      const std::vector<double> first = strain.over_body(0);
      for (std::size_t j = 0; j < strain.t.size(); ++j)
        for (std::size_t i = 0; i < strain.s.size(); ++i)
          strain.at(j, i) = (1. + strain.at(j, i)) / (1. + first[i]) - 1.;
    }

    void
    say_what_changed(const PreparationSettings &settings,
                     const Filled &filled,
                     const double noise,
                     std::vector<std::string> &words)
    {
      if (filled.n > 0)
        words.push_back(fmt::format("{} filled, up to {} in a row", counted(filled.n, "gap"), filled.longest));
      if (filled.n_along_body > 0)
        words.push_back(
          fmt::format("of these {} along the body, from the places beside them, {} at s = {:g}: what was "
                      "there is a guess",
                      filled.n_along_body,
                      filled.n_at_worst == filled.n_along_body ? "all" : fmt::format("{}", filled.n_at_worst),
                      filled.worst_place));
      if (settings.width_s > 0. || settings.width_t > 0.)
      {
        std::string widths;
        for (const auto &[name, width] : {std::pair{"t", settings.width_t}, std::pair{"s", settings.width_s}})
          if (width > 0.)
            widths += fmt::format("{}{} over {}", widths.empty() ? "" : " and ", width, name);
        words.push_back(
          fmt::format("smoothed by splines with the width {}; waves of this length are halved, those twice as "
                      "long keep 94 %",
                      widths));
      }
      const double change = root_mean_square(filled.square, static_cast<double>(filled.n_samples));
      if (change > 0.)
        words.push_back(fmt::format("samples and table differ in time by {:.3g} (root mean square), noise {:.3g}{}",
                                    change,
                                    noise,
                                    change > 2. * noise ? ": more than noise was smoothed away" : ""));
    }
  } // namespace

  double
  estimated_noise(const Samples &samples)
  {
    double square = 0., n = 0.;
    for (std::size_t i = 0; i < samples.s.size(); ++i)
      for (std::size_t j = 3; j < samples.t.size(); ++j)
      {
        const double third =
          samples.at(j, i) - 3. * samples.at(j - 1, i) + 3. * samples.at(j - 2, i) - samples.at(j - 3, i);
        if (!std::isnan(third))
        {
          square += third * third / 20.; // 1 + 9 + 9 + 1
          n += 1.;
        }
      }
    return root_mean_square(square, n);
  }

  PreparedTable
  prepare_table(const Samples &measured, const PreparationSettings &settings)
  {
    PreparedTable result;
    require_steps(measured.t, settings.largest_gap);
    Filled filled;
    Samples samples      = measured;
    const bool is_tracks = measured.quantity == MeasuredQuantity::marker;
    if (is_tracks)
    {
      Filled of_tracks;
      samples        = strain_of_tracks(without_gaps(without_ragged_ends(measured, settings.largest_gap, result.words),
                                              settings.width_t,
                                              /*is_smoothed=*/false,
                                              settings.largest_gap,
                                              of_tracks),
                                 settings,
                                 result.words);
      filled.n       = of_tracks.n;
      filled.longest = of_tracks.longest;
    }
    result.quantity    = samples.quantity;
    const double noise = settings.noise && !is_tracks ? *settings.noise : estimated_noise(samples);
    result.noise       = settings.noise.value_or(is_tracks ? estimated_noise(measured) : noise);
    Samples table;
    if (settings.period.empty())
      table = without_gaps(samples, settings.width_t, /*is_smoothed=*/true, settings.largest_gap, filled);
    else
    {
      Filled unused;
      const Samples full =
        settings.period == "find"
          ? without_gaps(samples, settings.width_t, /*is_smoothed=*/true, settings.largest_gap, unused)
          : samples;
      result.period = period_of(full, settings.period, result.words);
      table         = one_period(samples, settings, *result.period, noise, result, filled);
    }
    const unsigned int n_t = result.period ? 0 : settings.n_t, n_s = is_tracks ? 0 : settings.n_s;
    const double width_s = is_tracks ? 0. : settings.width_s;
    if (n_t > 0 || n_s > 0 || width_s > 0.)
      table = resampled(table, width_s, n_s, n_t);
    if (is_tracks && settings.material == "first" && !result.period)
      begin_at_rest(table);
    if (result.period)
      repeat(table, settings.n_cycles);
    say_what_changed(settings, filled, noise, result.words);
    result.grid = {table.s, table.t, table.values};
    return result;
  }
} // namespace crawler
