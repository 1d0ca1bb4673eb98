// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The generators travelling wave, standing wave and pulse against formulas of s and t, and what they know of
// themselves.
#include "../../support/expect_near.h"
#include "../../support/stress.h"
#include "../../support/test.h"

using namespace crawler;
using test::Settings;
using test::stress_with;
using test::values;

namespace
{
  using std::numbers::pi;

  /// Settings of a generator, whose entries are named without its section.
  Settings
  generator(const std::string &entries, const double length, const double end_time)
  {
    return test::with(test::set(entries), "L = {}; T = {}", length, end_time);
  }
  Settings
  travelling(const std::string &entries, const double length = 1., const double end_time = 5.)
  {
    return generator("travelling wave; " + entries, length, end_time);
  }
  Settings
  standing(const std::string &entries, const double length = 1., const double end_time = 5.)
  {
    return generator("standing wave; " + entries, length, end_time);
  }
  Settings
  pulse(const std::string &entries, const double length = 1., const double end_time = 5.)
  {
    return generator("pulse; " + entries, length, end_time);
  }

  void
  expect_formula(const Settings &settings, const std::string &formula, const double length = 1.)
  {
    const auto stress   = stress_with(settings);
    const auto expected = stress_with(test::with(settings, "expression; Active stress = {}", formula));
    const auto points   = equal_parts(0., length, 53);
    for (const double t : {0., 0.013, 0.3, 0.71, 1.9, 4.77})
      EXPECT_LT(test::largest_difference(values(*stress, points, t), values(*expected, points, t)), 2e-14)
        << formula << " at t = " << t;
  }

  /// The smooth step as a formula of @p x.
  std::string
  step(const std::string &argument)
  {
    const std::string x = "(" + argument + ")";
    return "(" + x + " <= 0.002 ? 0 : " + x + " >= 0.998 ? 1 : 1/(1 + exp(1/" + x + " - 1/(1-" + x + "))))";
  }

  /// The smoothed switch with fronts of width @p w of the period about 0 and @p duty, from -1 to 1.
  std::string
  smoothed(const std::string &x, const std::string &duty, const std::string &w)
  {
    const auto front = [&](const std::string &middle) {
      return step("(mod(" + x + " - (" + middle + ") + 0.5, 1) - 0.5)/" + w + " + 0.5");
    };
    // Up near 0 and down near duty, each as a step within half a period of its middle.
    return "(2*(mod(" + x + " + (1-" + duty + ")/2, 1) < 0.5 ? " + front("0") + " : 1 - " + front(duty) + ") - 1)";
  }
} // namespace

TEST(TravellingWave, SineIsTheFormula)
{
  expect_formula(travelling("Amplitude = 0.3; Phase = 0.4; Frequency = 1.3"), "0.3*sin(2*pi*(s + 1.3*t) + 0.4)");
  expect_formula(travelling("Amplitude = -0.3; Offset = 0.2; Wave number = 1.7; Direction = from tail to head; Given "
                            "by = wave speed; Wave speed = 0.6",
                            2.),
                 "0.2 - 0.3*sin(2*pi*1.7/2*(s - 0.6*t))",
                 2.);
  expect_formula(travelling("Wave number = 0; Offset = -1"), "-1 + 0.1*sin(2*pi*t)");
  expect_formula(travelling("Frequency = 0; Wave number = 3"), "0.1*sin(6*pi*s)");
}

TEST(TravellingWave, WindowAndRampAreFactors)
{
  expect_formula(travelling("Offset = 0.2; Window start = 0.3; Window end = 0.8"),
                 "(s < 0.3 || s >= 0.8 ? 0 : 0.2 + 0.1*sin(2*pi*(s + t)))");
  expect_formula(travelling("Offset = 0.2; Window start = 0.25; Window edge = 0.125; Ramp duration = 2"),
                 step("(s-0.25)*8") + "*" + step("(t/2)") + "*(0.2 + 0.1*sin(2*pi*(s + t)))");
  // An end of the body that is given has an edge.
  expect_formula(travelling("Window start = 0.2; Window end = 1; Window edge = 0.25"),
                 step("(s-0.2)*4") + "*" + step("(1-s)*4") + "*0.1*sin(2*pi*(s + t))");
}

TEST(TravellingWave, SquareIsTheFormula)
{
  // At no place of these is a jump.
  expect_formula(travelling("Profile = square; Phase = 0.1"), "0.1*(mod(s + t + 0.05/pi, 1) < 0.5 ? 1 : -1)");
  expect_formula(
    travelling("Profile = square; Duty cycle = 0.2; Phase = 0.1; Direction = from tail to head; Wave number = 2"),
    "0.1*(mod(2*s - t + 0.05/pi, 1) < 0.2 ? 1 : -1)");
  for (const auto &[duty, front] : {std::pair("0.3", "0.2"), {"0.5", "0.5"}, {"0.8", "0.2"}})
    expect_formula(
      travelling(fmt::format(
        "Profile = smoothed square; Duty cycle = {}; Front width = {}; Phase = 0.1; Offset = 0.05", duty, front)),
      "0.05 + 0.1*" + smoothed("(s + t + 0.05/pi)", duty, front));
}

TEST(TravellingWave, RateIsExact)
{
  const std::vector<double> times = {0.1, 0.37, 1.9};
  for (const std::string profile : {"sine", "smoothed square"})
    for (const std::string ramp : {"0", "1.5"})
      test::expect_rate(
        *stress_with(travelling("Profile = " + profile +
                                "; Front width = 0.4; Offset = 0.3; Wave number = 1.6; Ramp duration = " + ramp +
                                "; Window end = 0.7; Window edge = 0.2")),
        1.,
        times,
        1e-6);
  EXPECT_EQ(stress_with(travelling("Profile = square"))->rate_at({0.}), nullptr);
  EXPECT_NE(stress_with(travelling("Profile = square; Frequency = 0"))->rate_at({0.}), nullptr);
}

TEST(TravellingWave, PeriodAndBreaks)
{
  using Places = std::vector<double>;
  EXPECT_EQ(stress_with(travelling("Frequency = 1.6"))->period(), 1. / 1.6);
  EXPECT_EQ(stress_with(travelling("Given by = wave speed; Wave speed = 0.5; Wave number = 2", 4.))->period(), 4.);
  EXPECT_EQ(stress_with(travelling("Frequency = 0"))->period(), std::nullopt);
  EXPECT_EQ(stress_with(travelling("Amplitude = 0"))->period(), std::nullopt);
  EXPECT_EQ(stress_with(travelling("Ramp duration = 1"))->period(), std::nullopt);

  const auto sharp = stress_with(travelling("Profile = square; Window start = 0.25; Window end = 1"));
  EXPECT_EQ(sharp->breaks_in_space(), Places{0.25});
  EXPECT_EQ(stress_with(travelling("Window start = 0.25; Window edge = 0.1"))->breaks_in_space(), Places{});
  EXPECT_EQ(sharp->breaks_in_time(), Places{}); // they move
  const auto still =
    stress_with(travelling("Profile = square; Wave number = 1.5; Frequency = 0; Duty cycle = 0.75", 3.));
  EXPECT_EQ(still->breaks_in_space(), (Places{1.5, 2.}));
  for (const std::string direction : {"from head to tail", "from tail to head"})
  {
    const auto at_once = stress_with(travelling("Profile = square; Wave number = 0; Direction = " + direction +
                                                  "; Phase = " + test::text(0.5 * pi) + "; Duty cycle = 0.375",
                                                1.,
                                                2.));
    auto times         = at_once->breaks_in_time();
    std::sort(times.begin(), times.end());
    const Places expected =
      direction == "from head to tail" ? Places{0.125, 0.75, 1.125, 1.75} : Places{0.25, 0.875, 1.25, 1.875};
    test::expect_near(times, expected, 1e-14);
    for (const double t : times)
      EXPECT_NEAR(std::abs(values(*at_once, {0.5}, t + 1e-9)[0] - values(*at_once, {0.5}, t - 1e-9)[0]), 0.2, 1e-14);
  }
}

TEST(TravellingWave, SaysThatJumpsMove)
{
  const auto said = [](const std::string &entries) {
    std::ostringstream out;
    stress_with(travelling(entries))->report(out);
    return out.str();
  };
  EXPECT_NE(said("Profile = square").find("Profile = smoothed square"), std::string::npos);
  EXPECT_EQ(said("Profile = square; Wave number = 0"), "");
  EXPECT_EQ(said("Profile = smoothed square"), "");
}

/// Fronts in the place of jumps that move, and only of these: the same but within half a front of the jumps.
TEST(TravellingWave, HasFrontsInsteadOfMovingJumps)
{
  const auto fronts = [](const ActiveStress &stress, const double part) {
    return dynamic_cast<const KnownStress &>(stress).with_fronts(part);
  };
  const auto square = stress_with(travelling("Profile = square; Duty cycle = 0.3"));
  const auto smooth = fronts(*square, 0.1);
  ASSERT_TRUE(smooth);
  const auto places  = equal_parts(0., 1., 1000);
  const auto jumping = values(*square, places, 0.37), with_fronts = values(*smooth, places, 0.37);
  std::size_t n_other = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    n_other += std::abs(jumping[i] - with_fronts[i]) > 1e-12;
  EXPECT_GT(n_other, 0u);
  EXPECT_LT(n_other, 150u); // a front takes 0.03 of a wave
  for (const char *still :
       {"Profile = smoothed square", "Profile = square; Frequency = 0", "Profile = square; Wave number = 0"})
    EXPECT_FALSE(fronts(*stress_with(travelling(still)), 0.5));
}

TEST(StandingWave, IsTheFormula)
{
  expect_formula(standing("Amplitude = 0.3; Offset = -0.1; Wave number = 1.5; Phase in space = 0.3; Phase = 0.7; "
                          "Frequency = 0.8; Ramp duration = 3; Window end = 1.5",
                          2.),
                 "(s > 1.5 ? 0 : 1)*" + step("(t/3)") + "*(-0.1 + 0.3*cos(2*pi*1.5*s/2 + 0.3)*sin(2*pi*0.8*t + 0.7))",
                 2.);
  expect_formula(standing("Profile = square; Duty cycle = 0.25; Phase = 0.1"),
                 "0.1*cos(2*pi*s)*(mod(t + 0.05/pi, 1) < 0.25 ? 1 : -1)");
}

TEST(StandingWave, RatePeriodAndBreaks)
{
  for (const std::string ramp : {"0", "1.5"})
    for (const std::string profile : {"sine", "smoothed square"})
      test::expect_rate(
        *stress_with(standing("Profile = " + profile + "; Front width = 0.4; Offset = 1; Ramp duration = " + ramp)),
        1.,
        {0.07, 0.45, 1.4},
        1e-6);
  EXPECT_EQ(stress_with(standing("Profile = square"))->rate_at({0.}), nullptr);
  EXPECT_EQ(stress_with(standing("Frequency = 4"))->period(), 0.25);
  EXPECT_EQ(stress_with(standing("Frequency = 4; Ramp duration = 0.1"))->period(), std::nullopt);
  EXPECT_EQ(stress_with(standing("Frequency = 0"))->period(), std::nullopt);
  EXPECT_EQ(stress_with(standing("Profile = square; Frequency = 0.5"))->breaks_in_time(),
            (std::vector<double>{1., 2., 3., 4.}));
  EXPECT_TRUE(stress_with(standing(""))->breaks_in_time().empty());
  EXPECT_EQ(stress_with(standing("Window start = 0.5"))->breaks_in_space(), std::vector<double>{0.5});
}

TEST(Pulse, IsTheFormula)
{
  expect_formula(pulse("Start position = -0.3; Speed = 0.4; Width = 0.2"), "0.3*exp(-((s + 0.3 - 0.4*t)/0.2)^2)");
  expect_formula(
    pulse("Direction = from head to tail; Speed = 0.4; Amplitude = -1", 2.), "-exp(-((s - 2.6 + 0.4*t)/0.1)^2)", 2.);
  expect_formula(pulse("Shape = compact; Width = 0.5; Ramp duration = 1; Window start = 0.3"),
                 "(s < 0.3 ? 0 : 1)*" + step("t") +
                   "*(abs((s + 0.5 - t)/0.5) < 0.9999 ? 0.3*exp(1 - 1/(1 - ((s + 0.5 - t)/0.5)^2)) : 0)");
  expect_formula(pulse("Speed = 0; Start position = 0.5"), "0.3*exp(-((s - 0.5)/0.1)^2)");
}

/// Pulses at the distance v P, those before the first included.
TEST(Pulse, Repeats)
{
  const double P = 0.75, v = 0.8, w = 0.2;
  const auto stress = stress_with(pulse("Repetition period = " + test::text(P) + "; Speed = " + test::text(v) +
                                        "; Width = " + test::text(w) + "; Start position = 0.1"));
  const auto points = equal_parts(0., 1., 40);
  for (const double t : {0., 0.4, 0.75, 2.9})
  {
    std::vector<double> expected;
    for (const double s : points)
    {
      double sum = 0.;
      for (int j = -20; j <= 20; ++j)
      {
        const double z = (s - 0.1 - v * (t - j * P)) / w;
        sum += 0.3 * std::exp(-z * z);
      }
      expected.push_back(sum);
    }
    EXPECT_LT(test::largest_difference(values(*stress, points, t), expected), 1e-14);
    EXPECT_LT(test::largest_difference(values(*stress, points, t), values(*stress, points, t + P)), 1e-14);
  }
  EXPECT_EQ(stress->period(), P);
  test::expect_rate(*stress, 1., {0.2, 0.75, 1.1}, 1e-7);
}

TEST(Pulse, PeriodAndBreaks)
{
  EXPECT_EQ(stress_with(pulse(""))->period(), std::nullopt);
  EXPECT_EQ(stress_with(pulse("Repetition period = 2; Ramp duration = 1"))->period(), std::nullopt);
  EXPECT_EQ(stress_with(pulse("Repetition period = 2; Amplitude = 0"))->period(), std::nullopt);
  EXPECT_TRUE(stress_with(pulse(""))->breaks_in_space().empty());
  EXPECT_EQ(stress_with(pulse("Window end = 0.5"))->breaks_in_space(), std::vector<double>{0.5});
  for (const std::string direction : {"from tail to head", "from head to tail"})
    test::expect_rate(*stress_with(pulse("Ramp duration = 2; Shape = compact; Width = 0.5; Direction = " + direction +
                                         "; Repetition period = 4")),
                      1.,
                      {0.7, 1.3, 4.63},
                      1e-6);
}

TEST(Waves, RefuseWhatMakesNoSense)
{
  using test::expect_complaint;
  expect_complaint(travelling("Profile = smoothed square; Duty cycle = 0.2; Front width = 0.3"),
                   {"Active stress/Travelling wave/Front width: ", "0.3 of a period", "at most 0.2"});
  expect_complaint(travelling("Given by = wave speed; Wave number = 0"),
                   {"Active stress/Travelling wave/Given by: ", "wave number 0 has no speed"});
  expect_complaint(travelling("Frequency = 1e9"),
                   {"Active stress/Travelling wave/Frequency: ", "5e+09 periods", "at most 1e+08"});
  expect_complaint(travelling("Frequency = 1e6; Profile = square; Wave number = 0"),
                   {"Active stress/Travelling wave/Frequency: ", "at most 1e+06 are expected if it jumps"});
  expect_complaint(travelling("Window start = 0.7; Window end = 0.6"),
                   {"Active stress/Travelling wave/Window start: ", "starts at s = 0.7", "its end, 0.6"});
  expect_complaint(travelling("Window end = 1.5"), {"Active stress/Travelling wave/Window end: ", "at most 1,"});
  expect_complaint(standing("Window start = 0.5; Window edge = 0.6"),
                   {"Active stress/Standing wave/Window edge: ", "0.6 wide", "at most 0.5"});
  expect_complaint(standing("Profile = square; Frequency = 1e6"),
                   {"Active stress/Standing wave/Frequency: ", "at most 1e+06"});
  expect_complaint(pulse("Repetition period = 0.05"),
                   {"Active stress/Pulse/Repetition period: ", "at a distance of 0.05", "their width, 0.1"});
  expect_complaint(pulse("Repetition period = 1; Speed = 0"),
                   {"Active stress/Pulse/Repetition period: ", "at a distance of 0,"});
  expect_complaint(pulse("Speed = 0"), {"Active stress/Pulse/Start position: ", "a path that reaches the body"});
  expect_complaint(pulse("Start position = 2"), {"Active stress/Pulse/Speed: ", "from 2 to 7"});
  expect_complaint(pulse("Width = 1e-5"), {"Active stress/Pulse/Width: ", "at least 0.0001"});
}
