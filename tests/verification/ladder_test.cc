// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The levels of the model (doc/theory.md, "The model hierarchy") against each other, and the choice among them.
#include "../support/complaint.h"
#include "../support/run_text.h"
#include "../support/test.h"

#include <crawler/accuracy/model_choice.h>
#include <crawler/base/exceptions.h>
#include <crawler/studies/core/compute.h>

using namespace crawler;
using test::on_level;
using test::with;

namespace
{
  ModelChoice
  choice(const test::Settings &settings)
  {
    const Parameters parameters = test::parameters_with(settings);
    return choose_model(parameters, parameters.create_scene());
  }

  std::string
  complaint(const test::Settings &settings)
  {
    return test::complaint_of([&]() { choice(settings); });
  }
} // namespace

/// The stress of a prescribed strain, given to the nonlinear model, brings the strain about: displacement, works and
/// extremes are those of the kinematic level.
TEST(Ladder, NonlinearFollowsAPrescribedStrain)
{
  const test::Settings prescribed          = test::set("k = 0.7; Accuracy = 1e-8; prescribed strain; "
                                                       "Strain = 0.25*(sin(2*pi*(s+t)) - sin(2*pi*s)) + 0.1*s*t^2");
  const std::vector<test::Settings> bodies = {
    {{"Body/Anchoring exponent", "3.5"}},
    {{"Body/Anchoring exponent", "2"}},
    {{"Body/Anchoring exponent", "-0.5"}},
    {{"Body/Friction profile", "1.5-s"}, {"Body/Elastic modulus profile", "0.5+s"}, {"Body/Friction coefficient", "2"}},
    {{"Ground/Friction law", "expression"}, {"Ground/Expression", "1/(0.2+w^2)"}, {"Body/Length", "1.5"}}};
  for (const test::Settings &body : bodies)
  {
    const test::Settings settings = with(prescribed, body);
    const auto full               = test::run_with(settings).result;
    const auto motion             = on_level(settings, Model::kinematic, 1e-10);
    ASSERT_EQ(full.time.status, Status::finished);
    ASSERT_EQ(motion.time.status, Status::finished);
    EXPECT_NEAR(full.displacement / motion.displacement, 1., 1e-8) << body.front().first << " " << body.front().second;
    EXPECT_NEAR(full.energy_balance->stress_work / motion.energy_balance->stress_work, 1., 1e-7);
    EXPECT_NEAR(full.energy_balance->dissipation / motion.energy_balance->dissipation, 1., 1e-7);
    EXPECT_NEAR(full.energy_balance->paper_energy() / motion.energy_balance->paper_energy(), 1., 1e-7);
    EXPECT_NEAR(
      full.energy_balance->positive_work / motion.energy_balance->positive_work, 1., 2e-3); // an integrand with kinks
    EXPECT_NEAR(full.energy_balance->elastic_energy / motion.energy_balance->elastic_energy, 1., 1e-7);
    EXPECT_NEAR(full.stretch.min.value, motion.stretch.min.value, 1e-4);
    EXPECT_NEAR(full.stretch.max.value, motion.stretch.max.value, 1e-4);
  }
}

TEST(Ladder, AutomaticChoice)
{
  const auto model = [](const test::Settings &settings, const double accuracy) {
    return choice(with(settings, "Model = auto; Accuracy = {}", accuracy)).model;
  };
  EXPECT_EQ(model(test::wave(-1., 0.05), 1e-2), Model::perturbation);
  EXPECT_EQ(model(test::wave(-1., 0.05), 1e-6), Model::nonlinear);
  EXPECT_EQ(model(test::wave(-1., 0.4), 1e-2), Model::nonlinear);
  EXPECT_EQ(model(test::wave(0., 0.4), 1e-6), Model::linear);
  const test::Settings prescribed = {{"Active stress/Generator", "prescribed strain"}};
  EXPECT_EQ(model(prescribed, 1e-10), Model::kinematic);
  EXPECT_EQ(model(with(prescribed, {{"Body/Friction profile", "1+s"}}), 1e-10), Model::kinematic);
  // A stiff body follows its active stress.
  const test::Settings stiff = test::set("k = 1e5; expression; Active stress = 2e4*(sin(2*pi*(s+t)) - sin(2*pi*s))");
  EXPECT_EQ(model(stiff, 1e-2), Model::kinematic);
  EXPECT_EQ(model(stiff, 1e-9), Model::nonlinear);
  // A sudden start moves it by 1 % less, of which the kinematic level knows nothing.
  EXPECT_EQ(model(test::set("k = 1e5; expression; Active stress = 2e4*sin(2*pi*(1.3*s+t))"), 1e-2), Model::nonlinear);
  EXPECT_EQ(choice(with(test::wave(-1., 0.05), {{"Model", "auto"}, {"Accuracy", "1e-2"}})).explanation.substr(0, 44),
            "Model perturbation: its estimated error 0.00");
}

TEST(Ladder, ScenesThatDoNotFitAreRefused)
{
  const test::Settings expression = {{"Active stress/Generator", "expression"}},
                       prescribed = test::set("Body/Friction profile = 1+s; prescribed strain");
  const std::vector<std::tuple<test::Settings, test::Settings, std::string>> cases = {
    {test::wave(0., 0.1), {{"Model", "linear"}}, "nothing"},
    {expression, {{"Model", "kinematic"}}, "nothing"},
    {expression,
     {{"Model", "kinematic"}, {"Body/Friction profile", "1+s"}},
     "Model: Model is kinematic, which is for plain bodies and grounds unless the strain is prescribed, but the scene "
     "has Body/Friction profile; nonlinear or auto is expected"},
    {prescribed,
     {{"Ground/Backward ratio", "2"}, {"Ground/Switching velocity", "0.1"}},
     "Active stress/Generator: Generator is prescribed strain, which is for bodies whose motion follows from their "
     "strain alone, but the scene has Ground/Backward ratio; another one is expected"},
    {prescribed,
     {{"Ground/Friction law", "expression"}, {"Ground/Expression", "1.2-w"}},
     "Active stress/Prescribed strain/Strain: the friction law has no positive value at the stretch 1.2"},
  };
  for (const auto &[scene, settings, words] : cases)
    EXPECT_TRUE(complaint(with(scene, settings)).starts_with(words)) << complaint(with(scene, settings));
}

/// An error that is not known is not within Accuracy (one that is too large: cli/commands.py).
TEST(Ladder, AccuracyThatIsNotMet)
{
  const auto unknown = on_level(test::wave(-1., 0.6), Model::perturbation, 1e-4);
  EXPECT_EQ(unknown.time.reason, "accuracy_not_met");
  EXPECT_TRUE(std::isnan(unknown.error->total));
}

/// Many runs in one call may be on different levels.
TEST(Ladder, ManyRunsAtOnce)
{
  std::vector<Task> tasks(3);
  const double chi[] = {0.05, 0.4, 0.05};
  for (unsigned int i = 0; i < 3; ++i)
    tasks[i].parameters = test::parameters_with(
      with(test::wave(-1., chi[i]), {{"Model", i < 2 ? "auto" : "nonlinear"}, {"Accuracy", "1e-2"}}));
  compute_all(tasks, 100., []() { return false; });
  for (const Task &task : tasks)
    EXPECT_EQ(task.computed.result.time.status, Status::finished) << task.computed.result.time.message;
  EXPECT_EQ(tasks[0].parameters.model, Model::perturbation);
  EXPECT_NEAR(tasks[0].computed.result.displacement, 1.25e-3, 1e-15);
  EXPECT_EQ(tasks[1].parameters.model, Model::nonlinear);
  EXPECT_NEAR(tasks[2].computed.result.displacement, 1.2505e-3, 1.25e-5);
}
