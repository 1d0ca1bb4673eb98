// SPDX-License-Identifier: LGPL-2.1-or-later
// Gait numbers of motions that are known in closed form.
#include <crawler/drivers/gait.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace
{
  using namespace crawler;
  constexpr double pi        = std::numbers::pi;
  constexpr unsigned int n_s = GaitMeter::n_pieces, n_t = GaitMeter::n_phases;

  std::vector<std::vector<double>>
  samples(const std::function<double(double, double)> &e, const double period, const double length)
  {
    std::vector<std::vector<double>> stretch(n_t, std::vector<double>(n_s));
    for (unsigned int j = 0; j < n_t; ++j)
      for (unsigned int i = 0; i < n_s; ++i)
        stretch[j][i] = 1. + e(length * (i + 0.5) / n_s, period * j / n_t);
    return stretch;
  }

  /// Shows a meter the motion zeta = s + u(s,t) + D(t) with the work @p work(t), in steps.
  void
  show(GaitMeter &meter,
       const std::function<double(double, double)> &u,
       const std::function<double(double)> &D,
       const std::function<double(double)> &work,
       const unsigned int n_steps)
  {
    const auto sample = [&](const double t)
    {
      std::vector<double> ends(n_s + 1);
      for (unsigned int i = 0; i <= n_s; ++i)
        ends[i] = u(static_cast<double>(i) / n_s, t) + D(t);
      meter.see(ends, D(t));
    };
    for (unsigned int i = 0; i <= n_steps; ++i)
    {
      const double t = static_cast<double>(i) / n_steps;
      while (meter.next_time() <= t)
        sample(meter.next_time());
      Ledger ledger;
      ledger.stress_power = work(t);
      meter.see_step(t, D(t), &ledger);
    }
  }

  TEST(StretchWave, TravelsWithItsSpeed)
  {
    for (const double speed : {-1.5, 0.5})
      for (const int n : {1, 2, 3})
      {
        const double length = 2., period = length / (n * std::abs(speed));
        const auto wave =
          measure_wave(samples(
                         [&](const double s, const double t) // with something that rests
                         {
                           return 0.2 * std::sin(5. * s) + 0.3 * std::sin(2. * pi * n * (s - speed * t) / length);
                         },
                         period,
                         length),
                       period,
                       length);
        ASSERT_TRUE(wave);
        EXPECT_NEAR(wave->speed, speed, 2e-3 * std::abs(speed));
        EXPECT_NEAR(wave->coherence, 1., 1e-3);
      }
  }

  TEST(StretchWave, OfTwoWavesTheStrongerOneWins)
  {
    // e = A sin(q(s+t)) + B sin(q(s-t)): <e_t e_s> = q^2 (A^2 - B^2)/2, <e_s^2> = <e_t^2> = q^2 (A^2 + B^2)/2.
    const double A = 0.2, B = 0.1;
    const auto wave = measure_wave(samples(
                                     [&](const double s, const double t)
                                     {
                                       return A * std::sin(2. * pi * (s + t)) + B * std::sin(2. * pi * (s - t));
                                     },
                                     1.,
                                     1.),
                                   1.,
                                   1.);
    ASSERT_TRUE(wave);
    const double expected = (A * A - B * B) / (A * A + B * B);
    EXPECT_NEAR(wave->coherence, expected, 0.1 * expected); // the ends are not seen
    EXPECT_NEAR(wave->speed, -expected, 0.1 * expected);
  }

  TEST(StretchWave, AStandingWaveDoesNotTravelAndNothingIsNoWave)
  {
    const auto wave = measure_wave(samples(
                                     [&](const double s, const double t)
                                     {
                                       return 0.2 * std::sin(pi * s) * std::sin(2. * pi * t);
                                     },
                                     1.,
                                     1.),
                                   1.,
                                   1.);
    ASSERT_TRUE(wave);
    EXPECT_LT(wave->coherence, 1e-10);
    const Gait gait{1., true, 1., 0.1, wave};
    EXPECT_STREQ(gait.direction(), "standing");
    EXPECT_FALSE(gait.slip());
    EXPECT_FALSE(measure_wave(samples(
                                [](double, double)
                                {
                                  return 0.1;
                                },
                                1.,
                                1.),
                              1.,
                              1.));
  }

  TEST(GaitMeter, DescribesTheLastStrideOfAKnownPeriod)
  {
    const double period = 0.25;
    GaitMeter meter(period, false);
    EXPECT_DOUBLE_EQ(*meter.stride_start(), 0.75);
    // A wave towards s = 0, a body that moves to +s by 0.02 a stride: 0.03 in the first one.
    show(
      meter,
      [](const double s, const double t)
      {
        return 0.1 * std::cos(2. * pi * (s + 4. * t)) / (2. * pi);
      },
      [](const double t)
      {
        return t < 0.25 ? 0.12 * t : 0.03 + 0.08 * (t - 0.25);
      },
      [](const double t)
      {
        return 3. * t * t;
      },
      16);
    const auto gait = meter.gait();
    ASSERT_TRUE(gait);
    EXPECT_TRUE(gait->is_declared);
    EXPECT_DOUBLE_EQ(gait->n_strides, 4.);
    EXPECT_NEAR(gait->displacement, 0.02, 1e-15);
    EXPECT_NEAR(gait->ledger->stress_power, 3. * (1. - 0.75 * 0.75), 1e-14);
    EXPECT_NEAR(gait->wave->speed, -4., 0.01);
    EXPECT_STREQ(gait->direction(), "retrograde");
    EXPECT_NEAR(*gait->slip(), 1. - 0.08 / 4., 1e-4);
  }

  TEST(GaitMeter, FindsThePeriodOfTheStretch)
  {
    const double period = 0.1037;
    GaitMeter meter(std::nullopt, false);
    show(
      meter,
      [&](const double s, const double t)
      {
        return (1. - std::exp(-20. * t)) * 0.1 * std::cos(2. * pi * (s - t / period)) / (2. * pi);
      },
      [&](const double t)
      {
        return 0.01 * t / period + 1e-3 * std::sin(2. * pi * t / period);
      },
      [&](const double t)
      {
        return 0.2 * t / period;
      },
      200);
    const auto gait = meter.gait();
    ASSERT_TRUE(gait);
    EXPECT_FALSE(gait->is_declared);
    EXPECT_NEAR(gait->period, period, 1e-4 * period);
    EXPECT_NEAR(gait->displacement, 0.01, 1e-4 * 0.01);
    EXPECT_NEAR(gait->ledger->stress_power, 0.2, 1e-4 * 0.2);
    EXPECT_NEAR(gait->wave->speed, 1. / period, 0.01 / period);
    EXPECT_STREQ(gait->direction(), "prograde");
  }

  TEST(GaitMeter, FindsNoPeriodWhereThereIsNone)
  {
    const auto none = [](double)
    {
      return 0.;
    };
    GaitMeter decay(std::nullopt, false), rest(std::nullopt, false), long_period(1.5, false);
    show(
      decay,
      [](const double s, const double t)
      {
        return 0.1 * std::exp(-t) * std::cos(pi * s);
      },
      none,
      none,
      50);
    EXPECT_FALSE(decay.gait());
    show(
      rest,
      [](double, double)
      {
        return 0.;
      },
      none,
      none,
      50);
    EXPECT_FALSE(rest.gait());
    EXPECT_EQ(long_period.next_time(), HUGE_VAL);
    EXPECT_FALSE(long_period.gait());
  }
} // namespace
