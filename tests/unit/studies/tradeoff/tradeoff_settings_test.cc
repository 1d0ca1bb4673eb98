// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/studies/tradeoff/tradeoff_settings.h>

#include <gtest/gtest.h>

#include <string>
#include <vector>

using namespace crawler;

namespace
{
  /// The optimal wave of speed 1, with entries of section Tradeoff and the exponent p.
  Parameters
  parameters(const std::string &lists, const std::string &p = "2")
  {
    Parameters result;
    Declarations declarations;
    result.add_parameters(declarations);
    ParameterFile::from_text("subsection Body\n set Anchoring exponent = " + p +
                               "\nend\nsubsection Active stress\n subsection Optimal wave\n"
                               "  set Choose wave by = wave speed\n end\nend\nsubsection Tradeoff\n" +
                               lists + "end\n",
                             "test.prm")
      .apply(declarations);
    return result;
  }

  const std::string small =
    "set Degrees = 2, 4\nset Cells = 8, 4\nset Tolerances = 1e-4, 1e-2, 1e-6\nset Mesh tolerances = 1e-3\n";

  std::vector<TradeoffSetting>
  settings_of(const Parameters &p)
  {
    return settings_to_try(p, p.create_scene());
  }
} // namespace

TEST(TradeoffSettings, BadListsAreRefused)
{
  for (const char *bad : {"set Degrees = 0\n",
                          "set Tolerances = 1\n",
                          "set Integrators = rosw\n",
                          "set Engines =\n",
                          "set Cells = automatic\n"})
    EXPECT_THROW(settings_of(parameters(bad)), InputError) << bad;
}

/// Meshes from the coarsest on; on each the tolerances from the loosest on.
TEST(TradeoffSettings, ThoseOfOneMeshFollowEachOther)
{
  std::vector<TradeoffSetting> own;
  for (const TradeoffSetting &setting : settings_of(parameters(small)))
    if (setting.engine == "fused" && setting.integrator == "radau 9" && setting.degree == 4)
      own.push_back(setting);
  ASSERT_EQ(own.size(), 2 * 3);
  for (std::size_t i = 0; i < own.size(); ++i)
  {
    EXPECT_EQ(own[i].cells, i < 3 ? 4u : 8u);
    EXPECT_EQ(own[i].tolerance, (std::vector<double>{1e-2, 1e-4, 1e-6})[i % 3]);
    EXPECT_EQ(same_mesh(own[0], own[i]), i < 3);
  }
}

TEST(TradeoffSettings, WhatTheProgramCannotDoIsOneSettingWithItsReason)
{
  unsigned int not_offered = 0;
  for (const TradeoffSetting &setting : settings_of(parameters(small)))
  {
    if (setting.has_no_mesh())
      continue;
    const bool in_position = setting.formulation == "position",
               fused       = setting.integrator != "bdf" && setting.mesh == "uniform";
    const bool can_do = setting.engine == "petsc" ? in_position : fused && (in_position || setting.engine == "fused");
    EXPECT_EQ(setting.not_offered.empty(), can_do) << in_words(setting);
    EXPECT_EQ(setting.degree == 0, !can_do);
    not_offered += !can_do;
  }
  // Position: all by PETSc; fused and batch have radau on uniform meshes. Stretch: the latter by fused only.
  EXPECT_EQ(not_offered, 2 * 2 * 3 * 3 - 2 * 3 - 2 * 2 - 2);
}

/// One stretch in each cell, whatever the degrees of the position form are.
TEST(TradeoffSettings, StretchHasDegreeOne)
{
  unsigned int n = 0;
  for (const TradeoffSetting &setting : settings_of(parameters(small)))
    if (setting.formulation == "stretch" && setting.not_offered.empty())
    {
      EXPECT_EQ(setting.degree, 1u);
      ++n;
    }
  EXPECT_EQ(n, 2 * 2 * 3); // radau 5 and 9, cells, tolerances
}

TEST(TradeoffSettings, StretchIsNotForGroundsThatChange)
{
  Parameters other     = parameters(small);
  other.ground.profile = "1+0.1*x";
  unsigned int n       = 0;
  for (const TradeoffSetting &setting : settings_of(other))
    if (setting.formulation == "stretch")
    {
      EXPECT_NE(setting.not_offered.find("depends on the place"), std::string::npos) << setting.not_offered;
      ++n;
    }
  EXPECT_EQ(n, 2 * 3 * 3);
}

TEST(TradeoffSettings, ReducedModelsHaveNoMesh)
{
  const auto all = settings_of(parameters(small));
  EXPECT_EQ(in_words(all[0]), "model perturbation, Accuracy 0.1");
  for (std::size_t i = 0; i < 4; ++i)
  {
    EXPECT_EQ(all[1 + i].model, "kinematic");
    EXPECT_EQ(all[1 + i].tolerance, (std::vector<double>{0.1, 1e-2, 1e-4, 1e-6})[i]);
  }
  EXPECT_EQ(all[5].model, "nonlinear");
  Parameters other              = parameters(small + "set Models = perturbation\n");
  other.active_stress.generator = "none";
  const auto none               = settings_of(other);
  ASSERT_EQ(none.size(), 1);
  EXPECT_NE(none[0].not_offered.find("a series for the optimal wave"), std::string::npos);
}

TEST(TradeoffSetting, AsTextIsWhatWasMeasured)
{
  const Parameters p = parameters(small);
  TradeoffSetting setting;
  setting.formulation  = "position";
  setting.mesh         = "uniform";
  setting.engine       = "petsc";
  setting.integrator   = "bdf";
  setting.degree       = 4;
  setting.cells        = 7;
  setting.tolerance    = 1e-3;
  const Parameters own = with_setting(p, setting, /*size=*/1. / 3.);
  Parameters pasted;
  Declarations declarations;
  pasted.add_parameters(declarations);
  ParameterFile::from_text(as_prm(own, setting), "pasted.prm").apply(declarations);
  EXPECT_EQ(pasted.discretization.n_cells, 7u);
  EXPECT_EQ(pasted.discretization.degree, 4u);
  EXPECT_EQ(pasted.discretization.formulation, FormulationEntry::position);
  EXPECT_EQ(pasted.time.tolerance, 3.33333e-4);
  EXPECT_EQ(pasted.time.tolerance, own.time.tolerance);
  EXPECT_EQ(pasted.time.initial_step, own.time.initial_step);
  EXPECT_EQ(pasted.time.integrator, "bdf");
  EXPECT_EQ(pasted.time.engine, Engine::petsc);
  EXPECT_EQ(as_prm(pasted, setting), as_prm(own, setting));
}
