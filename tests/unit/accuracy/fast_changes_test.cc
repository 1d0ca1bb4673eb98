// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/run_text.h"
#include "../../support/test.h"

#include <crawler/accuracy/stress_scales.h>
#include <crawler/scene/fast_changes.h>

using namespace crawler;

namespace
{
  Scene
  formula(const std::string &text, const double end_time = 1.)
  {
    return test::parameters_with(test::set("T = {}; expression; Active stress = {}", end_time, text)).create_scene();
  }

  FastChanges
  changes_of(const Scene &scene, const double known)
  {
    double largest = 0.1;
    return find_fast_changes(
      *scene.active_stress,
      scene.body.length,
      0.,
      scene.end_time,
      [known](double, double) { return rates_explain * known; },
      largest);
  }

  /// The shortest limit that a step meets which starts at this time.
  double
  longest_step(const std::vector<StepLimit> &limits, const double t)
  {
    unsigned int present = 0;
    return admitted_step(limits.data(), static_cast<unsigned int>(limits.size()), present, t, HUGE_VAL);
  }
} // namespace

/// However short it is and wherever: events that samples cannot see.
TEST(FastChanges, FindsEventsOfFormulas)
{
  for (const double width : {1e-3, 1e-4, 1e-5, 1e-7})
    for (const double time : {0.0123, 0.31415926, 0.5, 0.77777})
    {
      const Scene scene       = formula(fmt::format(
        "0.1*sin(2*pi*(s+t))*tanh(5*t)+0.6*sin(pi*s)*sin(2*pi*s)*exp(-((t-{})/{})^2)", time, test::text(width)));
      const FastChanges found = changes_of(scene, 0.7);
      EXPECT_TRUE(found.is_complete);
      ASSERT_FALSE(found.list.empty()) << width << " at " << time;
      EXPECT_GT(found.list.front().from, time - 100. * width);
      EXPECT_LT(found.list.back().to, time + 100. * width);
      const StressScales scales = stress_scales(scene);
      EXPECT_TRUE(scales.sees_all);
      EXPECT_LT(longest_step(scales.step_limits, time), 4. * width);
      EXPECT_GT(longest_step(scales.step_limits, time + 0.01 + 20. * width), 0.05);
      EXPECT_GT(scales.stress, 0.3);
      EXPECT_LT(scales.stress, 0.6);
    }
}

TEST(FastChanges, OfASlowStressAreNone)
{
  for (const char *text : {"0.1*sin(2*pi*(s+t))", "0.3*exp(-((s-0.2-0.5*t)/0.1)^2)*sin(pi*t)^2", "0.2*s"})
  {
    const Scene scene = formula(text);
    EXPECT_TRUE(changes_of(scene, 2.).list.empty()) << text;
    EXPECT_LE(stress_scales(scene).step_limits.size(), 1u) << text;
  }
}

/// Differences along the body tell whether the active stress has many derivatives there, wherever its kinks travel.
TEST(StressScales, KnowWhatIsSmooth)
{
  for (const char *text :
       {"0.1*sin(2*pi*(s+t))", "0.1*sin(6*pi*(s+t))+0.3*s^2*t", "0.3*exp(-((s-0.2-0.5*t)/0.3)^2)*sin(pi*t)^2", "0.2*s"})
    EXPECT_TRUE(stress_scales(formula(text)).is_smooth) << text;
  for (const char *text : {"0.1*abs(sin(pi*(s+0.7*t)))",
                           "0.1*abs(sin(pi*(s+0.7*t)))^3",
                           "0.3*exp(-((s-0.2-0.5*t)/0.01)^2)*sin(pi*t)^2",
                           "s<0.3+0.4*t ? 0.1 : 0.2"})
    EXPECT_FALSE(stress_scales(formula(text)).is_smooth) << text;
}

/// Breaks are those of the whole scene: profiles and echoes by a feedback have cells, too.
TEST(StressScales, CountAllBreaks)
{
  const Scene scene =
    test::parameters_with(test::set("Body/Friction profile = s < 0.9 ? 1 : 2; strain feedback; Distance = 0.3; "
                                    "Active stress = 0.1*(w_near-1)"))
      .create_scene();
  EXPECT_EQ(stress_scales(scene).in_space, 6u); // 0.9, 0.6, 0.3; 0.7, 0.4, 0.1
}

/// Jumps of a formula are ends of steps and not fast; what is between two of them is seen, however short it is.
TEST(FastChanges, OfJumpsAreNone)
{
  const Scene scene = formula("0.1*s+(t>0.4321 && t<0.43211 ? 0.7*s : 0)");
  EXPECT_EQ(scene.active_stress->breaks_in_time().size(), 2u);
  EXPECT_TRUE(changes_of(scene, 1.).list.empty());
  EXPECT_NEAR(stress_scales(scene).stress, 0.8, 1e-12);
}

/// Where round-off hides the times of jumps they are fast changes, as short as they can be.
TEST(FastChanges, OfHiddenJumpsAreAsShortAsTheyCanBe)
{
  const FastChanges found = changes_of(formula("(t<0.4321 ? 0.1*s : 0.2*s)+0*sign(sin(t)-sin(t))"), 1.);
  EXPECT_TRUE(std::ranges::any_of(found.list, [](const FastChange &change) {
    return std::abs(change.from - 0.4321) < 1e-8 && std::abs(change.to - 0.4321) < 1e-8;
  }));
}

/// A single pulse that runs over the body in a ten thousandth of the time.
TEST(FastChanges, GeneratorsSayWhenTheyAct)
{
  const auto scene_with = [](const std::string &stress) {
    return test::parameters_with(test::set("T = 1000; " + stress)).create_scene();
  };
  const Scene pulse = scene_with("pulse; Amplitude = 0.4; Speed = 20");
  const auto limits = stress_scales(pulse).step_limits;
  EXPECT_NEAR(longest_step(limits, 0.05), 0.1 / 20. / 0.858, 1e-3);
  EXPECT_GT(longest_step(limits, 1.), 100.);
  const Scene robot = scene_with("segments; Switching = smooth; Front width = 1e-4; Frequency = 0.01");
  EXPECT_LT(longest_step(stress_scales(robot).step_limits, 0.), 0.02);
  const Scene sum =
    scene_with("sum; Term 1/Generator = travelling wave; Term 1/Travelling wave/Frequency = 0.01; "
               "Term 2/Generator = pulse; Term 2/Pulse/Speed = 20; Term 2/Pulse/Start position = -9000");
  EXPECT_LT(longest_step(stress_scales(sum).step_limits, 450.01), 0.02);
}
