// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../../support/test.h"

#include <crawler/base/exceptions.h>
#include <crawler/studies/core/form.h>
#include <crawler/studies/tradeoff/tradeoff_settings.h>

using namespace crawler;

namespace
{
  /// The optimal wave of speed 1, with entries of section Tradeoff, and others.
  Input
  input(const std::string &lists, const std::string &override = "Model=nonlinear")
  {
    auto file = ParameterFile::from_text("subsection Active stress\n subsection Optimal wave\n"
                                         "  set Choose wave by = wave speed\n end\nend\nsubsection Tradeoff\n" +
                                           lists + "end\n",
                                         "test.prm");
    file.add_override(override);
    return read_input(file, "tradeoff");
  }

  const std::string small =
    "set Degrees = 2, 4\nset Cells = 8, 4\nset Tolerances = 1e-4, 1e-2, 1e-6\nset Mesh tolerances = 1e-3\n";

  std::vector<TradeoffSetting>
  settings_of(const std::string &lists, const std::string &override = "Model=nonlinear")
  {
    return settings_to_try(input(lists, override));
  }
} // namespace

/// Meshes from the coarsest on; on each the tolerances from the loosest on.
TEST(TradeoffSettings, ThoseOfOneMeshFollowEachOther)
{
  std::vector<TradeoffSetting> own;
  for (const TradeoffSetting &setting : settings_of(small))
    if (setting["engine"] == "fused" && setting["integrator"] == "radau 9" && setting["degree"] == "4")
      own.push_back(setting);
  ASSERT_EQ(own.size(), 2 * 3);
  for (std::size_t i = 0; i < own.size(); ++i)
  {
    EXPECT_EQ(own[i]["cells"], i < 3 ? "4" : "8");
    EXPECT_EQ(own[i]["tolerance"], (std::vector<std::string>{"0.01", "0.0001", "1e-06"})[i % 3]);
    EXPECT_EQ(same_mesh(own[0], own[i]), i < 3);
  }
}

TEST(TradeoffSettings, WhatTheProgramCannotDoIsOneSettingWithItsReason)
{
  unsigned int not_offered = 0;
  for (const TradeoffSetting &setting : settings_of(small))
  {
    if (setting["model"] != "nonlinear")
      continue;
    const bool in_position = setting["formulation"] == "position",
               fused       = setting["integrator"] != "bdf" && setting["mesh"] == "uniform";
    const bool can_do =
      setting["engine"] == "petsc" ? in_position : fused && (in_position || setting["engine"] == "fused");
    EXPECT_EQ(setting.not_offered.empty(), can_do);
    EXPECT_EQ(setting["degree"].empty(), !can_do);
    not_offered += !can_do;
  }
  // Position: all by PETSc; fused and batch have radau on uniform meshes. Stretch: the latter by fused only.
  EXPECT_EQ(not_offered, 2 * 2 * 3 * 3 - 2 * 3 - 2 * 2 - 2);
}

/// One stretch in each cell, whatever the degrees of the position form are.
TEST(TradeoffSettings, StretchHasDegreeOne)
{
  unsigned int n = 0;
  for (const TradeoffSetting &setting : settings_of(small))
    if (setting["formulation"] == "stretch" && setting.not_offered.empty())
    {
      EXPECT_EQ(setting["degree"], "1");
      ++n;
    }
  EXPECT_EQ(n, 2 * 2 * 3); // radau 5 and 9, cells, tolerances
}

TEST(TradeoffSettings, StretchIsNotForGroundsThatChange)
{
  unsigned int n = 0;
  for (const TradeoffSetting &setting : settings_of(small, "Ground/Profile=1+0.1*x"))
    if (setting["formulation"] == "stretch")
    {
      EXPECT_NE(setting.not_offered.find("depends on the place"), std::string::npos) << setting.not_offered;
      ++n;
    }
  EXPECT_EQ(n, 2 * 3 * 3);
}

TEST(TradeoffSettings, ReducedModelsHaveNoMesh)
{
  const auto all = settings_of(small);
  EXPECT_EQ(all[0].values, (TradeoffTexts{{"model", "perturbation"}, {"tolerance", "0.1"}}));
  for (std::size_t i = 0; i < 4; ++i)
  {
    EXPECT_EQ(all[1 + i]["model"], "kinematic");
    EXPECT_EQ(all[1 + i]["tolerance"], (std::vector<std::string>{"0.1", "0.01", "0.0001", "1e-06"})[i]);
  }
  EXPECT_EQ(all[5]["model"], "nonlinear");
  const auto none = settings_of(small + "set Models = perturbation\n", "Active stress/Generator=none");
  ASSERT_EQ(none.size(), 1);
  EXPECT_NE(none[0].not_offered.find("a series for the optimal wave"), std::string::npos);
  // `crawler run` refuses them for the body; perturbation crashed, and kinematic was recommended with a wrong answer.
  const auto both = settings_of(small + "set Models = perturbation, kinematic\n", "Body/Initial stretch=1+0.1*s");
  ASSERT_EQ(both.size(), 2);
  for (const TradeoffSetting &refused : both)
    EXPECT_NE(refused.not_offered.find("which is for plain bodies and grounds"), std::string::npos);
}

/// The tolerance has six digits; the first step is that of the integrator, unless the file has one.
TEST(TradeoffSetting, IsAListOfOverrides)
{
  TradeoffSetting setting;
  setting.values       = {{"model", "nonlinear"},
                          {"formulation", "position"},
                          {"mesh", "uniform"},
                          {"engine", "petsc"},
                          {"integrator", "bdf"},
                          {"degree", "4"},
                          {"cells", "7"},
                          {"tolerance", "0.001"}};
  const auto values_of = [&](ParameterFile file, const Parameters &own) {
    for (const std::string &one : overrides(setting, own, /*size=*/1. / 3.))
      file.add_override(one);
    return Form(file).parameters;
  };
  const Input base       = input(small, "Time/End time=2");
  const Parameters given = values_of(base.file, base.parameters);
  EXPECT_EQ(given.discretization.n_cells, 7u);
  EXPECT_EQ(given.discretization.degree, 4u);
  EXPECT_EQ(given.discretization.formulation, FormulationEntry::position);
  EXPECT_EQ(given.time.tolerance, 3.33333e-4);
  EXPECT_EQ(given.time.initial_step, 2e-5);
  EXPECT_EQ(given.time.integrator, "bdf");
  EXPECT_EQ(given.time.engine, Engine::petsc);
  const Input other = input(small, "Time/Initial step=0.3");
  EXPECT_EQ(values_of(other.file, other.parameters).time.initial_step, 0.3);
  setting.not_offered = "a reason";
  EXPECT_TRUE(overrides(setting, other.parameters, 1.).empty());
}
