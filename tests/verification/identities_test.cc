// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What holds exactly (doc/theory.md, "Consequences"), in whole runs, on any number of ranks.
#include "../support/test.h"

using namespace crawler;
using test::with;

namespace
{
  /// Explicit numerics: no pilot runs, and the same mesh for both of a pair.
  const test::Settings numerics = test::set("degree = 4; cells = 10; tolerance = 1e-9");
} // namespace

/// int g v ds = 0 and stress power = dissipation + change of the elastic energy, from p = -20 to 21.
TEST(Identities, NetFrictionAndLedger)
{
  for (const double p : {-20., -3., 0., 0.5, 1., 2., 2.5, 4., 21.})
  {
    const auto result = test::run_with(with(test::wave(1. - p, 0.1, 0.7), numerics)).result;
    ASSERT_EQ(result.time.status, Status::finished) << p;
    EXPECT_LT(result.residuals.net_friction, 1e-11) << p;
    EXPECT_LT(result.energy_balance->residual(), 1e-6) << p;
    EXPECT_GT(result.energy_balance->dissipation, 0.) << p;
    EXPECT_GE(result.energy_balance->positive_work, result.energy_balance->stress_work) << p;
  }
}

/// a = 11, stretch down to 0.02: friction falls to 1e-19, but work and dissipation must not show the error of Newton's
/// method divided by it, and changes of mesh must not leave the state out of balance.
TEST(Identities, LedgerWhereFrictionVanishes)
{
  for (const char *mesh : {"uniform", "adaptive"})
  {
    const auto settings = with(test::wave(11., 0.53), {{"Accuracy", "1e-3"}, {"Discretization/Mesh", mesh}});
    const auto outcome  = test::run_with(settings);
    const auto &result  = outcome.result;
    ASSERT_EQ(result.time.status, Status::finished) << mesh;
    EXPECT_LT(result.residuals.net_friction, 1e-10) << mesh;
    EXPECT_LT(result.energy_balance->residual(), 1e-2) << mesh;
    EXPECT_NEAR(result.energy_balance->stress_work, 0.129086, 1e-3) << mesh;
    EXPECT_NEAR(result.displacement, -0.185838, outcome.choice.wanted_error) << mesh;
  }
}

/// A cell of a stiff body comes to rest within 1e-15 of the duration; the round-off of its state is no velocity.
TEST(Identities, LedgerOfStiffBodies)
{
  for (const double k : {1e6, 1e8, 1e11})
    for (const double a : {-3., -1., 2.})
      for (const test::Settings &more : {test::Settings{},
                                         test::Settings{{"Time/Engine", "petsc"}},
                                         test::Settings{{"Discretization/Mesh", "adaptive"}},
                                         test::set("Body/Elastic modulus profile = 1+0.3*s; Ground/Backward ratio = 2; "
                                                   "Ground/Switching velocity = 0.01")})
      {
        const auto settings = with(with(test::wave(a, 0.2, 1., 1., k), {{"Accuracy", "1e-8"}}), more);
        const auto &result  = test::run_with(settings).result;
        const std::string what =
          fmt::format("k = {:g}, a = {:g}, {}", k, a, more.empty() ? "automatic" : more.front().first);
        ASSERT_EQ(result.time.status, Status::finished) << what << ": " << result.time.message;
        EXPECT_LT(result.energy_balance->residual(), 1e-7) << what;
        EXPECT_LT(result.residuals.net_friction, 1e-7) << what;
      }
}

/// A step to the end time whose state the mesh refuses is done again: the last state is that of the end.
TEST(Identities, AdaptiveRunsReachTheEnd)
{
  const auto outcome =
    test::run_with(with(test::wave(-1., 0.6, 0.7, 1., 0.00316227766017), "Accuracy = 1e-4; integrator = radau 5"));
  EXPECT_EQ(outcome.result.time.status, Status::finished);
  EXPECT_NEAR(outcome.result.displacement, 0.2936926, 3e-4 * 0.2936926);
}
