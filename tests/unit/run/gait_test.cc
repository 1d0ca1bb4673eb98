// SPDX-License-Identifier: LGPL-2.1-or-later
// Gait numbers of motions that are known in closed form.
#include "../../support/test.h"

#include <crawler/run/gait.h>

namespace
{
  using namespace crawler;
  using std::numbers::pi;
  constexpr unsigned int n_s = GaitMeter::n_pieces;

  /// Shows a meter the motion zeta = s + u(s,t) + D(t) with the work @p work(t), in steps.
  void
  show(GaitMeter &meter,
       const std::function<double(double, double)> &u,
       const std::function<double(double)> &D,
       const std::function<double(double)> &work,
       const unsigned int n_steps)
  {
    const auto sample = [&](const double t) {
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
      EnergyBalance energy_balance;
      energy_balance.stress_work = work(t);
      meter.see_step(t, D(t), &energy_balance);
    }
  }

  TEST(GaitMeter, DescribesTheLastStrideOfAKnownPeriod)
  {
    const double period = 0.25;
    GaitMeter meter(period, false);
    EXPECT_DOUBLE_EQ(*meter.stride_start(), 0.75);
    // A wave towards s = 0, a body that moves to +s by 0.02 a stride: 0.03 in the first one.
    show(
      meter,
      [](const double s, const double t) { return 0.1 * std::cos(2. * pi * (s + 4. * t)) / (2. * pi); },
      [](const double t) { return t < 0.25 ? 0.12 * t : 0.03 + 0.08 * (t - 0.25); },
      [](const double t) { return 3. * t * t; },
      16);
    const auto gait = meter.gait();
    ASSERT_TRUE(gait);
    EXPECT_TRUE(gait->is_declared);
    EXPECT_DOUBLE_EQ(gait->n_strides, 4.);
    EXPECT_NEAR(gait->displacement, 0.02, 1e-15);
    EXPECT_NEAR(gait->energy_balance->stress_work, 3. * (1. - 0.75 * 0.75), 1e-14);
    EXPECT_NEAR(gait->wave->speed, -4., 0.01);
    EXPECT_STREQ(gait->direction(), "retrograde");
    EXPECT_NEAR(*gait->slip(), 1. - 0.08 / 4., 1e-4);
  }

  /// What a step has seen and no sample has is a wave that is not known.
  TEST(GaitMeter, KnowsNoWaveIfTheStepsSeeMoreThanTheSamples)
  {
    for (const bool is_missed : {false, true})
    {
      GaitMeter meter(0.25, false);
      for (unsigned int i = 0; i <= 128; ++i)
      {
        const double t = i / 128.;
        std::vector<double> u(n_s + 1);
        for (unsigned int j = 0; j <= n_s; ++j)
          u[j] = 0.01 * std::cos(2. * pi * (static_cast<double>(j) / n_s - 4. * t)) / (2. * pi);
        while (meter.next_time() <= t)
          meter.see(u, t);
        const bool has_pulse = is_missed && i == 101;
        meter.see_extremes(has_pulse ? 0.8 : 0.99, 1.01);
        meter.see_step(t, t, nullptr);
      }
      const auto gait = meter.gait();
      ASSERT_TRUE(gait);
      EXPECT_EQ(gait->wave.has_value(), !is_missed);
      EXPECT_EQ(gait->slip().has_value(), !is_missed);
      EXPECT_STREQ(gait->direction(), is_missed ? "none" : "prograde");
    }
  }

  TEST(GaitMeter, FindsThePeriodOfTheStretch)
  {
    const double period = 0.1037;
    GaitMeter meter(std::nullopt, false);
    show(
      meter,
      [&](const double s, const double t) {
        return (1. - std::exp(-20. * t)) * 0.1 * std::cos(2. * pi * (s - t / period)) / (2. * pi);
      },
      [&](const double t) { return 0.01 * t / period + 1e-3 * std::sin(2. * pi * t / period); },
      [&](const double t) { return 0.2 * t / period; },
      200);
    const auto gait = meter.gait();
    ASSERT_TRUE(gait);
    EXPECT_FALSE(gait->is_declared);
    EXPECT_NEAR(gait->period, period, 1e-4 * period);
    EXPECT_NEAR(gait->displacement, 0.01, 1e-4 * 0.01);
    EXPECT_NEAR(gait->energy_balance->stress_work, 0.2, 1e-4 * 0.2);
    EXPECT_NEAR(gait->wave->speed, 1. / period, 0.01 / period);
    EXPECT_STREQ(gait->direction(), "prograde");
  }

  TEST(GaitMeter, FindsNoPeriodWhereThereIsNone)
  {
    const auto none = [](double) { return 0.; };
    GaitMeter decay(std::nullopt, false), rest(std::nullopt, false), long_period(1.5, false);
    show(
      decay, [](const double s, const double t) { return 0.1 * std::exp(-t) * std::cos(pi * s); }, none, none, 50);
    EXPECT_FALSE(decay.gait());
    show(
      rest, [](double, double) { return 0.; }, none, none, 50);
    EXPECT_FALSE(rest.gait());
    EXPECT_EQ(long_period.next_time(), HUGE_VAL);
    EXPECT_FALSE(long_period.gait());
  }
} // namespace
