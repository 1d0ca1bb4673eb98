// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The equation at a = 0 against closed forms. With L = gamma = 1, zeta_t = m_s + k zeta_ss, w - 1 = -m/k at the ends;
// for m = A(t) sin(pi j s), which vanishes there, u = U(t) cos(pi j s) with U' = pi j A - k (pi j)^2 U, U(0) = 0.
#include "../support/answers.h"
#include "../support/test.h"

#include <crawler/base/exceptions.h>
#include <crawler/run/result_table.h>

using namespace crawler;
using test::answer_to;

namespace
{
  using std::numbers::pi;

  test::Settings
  linear(const std::string &formula, const double end_time = 1., const double k = 1., const test::Settings &more = {})
  {
    return test::with(
      test::set("Model = linear; p = 1; k = {}; T = {}; expression; Active stress = {}", k, end_time, formula), more);
  }

  /// U(t) for A(t) = amplitude sin(omega t).
  double
  driven(const double amplitude, const double omega, const double k, const double t, const int j = 1)
  {
    const double q = pi * j, r = k * q * q;
    return q * amplitude * (r * std::sin(omega * t) - omega * std::cos(omega * t) + omega * std::exp(-r * t)) /
           (r * r + omega * omega);
  }
} // namespace

/// Accuracy is about u here, and works have bounds though the displacement says nothing of the numerics.
TEST(LinearLevel, ClosedForm)
{
  for (const double k : {0.05, 1., 20.})
    for (const double accuracy : {1e-3, 1e-6, 1e-9})
    {
      const double amplitude = 0.3 * std::clamp(k, 0.3, 3.);
      const auto result      = answer_to(
        linear(test::text(amplitude) + "*sin(7*t)*sin(2*pi*s)", 1.3, k, {{"Accuracy", test::text(accuracy)}}));
      ASSERT_EQ(result.time.status, Status::finished);
      const double U = driven(amplitude, 7., k, 1.3, 2), energy = 0.25 * k * 4. * pi * pi * U * U;
      EXPECT_NEAR(result.energy_balance->elastic_energy, energy, 20. * accuracy * energy + 1e-14);
      EXPECT_NEAR(result.energy_balance->elastic_energy, energy, *error_bound(result, "elastic_energy") + 1e-14);
      EXPECT_FALSE(error_bound(result, "positive_power")); // few steps know its kinks badly
      EXPECT_LT(std::abs(result.displacement), 1e-14);
      EXPECT_LE(std::abs(result.displacement), result.error->total);
      EXPECT_LT(result.error->total, 1e-12);
      EXPECT_LT(result.residuals.net_friction, 1e-9);
    }
}

/// Cycles are judged by the displacement: here all of them are computed.
TEST(LinearLevel, ComputesAllCycles)
{
  const auto result = answer_to(linear("0.3*sin(2*pi*t)*sin(pi*s)", 30., 1., {{"Accuracy", "1e-7"}}));
  EXPECT_FALSE(result.cycles);
  const auto finer = answer_to(linear("0.3*sin(2*pi*t)*sin(pi*s)", 30., 1., {{"Accuracy", "1e-9"}}));
  for (const double EnergyBalance::*work : {&EnergyBalance::stress_work, &EnergyBalance::dissipation})
    EXPECT_NEAR(*result.energy_balance.*work, *finer.energy_balance.*work, *error_bound(result, "stress_power"));
  EXPECT_LT(*error_bound(result, "stress_power"), 1e-5 * finer.energy_balance->stress_work);
  EXPECT_THROW(answer_to(linear("0.3*sin(2*pi*t)*sin(pi*s)", 30., 1., {{"Time/Cycle stop", "on"}})), InputError);
}
