// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Answers of the stretch form: what extrapolation and the reported errors are worth.
#include "../../support/lane_runs.h"
#include "../../support/test.h"

#include <crawler/accuracy/mesh_family.h>
#include <crawler/run/summary.h>

using namespace crawler;
using test::Settings;

namespace
{
  const Settings stretch = {{"Discretization/Formulation", "stretch"}};

  /// The answer finished with an error as small as wanted, and no smaller than the true one.
  void
  expect_true(const SimulationResult &result, const double exact, const double half_digit, const double accuracy)
  {
    ASSERT_EQ(result.time.status, Status::finished) << result.time.message;
    ASSERT_TRUE(result.error);
    EXPECT_EQ(result.process.formulation, Formulation::stretch);
    EXPECT_LE(std::abs(result.displacement - exact), result.error->total + half_digit);
    EXPECT_LE(result.error->total, accuracy * std::abs(exact) * 1.001);
    EXPECT_LT(result.energy_balance->residual(), 1e-4);
    EXPECT_LT(result.residuals.net_friction, 1e-12);
  }
} // namespace

TEST(MeshFamily, ErrorsAreTrueAndSmallEnough)
{
  for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7})
  {
    SCOPED_TRACE(accuracy);
    const auto result =
      test::run_with(test::with(test::with(test::wave(-1., 0.4), stretch), "Accuracy = {}", accuracy)).result;
    expect_true(result, 0.0900725298, 1e-10, accuracy);
  }
}

/// Displacements whose order is 2 twice in a row settle on few cells, whatever the works do.
TEST(MeshFamily, RegularOrdersNeedNoFinerMesh)
{
  const auto result = test::run_with(test::with(test::wave(-1., 0.6), {{"Accuracy", "1e-6"}})).result;
  expect_true(result, 0.2349598822, 1e-10, 1e-6);
  EXPECT_LE(result.process.mesh.n_cells, 800u);
}

/// The little that is left in an empty cell decides when it refills: small tolerances alone see it.
TEST(MeshFamily, EmptyCellsRefillOnTime)
{
  const auto result = test::run_with(test::with(test::wave(-1., 0.999), {{"Accuracy", "1e-3"}})).result;
  expect_true(result, 0.3991780907, 2e-5, 1e-3);
}

/// For -1 < a < 0 a body may lose its stretch inside: when is known as well as is said, and all places that are lost
/// are named.
TEST(MeshFamily, TimeOfAnInversion)
{
  for (const double accuracy : {1e-3, 1e-4})
  {
    const auto result = test::run_with(test::with(test::wave(-0.8, 0.77), {{"Accuracy", test::text(accuracy)}})).result;
    EXPECT_EQ(result.time.status, Status::inverted);
    EXPECT_EQ(result.time.reason, "inverted_inside");
    EXPECT_EQ(result.process.formulation, Formulation::stretch);
    ASSERT_TRUE(result.inversion && result.inversion->error && result.inversion->places);
    EXPECT_NEAR(result.inversion->t, 0.322123, *result.inversion->error + 0.5e-6);
    EXPECT_LE(*result.inversion->error, 1.001 * accuracy);
    EXPECT_LE(result.inversion->places->first, result.inversion->s);
    EXPECT_GE(result.inversion->places->second, result.inversion->s);
  }
}

/// A body that is its own mirror image goes nowhere; that is known to a part of its deformation.
TEST(MeshFamily, SymmetricBodiesStay)
{
  const auto result = test::run_with(test::with(test::expression(-1., "0.3*sin(pi*t)^2*sin(pi*s)"), stretch)).result;
  EXPECT_EQ(result.time.status, Status::finished) << result.time.message;
  EXPECT_GT(result.size.largest_u, 1e-3);
  EXPECT_LT(std::abs(result.displacement), 1e-12);
  ASSERT_TRUE(result.error);
  EXPECT_GE(result.error->total, std::abs(result.displacement));
}

/// Works and energies are extrapolated like the displacement; all numbers have their errors.
TEST(MeshFamily, WorksEnergiesAndTheirErrors)
{
  const Settings settings = test::wave(-1., 0.4);
  const auto json_of      = [](const Settings &own) { return summary_of(test::run_with(own).result); };
  const auto exact        = json_of(test::with(settings, {{"Accuracy", "1e-9"}})),
             found        = json_of(test::with(test::with(settings, stretch), {{"Accuracy", "1e-4"}}));
  EXPECT_NEAR(exact.at("positive_power").get<double>(), 0.2853, 0.6e-4); // doc/theory.md, section 5
  for (const char *key : {"stress_power",
                          "dissipation",
                          "elastic_energy",
                          "paper_energy",
                          "positive_power",
                          "min_stretch",
                          "max_stretch"})
  {
    const auto value = [&](const auto &summary) {
      return summary.at(key).is_object() ? summary.at(key).at("value").template get<double>()
                                         : summary.at(key).template get<double>();
    };
    const double error = found.at("errors").at(key).get<double>();
    EXPECT_NEAR(value(found), value(exact), error + 1e-5 * std::abs(value(exact))) << key;
    EXPECT_LT(error, 0.02 * std::max(std::abs(value(exact)), exact.at("dissipation").get<double>())) << key;
  }
}

TEST(MeshFamily, IsChosenWhereTheStretchIsSmallOrTheBodySoft)
{
  const auto form = [](const Settings &settings) {
    const Parameters parameters = test::parameters_with(settings);
    return choose_numerics({parameters, parameters.create_scene()})->numerics.formulation;
  };
  EXPECT_EQ(form(test::wave(-1., 0.2)), Formulation::position);
  EXPECT_EQ(form(test::wave(1., 0.2, -1.)), Formulation::position);
  EXPECT_EQ(form(test::wave(-1., 0.6)), Formulation::stretch);
  EXPECT_EQ(form(test::wave(-1., 0.2, 1., 1., 1e-5)), Formulation::stretch);
  // The stretch form is of second order, so digits are dearer there.
  EXPECT_EQ(form(test::with(test::wave(-1., 0.2, 1., 1., 1e-5), "Accuracy = 1e-9")), Formulation::position);
  // Steep friction makes thinner layers; friction that vanishes with the stretch holds nothing, so nothing is lost.
  EXPECT_EQ(form(test::wave(-1., 0.1, 1., 1., 0.01)), Formulation::position);
  EXPECT_EQ(form(test::wave(-7., 0.1, 1., 1., 0.01)), Formulation::stretch);
  EXPECT_EQ(form(test::wave(0.5, 0.6)), Formulation::position);
  // What the user has chosen, and what only the other form has.
  EXPECT_EQ(form(test::with(test::wave(-1., 0.6), {{"Discretization/Formulation", "position"}})),
            Formulation::position);
  EXPECT_EQ(form(test::with(test::wave(-1., 0.6), "cells = 16; tolerance = 1e-3")), Formulation::position);
  EXPECT_EQ(form(test::with(test::wave(-1., 0.2, 1., 1., 1e-4), {{"Discretization/Degree", "4"}})),
            Formulation::position);
}

/// The files of a run have all of its cycles, while those of its numbers end when they repeat.
TEST(MeshFamily, NumbersNeedFewerCyclesThanFiles)
{
  const Parameters parameters = test::parameters_with(test::set("p = 2; k = 0.5; T = 20; Accuracy = 1e-2; segments"));
  const Scene scene           = parameters.create_scene();
  const auto choice           = choose_numerics({parameters, scene});
  ASSERT_TRUE(choice && choice->is_family);
  SimulationResult files;
  const auto simulate = [&](const NumericsChoice &chosen) {
    return files = Simulation(MPI_COMM_SELF, scene, parameters.time, chosen.numerics).run({}, {});
  };
  const SimulationResult numbers = run_to_accuracy({parameters, scene}, *choice, simulate, {}, /*writes=*/true).result;
  EXPECT_EQ(files.time.time, scene.end_time);
  EXPECT_FALSE(files.cycles);
  EXPECT_TRUE(numbers.cycles);
  EXPECT_NEAR(numbers.displacement, files.displacement, numbers.error->total);
}

/// Whoever does not want to wait gets no answer.
TEST(MeshFamily, CanBeStopped)
{
  const Parameters parameters = test::parameters_with(test::with(test::wave(-1., 0.4), stretch));
  const Scene scene           = parameters.create_scene();
  const auto choice           = choose_numerics({parameters, scene});
  ASSERT_TRUE(choice && choice->is_family);
  unsigned int n_steps  = 0;
  const auto keep_going = [&]() { return ++n_steps < 100; };
  const Answer answer   = answer_of_family({parameters, scene, keep_going}, *choice, {}, []() { return false; });
  EXPECT_EQ(answer.result.time.status, Status::stopped);
  EXPECT_EQ(n_steps, 100u);
}
