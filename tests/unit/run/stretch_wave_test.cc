// SPDX-License-Identifier: LGPL-2.1-or-later
// Waves that are known in closed form.
#include "../../support/test.h"

#include <crawler/run/gait.h>

namespace
{
  using namespace crawler;
  using std::numbers::pi;
  constexpr unsigned int n_s = GaitMeter::n_pieces, n_t = GaitMeter::n_phases;

  /// The wave in e(s,t) on a body of length 1: means over the pieces, at phases from @p start.
  std::optional<StretchWave>
  wave_of(const std::function<double(double, double)> &e, const double period = 1., const double start = 0.)
  {
    constexpr unsigned int n_parts = 16;
    std::vector<std::vector<double>> stretch(n_t, std::vector<double>(n_s, 1.));
    for (unsigned int j = 0; j < n_t; ++j)
      for (unsigned int i = 0; i < n_s; ++i)
        for (unsigned int part = 0; part < n_parts; ++part)
          stretch[j][i] += e((i + (part + 0.5) / n_parts) / n_s, start + period * j / n_t) / n_parts;
    return measure_wave(stretch, period);
  }

  double
  fraction(const double x)
  {
    return x - std::floor(x);
  }

  /// Segments that are on for the share @p duty of the period 1, each @p lag after the one before it.
  std::function<double(double, double)>
  segments(const unsigned int n, const double lag, const double duty, const double gap = 0.)
  {
    return [=](const double s, const double t) {
      const double length = 1. / (n + (n - 1) * gap), pitch = length * (1. + gap), i = std::floor(s / pitch);
      return s - i * pitch < length && fraction(t + 1e-9 - i * lag) < duty ? 0.3 : 0.;
    };
  }

  TEST(StretchWave, TravelsWithItsSpeed)
  {
    for (const double waves : {-3., -1., -0.5, 0.5, 1., 2., 7., 20.})
    {
      const double period = 0.7;
      const auto wave     = wave_of([&](const double s, const double t) // with something that rests
                                { return 0.2 * std::sin(5. * s) + 0.3 * std::sin(2. * pi * (waves * s - t / period)); },
                                period);
      ASSERT_TRUE(wave);
      EXPECT_NEAR(wave->speed, 1. / (waves * period), 1e-9 / std::abs(waves * period));
      EXPECT_NEAR(wave->coherence, 1., 1e-9);
    }
  }

  /// Its fundamental is the weakest part, and the body is shorter than it is.
  TEST(StretchWave, OfAnyShapeTravelsWithItsSpeed)
  {
    for (const double speed : {-2.2, 0.8})
    {
      const auto wave = wave_of([&](const double s, const double t) {
        const double x = 2. * pi * (s / speed - t);
        return 0.01 * std::sin(x) + 0.2 * std::cos(2. * x) + 0.3 * std::sin(3. * x + 1.) - 0.2 * std::cos(5. * x);
      });
      ASSERT_TRUE(wave);
      EXPECT_NEAR(wave->speed, speed, 1e-9);
      EXPECT_GT(wave->coherence, 0.95);
    }
  }

  /// A wave that is longer than twice the body looks like one that stands, more so the longer it is, but its speed
  /// stays.
  TEST(StretchWave, LongerThanTheBodyIsLessAndLessOne)
  {
    double before = 1. + 1e-9;
    for (const double waves : {0.5, 0.4, 0.25, 0.15, 0.05, 0.01})
    {
      const auto wave =
        wave_of([&](const double s, const double t) { return 0.3 * std::sin(2. * pi * (waves * s - t)); });
      ASSERT_TRUE(wave);
      EXPECT_NEAR(wave->speed, 1. / waves, 1e-6 / waves);
      const double x = 2. * pi * waves;
      EXPECT_NEAR(wave->coherence, 1. - std::pow(std::sin(x) / x, 2), 1e-3); // pieces are not points
      EXPECT_LT(wave->coherence, before);
      EXPECT_EQ(wave->travels(), waves > 0.1);
      before = wave->coherence;
    }
  }

  TEST(StretchWave, OfTwoWavesTheStrongerOneWins)
  {
    // Both are whole waves on the body, so that S is A^2 and B^2, over A^2 + B^2.
    const double A = 0.2;
    for (const double B : {0.05, 0.1, 0.18})
    {
      const auto wave = wave_of([&](const double s, const double t) {
        return A * std::sin(4. * pi * s + 2. * pi * t) + B * std::sin(4. * pi * s - 2. * pi * t + 0.7);
      });
      ASSERT_TRUE(wave);
      EXPECT_NEAR(wave->coherence, (A * A - B * B) / (A * A + B * B), 0.01);
      EXPECT_NEAR(wave->speed, -0.5, 0.04); // the ends of the body show one to the other
    }
  }

  TEST(StretchWave, StandsOrIsNone)
  {
    for (const double half_waves : {0., 0.7, 1., 2., 3.5})
    {
      const auto wave = wave_of([&](const double s, const double t) {
        return 0.2 * std::cos(pi * half_waves * s + 0.4) * (std::sin(2. * pi * t) + 0.3 * std::cos(4. * pi * t));
      });
      ASSERT_TRUE(wave);
      EXPECT_LT(wave->coherence, 1e-9);
      const Gait gait{1., true, 1., 0.1, wave};
      EXPECT_STREQ(gait.direction(), "standing");
      EXPECT_FALSE(gait.wave_speed());
      EXPECT_FALSE(gait.slip());
    }
    EXPECT_FALSE(wave_of([](double, double) { return 0.1; }));
  }

  /// What is seen of lags beyond half a period runs the other way, and of half a period nothing runs.
  TEST(StretchWave, OfLargeLagsIsTheOneThatIsSeen)
  {
    for (const double lag : {0.4, 0.45, 0.55, 0.6, 0.9})
    {
      const auto wave = wave_of(segments(8, lag, 0.5));
      ASSERT_TRUE(wave);
      const double speed = 0.125 / (lag < 0.5 ? lag : lag - 1.);
      EXPECT_NEAR(wave->speed, speed, 0.03 * std::abs(speed)) << lag;
      EXPECT_GT(wave->coherence, 0.35) << lag;
    }
    EXPECT_FALSE(wave_of(segments(8, 0.5, 0.5))->travels());
  }

  /// A pulse once in a period is measured, or is not resolved; and then there is no number.
  TEST(StretchWave, APulseIsMeasuredOrAbsent)
  {
    for (const double speed : {0.9, 2., 4., 9., 40., 300.})
      for (const double width : {0.3, 0.1, 0.03, 0.01})
        for (const double start : {0., 0.011, 0.02})
        {
          const auto wave = wave_of(
            [&](const double s, const double t) {
              double e = 0.;
              for (int i = -2; i < 3; ++i)
                e += std::exp(-std::pow((s - speed * (t - 0.1 - i)) / width, 2));
              return e;
            },
            1.,
            start);
          const double seconds = width / speed; // on its way past a point
          EXPECT_TRUE(wave || seconds < 0.03) << speed << ' ' << width;
          EXPECT_TRUE(!wave || seconds > 0.01) << speed << ' ' << width;
          if (wave && wave->travels())
          {
            EXPECT_NEAR(wave->speed, speed, 0.01 * speed) << speed << ' ' << width;
          }
        }
  }

  /// The smallest change of the motion changes the speed by as little, so that two runs tell the error.
  TEST(StretchWave, IsASmoothFunctionOfTheMotion)
  {
    const auto speed = [](const double more) {
      const auto on = segments(8, 0.125, 0.5, 0.3);
      return wave_of([&](const double s, const double t) { return on(s, t) + more * std::sin(3. * s + 2. * pi * t); })
        ->speed;
    };
    const double rate = (speed(1e-4) - speed(-1e-4)) / 2e-4;
    EXPECT_GT(std::abs(rate), 1e-3);
    for (const double more : {1e-6, 1e-8, 1e-10})
      EXPECT_NEAR((speed(more) - speed(0.)) / more, rate, 1e-2 * std::abs(rate) + 1e-13 / more);
  }
} // namespace
