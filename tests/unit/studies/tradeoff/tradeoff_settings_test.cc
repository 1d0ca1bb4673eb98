// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/studies/tradeoff/tradeoff_reference.h>
#include <crawler/studies/tradeoff/tradeoff_settings.h>

#include <gtest/gtest.h>

#include <cmath>
#include <set>

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

  const std::string small = "set Degrees = 2, 4\nset Tolerances = 1e-4, 1e-2, 1e-6\nset Mesh tolerances = 1e-3\n";
  const MeshErrors meshes = {{1, {{16, 1e-7}}}, {2, {{8, 1e-3}, {16, 1e-7}}}, {4, {{4, 1e-11}}}};

  std::vector<TradeoffFamily>
  families_of(const Parameters &p)
  {
    return families(read_lists(p), p, p.create_scene(), meshes);
  }

  TriedSetting
  finished(const double displacement)
  {
    return {"finished", "", displacement};
  }
} // namespace

TEST(TradeoffLists, AreSortedAndChecked)
{
  const auto lists = read_lists(parameters(small + "set Cells = 8, 4\n"));
  EXPECT_EQ(lists.tolerances, (std::vector<double>{1e-2, 1e-4, 1e-6}));
  EXPECT_EQ(lists.cells, (std::vector<unsigned int>{4, 8}));
  EXPECT_EQ(lists.integrators, (std::vector<std::string>{"radau 5", "radau 9", "bdf"}));
  for (const char *bad : {"set Degrees = 0\n", "set Tolerances = 1\n", "set Integrators = rosw\n", "set Engines =\n"})
    EXPECT_THROW(read_lists(parameters(bad)), InputError) << bad;
}

TEST(TradeoffFamilies, EverySettingHasItsOwnNumber)
{
  std::set<unsigned long> indices;
  unsigned long n = 0;
  for (const TradeoffFamily &family : families_of(parameters(small)))
    for (std::size_t i = 0; i < family.tolerances.size(); ++i, ++n)
      indices.insert(family.first_index + i);
  EXPECT_EQ(indices.size(), n);
  EXPECT_EQ(*indices.rbegin(), n - 1);
}

TEST(TradeoffFamilies, WhatTheProgramCannotDoIsOneSettingWithItsReason)
{
  unsigned int not_offered = 0;
  for (const TradeoffFamily &family : families_of(parameters(small)))
  {
    if (family.setting.has_no_mesh())
      continue;
    const bool in_position = family.setting.formulation == "position",
               fused       = family.setting.integrator != "bdf" && family.setting.mesh == "uniform";
    const bool can_do =
      family.setting.engine == "petsc" ? in_position : fused && (in_position || family.setting.engine == "fused");
    EXPECT_EQ(family.not_offered.empty(), can_do) << in_words(family.setting);
    EXPECT_EQ(family.setting.degree == 0, !can_do);
    not_offered += !can_do;
  }
  // Position: all by PETSc; fused and batch have radau on uniform meshes. Stretch: the latter by fused only.
  EXPECT_EQ(not_offered, 2 * 2 * 3 * 3 - 2 * 3 - 2 * 2 - 2);
}

/// One stretch in each cell, whatever the degrees of the position form are.
TEST(TradeoffFamilies, StretchHasDegreeOne)
{
  unsigned int n = 0;
  for (const TradeoffFamily &family : families_of(parameters(small)))
    if (family.setting.formulation == "stretch" && family.not_offered.empty())
    {
      EXPECT_EQ(family.setting.degree, 1u);
      ++n;
    }
  EXPECT_EQ(n, 2); // radau 5 and 9
}

TEST(TradeoffFamilies, StretchIsNotForGroundsThatChange)
{
  Parameters other     = parameters(small);
  other.ground.profile = "1+0.1*x";
  unsigned int n       = 0;
  for (const TradeoffFamily &family : families_of(other))
    if (family.setting.formulation == "stretch")
    {
      EXPECT_NE(family.not_offered.find("depends on the place"), std::string::npos) << family.not_offered;
      ++n;
    }
  EXPECT_EQ(n, 2 * 3 * 3);
}

TEST(TradeoffFamilies, LooseTolerancesAreNotForFineMeshes)
{
  for (const TradeoffFamily &family : families_of(parameters(small)))
    if (family.not_offered.empty() && family.setting.mesh == "uniform") // of the nonlinear model
    {
      const std::vector<double> expected = family.setting.cells == 8 ? std::vector<double>{1e-2, 1e-4, 1e-6}
                                           : family.setting.cells == 16
                                             ? std::vector<double>{1e-4, 1e-6}
                                             : std::vector<double>{1e-6}; // the last one anyway
      EXPECT_EQ(family.tolerances, expected) << in_words(family.setting);
    }
}

TEST(TradeoffFamilies, ReducedModelsHaveNoMesh)
{
  const auto all = families_of(parameters(small));
  EXPECT_EQ(in_words(all[0].setting), "model perturbation");
  EXPECT_EQ(all[0].tolerances.size(), 1);
  EXPECT_EQ(in_words(all[1].setting), "model kinematic");
  EXPECT_EQ(all[1].tolerances, (std::vector<double>{0.1, 1e-2, 1e-4, 1e-6}));
  EXPECT_EQ(all[1].first_index, 1);
  EXPECT_EQ(all[2].first_index, 5);
  Parameters other              = parameters(small + "set Models = perturbation\n");
  other.active_stress.generator = "none";
  const auto none               = families_of(other);
  ASSERT_EQ(none.size(), 1);
  EXPECT_NE(none[0].not_offered.find("a series for the optimal wave"), std::string::npos);
}

TEST(NextTolerance, EndsWhereTighterOnesCannotHelp)
{
  TradeoffFamily family;
  family.tolerances = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};
  const auto next   = [&](const std::vector<TriedSetting> &tried) {
    return next_tolerance(family, tried, /*reference=*/1., /*bar=*/1e-9);
  };
  EXPECT_EQ(next({}), 0);
  EXPECT_EQ(next({finished(1.1), finished(1.01)}), 2);
  EXPECT_EQ(next({finished(1.1), finished(1. + 1e-10)}), std::nullopt);                 // below the bar
  EXPECT_EQ(next({finished(1.1), finished(1.01), finished(1.0101)}), 3);                // settled once
  EXPECT_EQ(next({finished(1.01), finished(1.0101), finished(1.01011)}), std::nullopt); // and twice
  EXPECT_EQ(next({{"stopped", "time_limit", HUGE_VAL}}), std::nullopt);
  const TriedSetting failed{"failed", "newton_diverged", std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(next({failed, failed}), 2);
  EXPECT_EQ(next({failed, failed, failed}), std::nullopt);
  EXPECT_EQ(next({failed, failed, finished(1.1), failed}), 4);
  EXPECT_EQ(next({finished(1.1), finished(1.2), finished(1.3), finished(1.4), finished(1.5)}), std::nullopt); // the end
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

TEST(UsefulMeshes, AreEvenlySpacedFromPoorToWanted)
{
  using Meshes     = std::vector<std::pair<unsigned int, double>>;
  const Meshes all = {{1, HUGE_VAL}, {2, 0.5}, {3, 1e-2}, {4, 1e-4}, {6, 1e-6}, {8, 1e-8}, {12, 1e-10}, {16, 1e-12}};
  EXPECT_EQ(useful_meshes(all, 1e-5), (Meshes{{3, 1e-2}, {4, 1e-4}, {6, 1e-6}}));
  const Meshes some = useful_meshes(all, 1e-13);
  ASSERT_EQ(some.size(), 5);
  EXPECT_EQ(some.front().first, 3);
  EXPECT_EQ(some.back().first, 16);
  EXPECT_EQ(useful_meshes({{1, HUGE_VAL}, {2, 0.5}}, 1e-3), (Meshes{{2, 0.5}}));
}
