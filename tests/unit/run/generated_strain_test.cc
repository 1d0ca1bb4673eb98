// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Prescribed strain by other generators, and the recovered active stress written as a table and read again.
#include "../../support/stress.h"
#include "../../support/temporary_folder.h"
#include "../../support/test.h"

#include <crawler/output/active_stress_table.h>

using namespace crawler;
using test::Settings;

namespace
{
  Settings
  strain_by(const std::string &generator, const Settings &own)
  {
    return test::with(test::set("p = 2; prescribed strain; Given by = {}", generator), own);
  }

  void
  expect_complaint(const Settings &settings, const std::string &words)
  {
    test::expect_complaint(settings, {"Active stress/Prescribed strain/Given by: ", words});
  }

  const Settings wave =
    test::set("Active stress/Travelling wave/Amplitude = 0.3; Active stress/Travelling wave/Wave number = 1");
} // namespace

/// theory.md: e = 0.3 sin 2 pi (s + t) at a = -1 has D = 1 - sqrt(1 - 0.09), whoever writes it.
TEST(GeneratedStrain, IsTheSameStrainFromAnyGenerator)
{
  const double exact    = 1. - std::sqrt(1. - 0.09);
  const std::string sum = "Active stress/Sum/Term ";
  for (const Settings &settings : {strain_by("wave", {}),
                                   strain_by("travelling wave", wave),
                                   strain_by("sum",
                                             {{sum + "1/Expression/Active stress", "0.3*sin(2*pi*s)*cos(2*pi*t)"},
                                              {sum + "2/Factor", "0.3"},
                                              {sum + "2/Expression/Active stress", "cos(2*pi*s)*sin(2*pi*t)"}})})
    EXPECT_NEAR(test::on_level(settings).displacement, exact, 1e-11) << settings[2].second;
  const Scene scene = test::parameters_with(strain_by("travelling wave", wave)).create_scene();
  EXPECT_NEAR(scene.active_stress->period().value_or(0.), 1., 1e-12);
}

/// A smooth start from rest, so that the full model can follow: it gives the displacement of the kinematic level, and
/// so does its active stress as a table, to the accuracy asked for.
TEST(GeneratedStrain, ItsActiveStressAsATableDrivesTheFullModel)
{
  const Settings settings = test::with(
    strain_by("travelling wave", wave),
    "Active stress/Travelling wave/Ramp duration = 0.5; Accuracy = 1e-6; L = 2; k = 3; gamma = 0.5; T = 1.5");
  const double kinematic = test::on_level(settings).displacement;
  EXPECT_GT(std::abs(kinematic), 0.01);
  const auto full = test::run_with(settings).result;
  EXPECT_EQ(full.time.status, Status::finished);
  EXPECT_NEAR(full.displacement, kinematic, 1e-6 * std::abs(kinematic));

  const test::TemporaryFolder folder;
  const auto file   = folder.path / "active_stress.csv";
  const Scene scene = test::parameters_with(settings).create_scene();
  EXPECT_EQ(write_active_stress_table(file, *scene.active_stress, 2., 1.5, 129, 513), "");
  const auto by_table = test::run_with(test::with(settings, "table; File = {}", file.string())).result;
  EXPECT_EQ(by_table.time.status, Status::finished);
  EXPECT_NEAR(by_table.displacement, kinematic, 2e-6 * std::abs(kinematic));
}

TEST(GeneratedStrain, RefusesGeneratorsWithoutRateAndJumps)
{
  expect_complaint(strain_by("travelling wave", test::with(wave, "Active stress/Travelling wave/Profile = square")),
                   "whose rate of change is not known");
  const std::string term = "Active stress/Sum/Term 1/";
  const Settings cut     = {{term + "Expression/Active stress", "0.1*sin(t)*cos(s)"}, {term + "Window in t", "0.3, 2"}};
  expect_complaint(strain_by("sum", cut), "Given by is sum, whose values jump at t = 0.3; a strain without jumps");
  const Settings half = {{term + "Expression/Active stress", "0.1*sin(t)*cos(s)"}, {term + "Window in s", "0.4, 2"}};
  expect_complaint(strain_by("sum", half), "Given by is sum, whose values jump at s = 0.4; a strain without jumps");
  const Settings of_stress = {{term + "Generator", "prescribed strain"}};
  expect_complaint(strain_by("sum", of_stress), "Given by is sum, whose rate of change is not known");
  const Settings too_much = {{"Active stress/Travelling wave/Amplitude", "1.2"}};
  expect_complaint(strain_by("travelling wave", too_much), "the body would be inverted");
}

/// The sizes are looked at, and a stress that is not a function of s and t is refused elsewhere (sum_test.cc).
TEST(ActiveStressTable, SaysWhatIsWrong)
{
  for (const std::string size : {"65", "1, 65", "65, 129, 3", "2.5, 10", "1e5, 1e5", "-3, 5"})
    test::expect_complaint({{"Output/Active stress table", size}}, {"Output/Active stress table: "});
  EXPECT_NO_THROW(test::parameters_with({{"Output/Active stress table", "65, 129"}}).create_scene());
}
