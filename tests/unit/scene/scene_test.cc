// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/run_text.h"
#include "../../support/test.h"

#include <crawler/base/exceptions.h>

using namespace crawler;

namespace
{
  constexpr double stiffness = 0.8;

  /// One crawler in units of @p length, @p time and @p friction: its end time is 0.7, its stiffness 0.8.
  test::Settings
  in_user_units(const double length, const double time, const double friction)
  {
    const double end_time = 0.7 * time, force = friction * length * length / end_time;
    return test::set("L = {}; k = {}; gamma = {}; T = {}; expression; "
                     "Active stress = 0.2*F*sin(pi*s/L)*sin(2*pi*(s/L+t/T)); Constants = F={}",
                     length,
                     stiffness * force,
                     friction,
                     end_time,
                     force);
  }

  struct UserUnits
  {
    double length, time, friction;
  };
  const std::vector<UserUnits> all_units = {
    {1., 1., 1.}, {1e-6, 1., 1.}, {1e6, 1., 1.}, {1e-6, 1e-3, 1e12}, {1e6, 3600., 1e-9}, {0.3, 7e5, 2e-4}};
} // namespace

/// The whole program: the same crawler moves the same part of its length in any units.
TEST(Scene, TheSameMotionInAllUnits)
{
  double reference = 0.;
  for (const auto &[length, time, friction] : all_units)
  {
    const auto result = test::run_with(in_user_units(length, time, friction)).result;
    ASSERT_EQ(result.time.status, Status::finished) << result.time.message;
    const double relative = result.displacement / length;
    if (reference == 0.)
      reference = relative;
    EXPECT_GT(std::abs(relative), 1e-5);
    EXPECT_NEAR(relative, reference, 1e-12) << "length " << length;
    EXPECT_NEAR(result.time.time / (0.7 * time), 1., 1e-14);
  }
}

TEST(Scene, RefusesExtremeUnits)
{
  const auto refused = [](const auto &change) {
    Scene scene = test::parameters_with(in_user_units(1., 1., 1.)).create_scene();
    EXPECT_NO_THROW(natural_units(scene));
    change(scene);
    EXPECT_THROW(natural_units(scene), InputError);
  };
  for (const double extreme : {1e-120, 1e120, 0., -1., std::numeric_limits<double>::quiet_NaN()})
  {
    refused([&](Scene &scene) { scene.body.length = extreme; });
    refused([&](Scene &scene) { scene.end_time = extreme; });
    refused([&](Scene &scene) { scene.body.friction_coefficient = extreme; });
    refused([&](Scene &scene) { scene.body.elastic_modulus = extreme; });
  }
  for (const double extreme : {1e-21, 1e21})
    refused([&](Scene &scene) { scene.body.elastic_modulus = extreme / scene.end_time; });
}
