// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The generator "segments": closed forms of what each segment does, and when and where that jumps.
#include "../../support/expect_near.h"
#include "../../support/stress.h"
#include "../../support/test.h"

#include <crawler/scene/active_stress/segments.h>
#include <crawler/scene/active_stress/waves.h>

using namespace crawler;
using test::expect_near;

namespace
{
  using List = std::vector<double>;

  double
  value(const ActiveStress &stress, const double s, const double t)
  {
    return test::values(stress, {s}, t)[0];
  }

  double
  rate(const ActiveStress &stress, const double s, const double t)
  {
    return test::rates(stress, {s}, t)[0];
  }

  /// @p message is what is said, behind the name of the entry.
  void
  expect_complaint(const SegmentsParameters &parameters, const std::string &entry, const std::string &message)
  {
    EXPECT_EQ(test::complaint_of([&]() { Segments(parameters, 1., /*end_time=*/1.); }),
              "Active stress/Segments/" + entry + ": " + message);
  }
} // namespace

/// Four segments of a body of length 2, from the head: on for a quarter of the period of 0.5, one after the other.
TEST(Segments, SwitchOneAfterTheOther)
{
  const SegmentsParameters parameters{
    .number = 4, .amplitude = {1., 2., 3., 4.}, .frequency = 2., .phase_lag = 0.25, .duty_cycle = 0.25};
  const Segments stress(parameters, 2., 1.);
  for (unsigned int quarter = 0; quarter < 8; ++quarter)
    for (unsigned int i = 0; i < 4; ++i)
      for (const double place : {0.01, 0.25, 0.49})
        for (const double part : {0.02, 0.1, 0.98})
          EXPECT_EQ(value(stress, 0.5 * i + place, (quarter + part) * 0.125), i == 3 - quarter % 4 ? i + 1. : 0.);
  EXPECT_EQ(value(stress, 0., 0.4), 1.);
  EXPECT_EQ(value(stress, 2., 0.1), 4.);
  EXPECT_EQ(stress.period(), 0.5);
  expect_near(stress.breaks_in_space(), {0.5, 1., 1.5}, 1e-14);
  expect_near(stress.breaks_in_time(), {0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875}, 1e-14);

  auto backward      = parameters;
  backward.direction = "from tail to head";
  std::reverse(backward.amplitude.begin(), backward.amplitude.end());
  const Segments mirrored(backward, 2., 1.);
  for (const double s : {0.1, 0.6, 1.2, 1.9})
    for (const double t : {0.01, 0.2, 0.33, 0.49})
      EXPECT_EQ(value(mirrored, 2. - s, t), value(stress, s, t));
}

/// m_(i-1)(t) = m_i(t - lag P), for all kinds of switching; and the phase is a shift of the time.
TEST(Segments, PhaseLagShifts)
{
  for (const bool smooth : {false, true})
    for (const std::optional<double> limit : {std::optional<double>(), std::optional(8.)})
    {
      SegmentsParameters parameters{.number      = 5,
                                    .frequency   = 2.,
                                    .phase_lag   = 0.17,
                                    .duty_cycle  = 0.3,
                                    .switching   = smooth ? "smooth" : "square",
                                    .front_width = 0.2,
                                    .rate_limit  = limit};
      const Segments stress(parameters, 1., 1.);
      parameters.phase = 0.4;
      const Segments shifted(parameters, 1., 1.);
      for (double t = 0.013; t < 1.; t += 0.0371)
      {
        for (const double s : {0.9, 0.7, 0.5, 0.3})
          EXPECT_NEAR(value(stress, s - 0.2, t), value(stress, s, t - 0.17 / 2. + 0.5), 1e-12);
        EXPECT_NEAR(value(shifted, 0.5, t), value(stress, 0.5, t + 0.4 / 2.), 1e-12);
        EXPECT_NEAR(value(stress, 0.5, t), value(stress, 0.5, t + 0.5), 1e-12);
      }
    }
}

/// A = 1 at the rate 10 needs 0.1 of a period of 1: a trapezoid.
TEST(Segments, RateLimitMakesTrapezoids)
{
  const Segments stress({.number = 1, .amplitude = {-1.}, .duty_cycle = 0.4, .rate_limit = 10.}, 1., 2.);
  struct Expected
  {
    double t, m, m_t;
  };
  const std::vector<Expected> expected = {
    {0.05, -0.5, -10.}, {0.09, -0.9, -10.}, {0.2, -1., 0.}, {0.42, -0.8, 10.}, {0.47, -0.3, 10.}, {0.7, 0., 0.}};
  for (const auto &[t, m, m_t] : expected)
  {
    EXPECT_NEAR(value(stress, 0.5, t), m, 1e-14);
    EXPECT_NEAR(rate(stress, 0.5, t), m_t, 1e-13);
  }
  expect_near(stress.breaks_in_time(), {0.1, 0.4, 0.5, 1., 1.1, 1.4, 1.5}, 1e-14);
}

/// The actuator that goes towards the square signal with the limited rate, step by step, once its start is forgotten.
TEST(Segments, RateLimitIsThatOfAnActuator)
{
  for (const double D : {0.15, 0.3, 0.8})
    for (const double limit : {0.4, 1.1, 2., 8.})
    {
      const Segments limited({.number = 1, .amplitude = {1.}, .duty_cycle = D, .rate_limit = limit}, 1., 1.);
      constexpr unsigned int n = 20000, periods = 12;
      double y = 0.;
      for (unsigned int j = 0; j < n * periods; ++j)
      {
        const double x = static_cast<double>(j % n) / n, wanted = x < D ? 1. : 0.;
        if (j >= n * (periods - 1))
        {
          ASSERT_NEAR(value(limited, 0.5, x), y, 1e-3) << D << " " << limit << " " << x;
        }
        y += std::clamp(wanted - y, -limit / n, limit / n);
      }
    }
}

/// |m| <= saturation: lower squares, and smooth fronts that are cut where S = saturation/A, in closed form.
TEST(Segments, Saturation)
{
  const Segments square({.number = 1, .amplitude = {-3.}, .saturation = 2., .rate_limit = 20.}, 1., 1.);
  EXPECT_EQ(value(square, 0.5, 0.2), -2.);
  EXPECT_NEAR(value(square, 0.5, 0.05), -1., 1e-14);

  const SegmentsParameters parameters{.number = 1, .amplitude = {3.}, .switching = "smooth", .front_width = 0.2};
  auto cut       = parameters;
  cut.saturation = 2.;
  const Segments whole(parameters, 1., 1.), saturated(cut, 1., 1.);
  EXPECT_EQ(whole.breaks_in_time(), List());
  const List kinks = saturated.breaks_in_time();
  ASSERT_EQ(kinks.size(), 2u);
  for (const double t : kinks)
  {
    EXPECT_NEAR(value(whole, 0.5, t), 2., 1e-13);
    EXPECT_NEAR(rate(saturated, 0.5, t - 1e-6) * rate(saturated, 0.5, t + 1e-6), 0., 1e-12);
    EXPECT_GT(std::abs(rate(saturated, 0.5, t - 1e-6)) + std::abs(rate(saturated, 0.5, t + 1e-6)), 1.);
  }
  for (double t = 0.; t < 1.; t += 0.01)
    EXPECT_EQ(value(saturated, 0.5, t), std::min(value(whole, 0.5, t), 2.));
  for (const double y : {1e-6, 0.2, 0.5, 0.9})
    EXPECT_NEAR(smooth_step(smooth_step_inverse(y)), y, 1e-14);
  for (const double x : {-1., 0., 1e-200, 1. - 1e-16, 1., 2.})
    EXPECT_NEAR(smooth_step_rate(x), 0., 1e-100) << x;
}

/// Against central differences away from the jumps, with a ramp; and there is no period then.
TEST(Segments, RatesAreDerivatives)
{
  for (const bool smooth : {false, true})
  {
    const Segments stress({.number        = 3,
                           .amplitude     = {0.2, -0.3, 0.4},
                           .duty_cycle    = 0.4,
                           .switching     = smooth ? "smooth" : "square",
                           .front_width   = 0.3,
                           .saturation    = 0.35,
                           .rate_limit    = smooth ? std::optional<double>() : std::optional(2.),
                           .ramp_duration = 1.5},
                          1.,
                          2.);
    EXPECT_EQ(stress.period(), std::nullopt);
    EXPECT_EQ(value(stress, 0.5, 0.), 0.);
    const List kinks     = stress.breaks_in_time();
    constexpr double h   = 1e-5;
    unsigned int n_times = 0;
    for (double t = 0.0137; t < 2.; t += 0.0237)
    {
      if (std::any_of(kinks.begin(), kinks.end(), [&](const double kink) { return std::abs(kink - t) < 2. * h; }))
        continue;
      ++n_times;
      for (const double s : {0.1, 0.5, 0.9})
        EXPECT_NEAR(rate(stress, s, t), (value(stress, s, t + h) - value(stress, s, t - h)) / (2. * h), 1e-6);
    }
    EXPECT_GT(n_times, 70u);
  }
}

/// Passive parts, of half the length of a segment: L = 3 segments and 2 gaps.
TEST(Segments, Gaps)
{
  const Segments stress({.number = 3, .amplitude = {1.}, .phase_lag = 0., .gap = 0.5}, 8., 1.);
  expect_near(stress.breaks_in_space(), {3., 2., 6., 5.}, 1e-14);
  for (const double s : {0., 1.9, 3.1, 4.9, 6.1, 8.})
    EXPECT_EQ(value(stress, s, 0.1), 1.);
  for (const double s : {2.1, 2.9, 5.1, 5.9})
    EXPECT_EQ(value(stress, s, 0.1), 0.);
}

/// At the middle of its segments it is the travelling wave with the smoothed square profile, 0 and A instead of -A and
/// A.
TEST(Segments, ManyAreATravellingWave)
{
  constexpr unsigned int n = 64;
  const Segments stress({.number      = n,
                         .amplitude   = {0.2},
                         .frequency   = 1.5,
                         .phase_lag   = 1. / n,
                         .duty_cycle  = 0.4,
                         .switching   = "smooth",
                         .front_width = 0.3},
                        1.,
                        1.);
  TravellingWaveParameters parameters;
  parameters.amplitude           = 0.1;
  parameters.given_by            = "frequency";
  parameters.frequency           = 1.5;
  parameters.profile.profile     = "smoothed square";
  parameters.profile.duty_cycle  = 0.4;
  parameters.profile.front_width = 0.3;
  const TravellingWave wave(parameters, 1., 1.);
  // The wave has its phase at s = 0; find that of the first segment, whose phase is 0 at t = 0, by a shift of time.
  const double shift = (1. - 0.5 / n) / 1.5;
  for (unsigned int i = 0; i < n; ++i)
    for (const double t : {0.05, 0.4, 0.77})
    {
      const double s = (i + 0.5) / n;
      EXPECT_NEAR(value(stress, s, t + shift), 0.1 + value(wave, s, t), 1e-12) << s << " " << t;
    }
}

TEST(Segments, SaysWhatIsWrong)
{
  EXPECT_NO_THROW(Segments({}, 1., 1.));
  expect_complaint({.amplitude = {}},
                   "Amplitude",
                   "the list of amplitudes has 0 numbers, but 1 or 8, one for each segment, are expected");
  expect_complaint({.duty_cycle = 0.1, .switching = "smooth", .front_width = 0.2},
                   "Front width",
                   "the fronts are 0.2 of a period wide, but at most 0.1 is expected for the duty cycle 0.1");
  expect_complaint(
    {.amplitude = {0.5}, .switching = "smooth", .front_width = 0.1, .rate_limit = 5.},
    "Rate limit",
    "the smooth fronts change by up to 10 per time, but at most 5, the rate limit, is expected; make Front "
    "width 0.2 or more, or Switching square");
  expect_complaint(
    {.amplitude = {0.5}, .switching = "smooth", .front_width = 0.1, .rate_limit = 1.},
    "Rate limit",
    "the smooth fronts change by up to 10 per time, but at most 1, the rate limit, is expected; make Switching square");
  EXPECT_NO_THROW(Segments({.amplitude = {0.5}, .switching = "smooth", .front_width = 0.2, .rate_limit = 5.}, 1., 1.));
  expect_complaint({.number = 4, .frequency = 1e6, .phase_lag = 0.25},
                   "Frequency",
                   "the segments switch at 4e+06 different times until the end time, but at most 1e+06 are expected");
}

// What a controller is told gives back the signal: a segment is on between its switching times.
TEST(Segments, SwitchingTimesTellWhichSegmentsAreOn)
{
  const SegmentsParameters settings = {.number     = 5,
                                       .amplitude  = {0.3, 0.3, 0., 0.3, 0.3},
                                       .frequency  = 0.8,
                                       .phase_lag  = 0.3,
                                       .duty_cycle = 0.35,
                                       .phase      = 0.1};
  const double length = 2., end_time = 6.;
  const Segments stress(settings, length, end_time);
  const auto times  = stress.switching_times(end_time);
  const auto places = stress.middles();
  ASSERT_EQ(places.size(), 5u);
  EXPECT_GT(times.size(), 4 * 2 * 0.8 * end_time - 8);
  std::vector<bool> on(places.size(), false);
  std::size_t next = 0;
  for (double t = 0.001; t < end_time; t += 0.0137)
  {
    for (; next < times.size() && times[next].time <= t; ++next)
    {
      EXPECT_NE(on[times[next].segment], times[next].on) << "at t = " << times[next].time;
      on[times[next].segment] = times[next].on;
    }
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_EQ(value(stress, places[i], t), on[i] ? 0.3 : 0.) << "segment " << i << " at t = " << t;
  }
}
