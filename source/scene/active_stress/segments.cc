// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/segments.h>
#include <crawler/scene/breaks.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace crawler
{
  namespace
  {
    const std::string segments_section = "Active stress/Segments/";

    constexpr double round_off = 1e-12;

    double
    fraction(const double x)
    {
      return x - std::floor(x);
    }

    /// Throws InputError if smooth fronts are faster than the rate limit.
    void
    require_smooth_rate(const SegmentsParameters &p)
    {
      if (!p.rate_limit)
        return;
      double largest = 0.;
      for (const double A : p.amplitude)
      {
        // Steepest place: the middle of the front, or the cut.
        const double cut = std::abs(p.saturation.value_or(std::abs(A)) / A);
        const double x   = cut < 0.5 ? smooth_step_inverse(cut) : 0.5;
        largest          = std::max(largest, A == 0. ? 0. : std::abs(A) * smooth_step_rate(x));
      }
      largest *= p.frequency / p.front_width;
      const double width = p.front_width * largest / *p.rate_limit;
      if (largest > *p.rate_limit * (1. + round_off))
        refuse(segments_section + "Rate limit",
               "the smooth fronts change by up to {:.6g} per time, but at most {:g}, the rate limit, is "
               "expected; make {}Switching square",
               largest,
               *p.rate_limit,
               width <= std::min(p.duty_cycle, 1. - p.duty_cycle)
                 ? fmt::format("Front width {:.6g} or more, or ", width)
                 : "");
    }
  } // namespace

  void
  SegmentsParameters::add_parameters(Declarations &declarations)
  {
    declarations.whole_number("Number of segments", number, 1, 1000)
      .means("Number N of actuated segments, all of the same length.");
    declarations.numbers("Amplitude", amplitude, "force", /*one_is_all=*/true)
      .means("Active stress of a segment that is on, positive for a contraction: one number for all segments, or N "
             "from s = 0 to s = L.");
    declarations.number("Frequency", frequency, positive(), "1/time").means("Frequency f of the switching.");
    declarations.number("Phase lag", phase_lag, between(0., 1.), "1")
      .means("Delay of the switching of a segment after that of the segment before it, as a share of the period; 1/N "
             "for one wave on the body.");
    declare_direction(direction, declarations);
    declarations.number("Duty cycle", duty_cycle, {.lower = 0., .upper = 1.}, "1")
      .means("Share of the period in which a segment is on.");
    declarations.choice("Switching", switching, {"square", "smooth"})
      .means("How a segment switches: by jumps, or by smooth fronts about the same instants.");
    declarations.number("Front width", front_width, {.lower = 0., .upper = 0.5, .upper_included = true}, "1")
      .means("Width of a smooth front as a share of the period.");
    declarations.number("Phase", phase, any_number(), "1")
      .means("Phase of the first segment at t = 0 as a share of the period: it is switched on at phase 0.");
    declarations.number("Gap", gap, not_negative(), "1")
      .means("Length of the passive part between neighbouring segments as a share of the length of a segment.");
    declarations.number("Saturation", saturation, positive(), "force")
      .means("Largest absolute value of the active stress; larger ones are clipped to it. Automatic: no limit.");
    declarations.number("Rate limit", rate_limit, positive(), "force/time")
      .means(
        "Largest absolute rate of change of the active stress: square signals become trapezoids. Automatic: no limit.");
    declarations.number("Ramp duration", ramp_duration, not_negative(), "time")
      .means("Time in which the stress grows by a smooth step from 0 at t = 0 to its full size; the rate limit applies "
             "to the stress without this factor.");
  }

  Segments::Segments(const SegmentsParameters &parameters, const double length, const double end_time)
    : parameters_(parameters)
    , length_(length)
    , ramp_{parameters.ramp_duration}
  {
    const auto &p = parameters_;
    const auto n  = p.number;
    if (p.amplitude.size() != 1 && p.amplitude.size() != n)
      refuse(segments_section + "Amplitude",
             "the list of amplitudes has {} numbers, but 1 or {}, one for each segment, are expected",
             p.amplitude.size(),
             n);
    if (p.switching == "smooth")
    {
      smooth_.emplace(p.duty_cycle, p.front_width, segments_section);
      require_smooth_rate(p);
    }

    segments_         = create_segments();
    facts_.repetition = {1. / p.frequency, ramp_.end};
    for (std::size_t i = 1; i < segments_.size(); ++i)
    {
      facts_.breaks_in_space.push_back(segments_[i].first);
      if (p.gap > 0.)
        facts_.breaks_in_space.push_back(segments_[i - 1].last);
    }
    facts_.breaks_in_time = times_of_switching(end_time);
  }

  std::vector<Segments::Segment>
  Segments::create_segments() const
  {
    const auto &p             = parameters_;
    const double D            = p.duty_cycle;
    const auto n              = p.number;
    const bool begins_at_head = sign_of(p.direction) < 0.;
    const double segment = length_ / (n + (n - 1) * p.gap), pitch = segment * (1. + p.gap);
    std::vector<Segment> list;
    for (unsigned int i = 0; i < n; ++i)
    {
      const double A = p.amplitude[p.amplitude.size() == 1 ? 0 : i], most = p.saturation.value_or(std::abs(A));
      const double high = std::clamp(A, -most, most);
      Segment s{i * pitch,
                i + 1 == n ? length_ : i * pitch + segment,
                p.phase - (begins_at_head ? n - 1 - i : i) * p.phase_lag,
                A,
                0.,
                high,
                0.};
      if (p.rate_limit)
      {
        // Amplitude that the actuator reaches in the shorter of the two parts of the period; if it falls short, it
        // stays at the target of the longer part.
        const double per_period     = *p.rate_limit / p.frequency;
        const double way            = std::min(std::abs(high), per_period * std::min(D, 1. - D));
        (D <= 0.5 ? s.high : s.low) = D <= 0.5 ? std::copysign(way, high) : high - std::copysign(way, high);
        s.front                     = way / per_period;
      }
      list.push_back(s);
    }
    return list;
  }

  std::vector<double>
  Segments::times_of_switching(const double end_time) const
  {
    const auto &p = parameters_;
    std::vector<double> phases; // of f t
    for (const Segment &s : segments_)
      for (const double x : breaks(s))
        phases.push_back(fraction(x - s.phase));
    std::sort(phases.begin(), phases.end());
    const auto are_one = [](const double a, const double b) { return b - a <= round_off; };
    phases.erase(std::unique(phases.begin(), phases.end(), are_one), phases.end());
    constexpr double most = 1e6;
    const double periods = p.frequency * end_time, n_breaks = static_cast<double>(phases.size()) * periods;
    require_countable_periods(p.frequency, end_time, false, segments_section + "Frequency");
    if (n_breaks > most)
      refuse(segments_section + "Frequency",
             "the segments switch at {:.3g} different times until the end time, but at most {:g} "
             "are expected",
             n_breaks,
             most);
    std::vector<double> times;
    for (double period = 0.; period <= periods && !phases.empty(); ++period)
      for (const double x : phases)
        times.push_back((period + x) / p.frequency);
    return within(std::move(times), end_time);
  }

  std::vector<double>
  Segments::middles() const
  {
    std::vector<double> list;
    for (const Segment &segment : segments_)
      list.push_back(0.5 * (segment.first + segment.last));
    return list;
  }

  std::vector<Segments::SwitchingTime>
  Segments::switching_times(const double end_time) const
  {
    std::vector<SwitchingTime> list;
    for (unsigned int i = 0; i < segments_.size(); ++i)
    {
      const double f = parameters_.frequency, D = parameters_.duty_cycle, phase = fraction(segments_[i].phase);
      if (segments_[i].amplitude == 0.)
        continue;
      if (phase > 0. && phase < D)
        list.push_back({0., i, true});
      for (const auto &[x, on] : {std::pair(0., true), std::pair(D, false)})
        for (double period = 0., t = 0.; t <= end_time; period += 1.)
        {
          t = (period + x - phase) / f;
          if (t >= 0. && t <= end_time)
            list.push_back({t, i, on});
        }
    }
    std::ranges::stable_sort(list, {}, &SwitchingTime::time);
    return list;
  }

  double
  Segments::signal(const Segment &segment, const double x, const bool rate) const
  {
    if (smooth_)
    {
      const double most = parameters_.saturation.value_or(std::abs(segment.amplitude)),
                   y    = segment.amplitude * smooth_->value(x);
      if (rate)
        return std::abs(y) > most ? 0. : segment.amplitude * smooth_->rate(x);
      return std::clamp(y, -most, most);
    }
    const double phase = fraction(x), D = parameters_.duty_cycle;
    const bool is_on   = phase < D;
    const double since = is_on ? phase : phase - D, start = is_on ? segment.low : segment.high,
                 end = is_on ? segment.high : segment.low;
    if (since >= segment.front)
      return rate ? 0. : end;
    return rate ? (end - start) / segment.front : start + (end - start) * (since / segment.front);
  }

  std::vector<double>
  Segments::breaks(const Segment &segment) const
  {
    const double D = parameters_.duty_cycle;
    if (segment.amplitude == 0.)
      return {};
    if (!smooth_)
      return segment.front > 0. ? std::vector<double>{0., segment.front, D, D + segment.front}
                                : std::vector<double>{0., D};
    if (!parameters_.saturation || *parameters_.saturation >= std::abs(segment.amplitude))
      return {};
    const double cut =
      (smooth_step_inverse(*parameters_.saturation / std::abs(segment.amplitude)) - 0.5) * parameters_.front_width;
    return {cut, D - cut};
  }

  /// Evaluates one number per segment, then maps points to segments.
  std::unique_ptr<ActiveStressAtPoints>
  Segments::evaluator(const std::vector<double> &points, const bool rate) const
  {
    std::vector<std::size_t> segment; // of each point; in a gap the number of segments, where `now` is 0
    for (const double s : points)
    {
      const auto above =
        std::upper_bound(segments_.begin() + 1, segments_.end(), s, [](const double place, const Segment &next) {
          return place < next.first;
        });
      const auto i = static_cast<std::size_t>(above - segments_.begin()) - 1;
      segment.push_back(s <= segments_[i].last + round_off * length_ ? i : segments_.size());
    }
    std::vector<double> now(segments_.size() + 1, 0.);
    return stress_at_points([this, rate, segment, now](const double t, const std::span<double> m) mutable {
      const double f = parameters_.frequency, ramp = ramp_.value(t);
      for (std::size_t i = 0; i < segments_.size(); ++i)
      {
        const double x = f * t + segments_[i].phase;
        now[i]         = ramp * ((rate ? f : 1.) * signal(segments_[i], x, rate));
        if (rate && ramp_.end > 0.)
          now[i] += ramp_.rate(t) * signal(segments_[i], x, /*rate=*/false);
      }
      for (std::size_t p = 0; p < segment.size(); ++p)
        m[p] = now[segment[p]];
    });
  }

  /// Bounds from the fronts, which begin at 0 and at D, or half their width before if they are smooth.
  std::optional<ActiveStress::Bounds>
  Segments::bounds(const Box &box) const
  {
    const double f = parameters_.frequency;
    const double n = f * (box.t_to - box.t_from); // periods in the box
    Bounds largest{0., 0.};
    for (const Segment &segment : segments_)
    {
      const double width  = smooth_ ? parameters_.front_width : segment.front,
                   change = std::abs(smooth_ ? segment.amplitude : segment.high - segment.low),
                   value  = std::max({std::abs(segment.low), std::abs(segment.high), std::abs(segment.amplitude)});
      double slope        = 0.; // of a front, from 0 to 1, in periods
      for (const double begin : {0., parameters_.duty_cycle})
      {
        const double x = fraction(f * box.t_from + segment.phase - begin + (smooth_ ? 0.5 * width : 0.));
        for (const double from : {x, x - 1.})
          if (width > 0. && from < width && from + n > 0.)
            slope = std::max(slope, smooth_ ? largest_smooth_step_rate(from / width, (from + n) / width) : 1.);
      }
      const double rate = slope > 0. ? f * change * slope / width : 0.;
      largest           = {std::max(largest.value, value), std::max(largest.rate, rate)};
    }
    return ramp_.ramped(largest, box.t_from, box.t_to);
  }

  void
  Segments::report(std::ostream &out) const
  {
    out << fmt::format("Segments: {} of length {:g}, period {:g}, {}",
                       segments_.size(),
                       segments_[0].last - segments_[0].first,
                       1. / parameters_.frequency,
                       parameters_.switching);
    if (parameters_.rate_limit && !smooth_)
    {
      const Segment &slowest = *std::ranges::max_element(segments_, {}, &Segment::front);
      out << fmt::format("; the rate limit makes fronts of up to {:.4g} of a period", slowest.front);
    }
    out << fmt::format("; {} switching times\n", facts_.breaks_in_time.size());
  }
} // namespace crawler
