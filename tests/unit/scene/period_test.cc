// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/run_text.h"
#include "../../support/test.h"

#include <crawler/scene/period.h>

using namespace crawler;

namespace
{
  std::optional<ActiveStress::Repetition>
  repetition_of(const std::string &formula, const double end_time)
  {
    return test::parameters_with(test::set("T = {}; expression; Active stress = {}", end_time, formula))
      .create_scene()
      .active_stress->repetition();
  }

  /// Of what repeats from the beginning on.
  std::optional<double>
  period_of(const std::string &formula, const double end_time = 20.)
  {
    const auto found = repetition_of(formula, end_time);
    return found && found->from == 0. ? std::optional(found->period) : std::nullopt;
  }

  std::optional<double>
  period_of_wave(const std::string &sine, const std::string &cosine, const double speed, const double chi = 0.1)
  {
    const auto settings = test::with(test::wave(-1., chi, speed, 3.),
                                     "L = 2; optimal wave; Sine coefficients = {}; Cosine coefficients = {}",
                                     sine,
                                     cosine);
    return test::parameters_with(settings).create_scene().active_stress->period();
  }
} // namespace

/// Starts that end, or that die out below 1e-10, and not one that never does.
TEST(Period, BehindAStart)
{
  const auto repeats_behind = [](const std::string &start) {
    return repetition_of("sin(2*pi*(s-t/0.8))*sin(pi*s)*(" + start + ")", 40.);
  };
  for (const auto &[start, least, most] :
       std::initializer_list<std::tuple<const char *, double, double>>{{"1-exp(-6*t)", 23.0 / 6., 10.},
                                                                       {"min(1,t/4)", 4., 5.},
                                                                       {"1", 0., 0.},
                                                                       {"min(1,t/11)", 11., 20.},
                                                                       {"1-exp(-t)", 23., 30.}})
  {
    const auto found = repeats_behind(start);
    ASSERT_TRUE(found) << start;
    EXPECT_NEAR(found->period, 0.8, 1e-12) << start;
    EXPECT_GE(found->from, least) << start;
    EXPECT_LE(found->from, most) << start;
  }
  EXPECT_FALSE(repeats_behind("min(1,t/39)"));
  EXPECT_FALSE(repeats_behind("1-exp(-t/2)"));
  EXPECT_FALSE(repeats_behind("1+t"));
}

TEST(Period, OfWavesIsKnown)
{
  EXPECT_DOUBLE_EQ(period_of_wave("1", "0", 0.5).value(), 4.);
  EXPECT_DOUBLE_EQ(period_of_wave("1, 0.3", "0", -0.5).value(), 4.);
  EXPECT_DOUBLE_EQ(period_of_wave("0, 1", "0", 0.5).value(), 2.);
  EXPECT_DOUBLE_EQ(period_of_wave("0, 1, 0, 0, 0, 0.1", "0, 0, 0, 0.2, 0, 0", 0.5).value(), 2.);
  EXPECT_DOUBLE_EQ(period_of_wave("0, 0, 1, 0, 0, 0.1", "0", 0.5).value(), 4. / 3.);
  EXPECT_FALSE(period_of_wave("1", "0", 0.5, 0.));
}

TEST(Period, OfFormulasIsFound)
{
  using std::numbers::pi;
  EXPECT_NEAR(period_of("0.1*sin(2*pi*(s+t))").value(), 1., 1e-14);
  EXPECT_NEAR(period_of("0.1*sin(2*pi*(s-t/6.5))").value(), 6.5, 1e-13);
  EXPECT_NEAR(period_of("sin(s)*sin(sqrt(2)*t)^2").value(), pi / std::sqrt(2.), 1e-13);
  EXPECT_NEAR(period_of("sin(3*t+s)+sin(5*t+2*s)").value(), 2. * pi, 1e-13);
  EXPECT_NEAR(period_of("s*cos(40*t)").value(), pi / 20., 1e-14);
  EXPECT_NEAR(period_of("sin(2*pi*(s+t))*(1+0.3*cos(pi*t))").value(), 2., 1e-14);
  EXPECT_NEAR(period_of("1e-9*sin(2*pi*(s+t))").value(), 1., 1e-14);
}

/// A grid over the whole duration, of fewer times than there are periods, shows several of them as one.
TEST(Period, IsNoMultipleInLongRuns)
{
  for (const double end_time : {300., 1000., 2718.28, 3000., 17000.})
  {
    EXPECT_NEAR(period_of("0.2*sin(2*pi*(s+t))", end_time).value_or(0.), 1., 1e-12) << end_time;
    EXPECT_NEAR(
      period_of("0.2*sin(2*pi*s)*(1+cos(2*pi*t/0.37))*abs(sin(pi*t/1.11))", end_time).value_or(0.), 1.11, 1e-11)
      << end_time;
  }
  EXPECT_NEAR(period_of("0.2*sin(2*pi*(s+t))*sin(2*pi*t/41)", 1000.).value_or(0.), 20.5, 1e-10);
  EXPECT_NEAR(period_of("0.1*(mod(t,1.25)<0.5)*s", 300.).value_or(0.), 1.25, 1e-12);
}

/// Whether it adds to the waves or stops them, is short or takes a stride.
TEST(Period, IsNotInventedAroundAnEventOfALongRun)
{
  std::mt19937 generator(20261125);
  std::uniform_real_distribution<double> of_time(1., 999.), of_width(-4., 0.), of_size(-2., 0.);
  for (unsigned int i = 0; i < 20; ++i)
  {
    const double time = of_time(generator), width = std::pow(10., of_width(generator)),
                 size       = std::pow(10., of_size(generator));
    const std::string pulse = fmt::format("exp(-((t-{})/{})^2)", time, test::text(width)), wave = "0.2*sin(2*pi*(s+t))";
    const std::string adds  = fmt::format("{}+{}*sin(pi*s)*sin(2*pi*s)*{}", wave, test::text(size), pulse),
                      stops = fmt::format("{}*(1-{}*{})", wave, test::text(size), pulse),
                      window =
                        fmt::format("{}*(t>{} && t<{} ? {} : 1)", wave, time, time + width, test::text(1. - size));
    for (const std::string &formula : {adds, stops, window})
    {
      const auto found = repetition_of(formula, 1000.);
      EXPECT_TRUE(!found || found->from > time) << formula;
      if (time < 700.)
      {
        EXPECT_NEAR(found ? found->period : 0., 1., 1e-12) << formula;
      }
    }
  }
}

/// Where the derivative says nothing.
TEST(Period, OfPulsesIsFound)
{
  EXPECT_DOUBLE_EQ(period_of("(mod(t,1.25)<0.5)*0.1*s").value_or(0.), 1.25);
  EXPECT_DOUBLE_EQ(period_of("exp(-((mod(t,0.7)-0.3)/0.05)^2)*s").value_or(0.), 0.7);
  EXPECT_DOUBLE_EQ(period_of("mod(t,T/7)*s").value_or(0.), 20. / 7.);
}

TEST(Period, IsNotInvented)
{
  EXPECT_FALSE(period_of("0.1*sin(2*pi*(s+t*t/10))"));                      // chirp
  EXPECT_FALSE(period_of("0.1*sin(2*pi*s)*(1-exp(-t))"));                   // start-up
  EXPECT_FALSE(period_of("sin(t)+sin(sqrt(2)*t)*s"));                       // quasi-periodic
  EXPECT_FALSE(period_of("0.1*sin(2*pi*s)"));                               // steady
  EXPECT_FALSE(period_of("0*s"));                                           // nothing
  EXPECT_FALSE(period_of("0.1*sin(2*pi*(s+t))*(1-1e-8*t)"));                // decays slowly
  EXPECT_FALSE(period_of("0.1*sin(2*pi*(s+t))+1e-6*exp(-((t-10)/0.1)^2)")); // a single event
  EXPECT_FALSE(period_of("0.1*sin(2*pi*(s+t))", 1.9));                      // not twice within the duration
}
