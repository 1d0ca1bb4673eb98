// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Answers with numerics that neighbours in a sweep share (studies/sweep/sweep_numerics.h), against answers of runs that
// are alone and a hundred times as accurate.
#include "../support/answers.h"
#include "../support/test.h"

#include <crawler/run/result_table.h>
#include <crawler/studies/sweep/sweep_numerics.h>

using namespace crawler;
using test::never;

namespace
{
  bool
  always()
  {
    return true;
  }

  constexpr unsigned long n_points = 60, n_all = 600; ///< of a block that is looked at, and of the sweep

  SweepPoints
  points_of(const std::string &scene, const std::string &axes, const double accuracy)
  {
    return {MPI_COMM_SELF,
            ParameterFile::from_text(fmt::format("set Accuracy = {}\n{}\nsubsection Sweep\n set Design = random\n "
                                                 "set Number of points = {}\n set Axes = {}\nend\n",
                                                 accuracy,
                                                 scene,
                                                 n_all,
                                                 axes),
                                     "test.prm")};
  }

  struct Family
  {
    const char *name, *scene, *axes;
    double min_part; ///< of the points that the shared numerics must answer
  };

  const std::string set_by_speed =
    "subsection Active stress\n subsection Optimal wave\n set Choose wave by = wave speed\n "
    "set Wave speed = 1\n end\nend\n";

  SweepPoints
  grid_of(const std::string &axes)
  {
    return {MPI_COMM_SELF,
            ParameterFile::from_text(set_by_speed + "subsection Sweep\n set Axes = " + axes + "\nend\n", "test.prm")};
  }

  void
  expect_covered(const Family &family, const double accuracy)
  {
    const std::string scene = set_by_speed + family.scene;
    SweepPoints points      = points_of(scene, family.axes, accuracy),
                exact       = points_of(scene, family.axes, 0.01 * accuracy);
    SweepNumerics numerics(points), others(exact);
    const SweepBlock all = {0, n_points};
    unsigned long n      = 0;
    for (unsigned long i = 0; i < n_points; ++i)
    {
      const auto shared = numerics.at(all, i, always);
      if (shared.choice == nullptr)
        continue;
      Task task       = numerics.task(i);
      const auto done = compute_similar({&task, 1}, *shared.choice, {numerics.size_at(shared, i)}, HUGE_VAL, never);
      if (!done.front())
        continue;
      ++n;
      const SimulationResult &result = task.computed.result;
      EXPECT_LE(result.error->total, accuracy * std::abs(result.displacement)) << family.name << ", point " << i;
      if (i % 4 != 0)
        continue;
      Task finer = others.task(i);
      compute_all({&finer, 1}, HUGE_VAL, never);
      ASSERT_EQ(finer.computed.result.time.status, Status::finished) << family.name << ", point " << i;
      EXPECT_LE(std::abs(result.displacement - finer.computed.result.displacement),
                result.error->total + finer.computed.result.error->total)
        << family.name << ", point " << i;
      const auto &entries = entries_with_errors();
      for (std::size_t e = 0; e < entries.size(); ++e)
      {
        const auto value = entries[e]->value(result), true_value = entries[e]->value(finer.computed.result);
        if (std::holds_alternative<double>(value) && std::holds_alternative<double>(true_value))
        {
          EXPECT_LE(std::abs(std::get<double>(value) - std::get<double>(true_value)),
                    result.errors[e] + finer.computed.result.errors[e])
            << family.name << ", point " << i << ", " << entries[e]->key;
        }
      }
    }
    EXPECT_GE(n, static_cast<unsigned long>(family.min_part * n_points)) << family.name;
  }
} // namespace

TEST(SharedNumerics, BoundsCoverTheErrors)
{
  const std::string chi   = "Active stress/Optimal wave/Perturbation parameter : uniform(0.05, 0.4)",
                    p     = "Body/Anchoring exponent : uniform(1.5, 4)";
  const std::string p_chi = p + "; " + chi, k_chi = "Body/Elastic modulus : loguniform(0.1, 100); " + chi,
                    c_chi = "Active stress/Optimal wave/Wave speed : uniform(0.5, 3); " + chi;
  for (const double accuracy : {1e-3, 1e-4, 1e-6})
  {
    expect_covered({"p, chi", "", p_chi.c_str(), 0.9}, accuracy);
    expect_covered({"k, chi", "", k_chi.c_str(), 0.7}, accuracy);
    expect_covered({"c, chi", "", c_chi.c_str(), 0.8}, accuracy); // some nearly invert
    expect_covered({"stiffness profile",
                    "subsection Body\n set Elastic modulus profile = 1+0.5*sin(3*s)\nend\n",
                    p_chi.c_str(),
                    0.9},
                   accuracy);
  }
}

/// Without bounds no finer run finds those whose error is larger than Accuracy allows, so there must be none; and a
/// displacement far below what the examples make one expect is none of theirs.
TEST(SharedNumerics, WithoutBoundsErrorsAreWithinAccuracy)
{
  const std::string scene = "set Error estimate = false\n" + set_by_speed,
                    chi   = "; Active stress/Optimal wave/Perturbation parameter : uniform(0.05, 0.4)";
  for (const double accuracy : {1e-3, 1e-5})
    for (const char *axis : {"Body/Anchoring exponent : uniform(1.5, 4)",
                             "Body/Elastic modulus : loguniform(0.1, 100)",
                             "Active stress/Optimal wave/Wave speed : uniform(0.5, 3)"})
    {
      SweepPoints points = points_of(scene, axis + chi, accuracy),
                  exact  = points_of(scene, axis + chi, 0.01 * accuracy);
      SweepNumerics numerics(points), others(exact);
      const SweepBlock all = {0, n_points};
      unsigned long n      = 0;
      for (unsigned long i = 0; i < n_points; i += 2)
      {
        const auto shared = numerics.at(all, i, always);
        if (shared.choice == nullptr)
          continue;
        const double size = numerics.size_at(shared, i);
        Task task = numerics.task(i), small = numerics.task(i), finer = others.task(i);
        if (!compute_similar({&task, 1}, *shared.choice, {size}, HUGE_VAL, never).front())
          continue;
        ++n;
        compute_all({&finer, 1}, HUGE_VAL, never);
        const double D = task.computed.result.displacement, true_D = finer.computed.result.displacement;
        EXPECT_FALSE(task.computed.result.error);
        EXPECT_LE(std::abs(D - true_D), accuracy * std::abs(true_D)) << axis << ", point " << i;
        EXPECT_FALSE(compute_similar({&small, 1}, *shared.choice, {2.1 * std::abs(D)}, HUGE_VAL, never).front());
      }
      EXPECT_GE(n, n_points / 3) << axis;
    }
}

/// Whoever asks, and in which order, gets the same.
TEST(SharedNumerics, DependOnTheBlockAlone)
{
  SweepPoints points =
    points_of(set_by_speed, "Active stress/Optimal wave/Perturbation parameter : uniform(0.05, 0.45)", 1e-4);
  const SweepBlock all = {0, n_points}, other = {0, n_points / 2};
  SweepNumerics forward(points), backward(points);
  const auto a             = forward.at(all, 0, always);
  const double tolerance   = a.choice->relative_tolerance;
  const double size        = forward.size_at(a, 7);
  const unsigned int cells = a.choice->choice.numerics.n_cells;
  backward.at(other, 3, always);
  const auto b = backward.at(all, n_points - 1, always);
  EXPECT_EQ(b.choice->relative_tolerance, tolerance);
  EXPECT_EQ(b.choice->choice.numerics.n_cells, cells);
  EXPECT_EQ(backward.size_at(b, 7), size);
}

/// Neighbours of different kinds share nothing, but parts of them may.
TEST(SharedNumerics, BlocksOfDifferentKindsAreDivided)
{
  SweepPoints points = grid_of("Time/Integrator : bdf, radau 9; Body/Anchoring exponent : linspace(1.5, 4, 300)");
  SweepNumerics numerics(points);
  const SweepBlock some = {280, 40};
  EXPECT_EQ(numerics.at(some, 283, always).choice, nullptr) << "bdf is not for the fused engine";
  const auto shared = numerics.at(some, 313, always);
  ASSERT_NE(shared.choice, nullptr);
  EXPECT_EQ(shared.points.first, 300u);
  EXPECT_EQ(shared.points.size, 20u);
}

/// Where each rank would measure for a few points only, each point chooses for itself.
TEST(SharedNumerics, AreForManyPoints)
{
  SweepPoints points = grid_of("Body/Anchoring exponent : linspace(1.5, 4, 100)");
  SweepNumerics numerics(points);
  EXPECT_EQ(numerics.at({0, 100}, 3, always).choice, nullptr);
}
