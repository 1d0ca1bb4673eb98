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
      meter.see_step(t, D(t), energy_balance);
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
