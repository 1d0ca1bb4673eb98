// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What a change of the mesh keeps, also on several ranks.
#include "../../support/expect_near.h"
#include "../../support/ranks.h"
#include "../../support/run_text.h"
#include "../../support/test.h"

#include <crawler/equation/mesh_transfer.h>
#include <crawler/equation/position_form.h>

using namespace crawler;

namespace
{
  constexpr auto keep = CellChange::keep, divide = CellChange::divide, join = CellChange::join;

  double
  scattered(const std::size_t i)
  {
    return std::sin(12.9898 * static_cast<double>(i + 1) + 78.233);
  }

  /// What must not change.
  struct Invariants
  {
    double length; ///< between the ends [length]
    double centre; ///< of mass [length]
    double elastic_energy;
  };

  Invariants
  invariants(PositionForm &form, const std::vector<double> &u)
  {
    const Discretization &d = form.discretization;
    double own              = 0.;
    if (d.rank == 0)
      own -= u.front();
    if (d.n_local() > 0 && !d.has_right_neighbour())
      own += u.back();
    const CellIntegrals sum = form.integrals(0., u, std::vector<double>(d.n_owned(), 0.));
    return {1. + test::over_ranks(own), sum.displacement, sum.elastic_energy};
  }

  void
  expect_same_shape(const Invariants &before, const Invariants &after, const std::string &which)
  {
    EXPECT_NEAR(before.length, after.length, 1e-14) << which;
    EXPECT_NEAR(before.centre, after.centre, 1e-14) << which;
  }

  /// A mesh, one with some cells divided, and the first one again.
  struct Meshes
  {
    explicit Meshes(const unsigned int degree)
      : scene(test::parameters_with(test::wave(-1., 0.3)).create_scene())
      , coarse(std::make_unique<Discretization>(MPI_COMM_WORLD, 1., 5, degree))
      , fine(coarse->adapted({divide, keep, divide, divide, keep}))
      , again(fine->adapted({join, join, keep, join, join, join, join, keep}))
    {
    }

    Scene scene;
    std::unique_ptr<Discretization> coarse, fine, again;
  };

  /// A state with stretches between about 0.6 and 1.4; @p roughness is added to each unknown on its own.
  std::vector<double>
  state(const PositionForm &form, const double roughness)
  {
    const Discretization &d = form.discretization;
    const auto &element     = d.element;
    const unsigned int q    = element.degree;
    std::vector<double> local(d.n_local());
    for (unsigned int c = 0; c < d.n_local_cells(); ++c)
      for (unsigned int i = 0; i < element.n; ++i)
      {
        const double s = d.cell_left[c] + d.cell_size[c] * element.nodes[i];
        local[c * q + i] =
          0.06 * std::sin(5. * s) + 0.02 * s * s +
          roughness * d.cell_size[c] / (q * q) * scattered((d.first_cell + c) * static_cast<std::size_t>(q) + i);
      }
    return {local.begin() + (d.has_left_neighbour() ? 1 : 0), local.end()};
  }

  std::string
  name(const unsigned int degree)
  {
    return "degree " + std::to_string(degree);
  }
} // namespace

TEST(MeshTransfer, DivisionKeepsLengthCentreAndEnergy)
{
  for (unsigned int q = 1; q <= ReferenceElement::highest_degree; ++q)
  {
    const Meshes meshes(q);
    ASSERT_EQ(meshes.fine->n_cells(), 8u);
    const auto from = std::make_unique<PositionForm>(meshes.scene, *meshes.coarse),
               to   = std::make_unique<PositionForm>(meshes.scene, *meshes.fine);
    const auto y    = state(*from, 0.1);
    const auto z    = transferred(*from, y, *to);
    ASSERT_EQ(z.size(), to->n_owned());
    const Invariants before = invariants(*from, y), after = invariants(*to, z);
    expect_same_shape(before, after, name(q));
    EXPECT_NEAR(before.elastic_energy, after.elastic_energy, 1e-14) << name(q);
  }
}

TEST(MeshTransfer, JoiningKeepsLengthAndCentreAndEnergyAtMost)
{
  for (unsigned int q = 1; q <= ReferenceElement::highest_degree; ++q)
    for (const double roughness : {0., 0.1, 0.3})
    {
      const Meshes meshes(q);
      ASSERT_EQ(meshes.again->n_cells(), 5u);
      const auto from = std::make_unique<PositionForm>(meshes.scene, *meshes.fine),
                 to   = std::make_unique<PositionForm>(meshes.scene, *meshes.again);
      const auto y    = state(*from, roughness);
      const auto z    = transferred(*from, y, *to);
      ASSERT_EQ(z.size(), to->n_owned());
      const Invariants before = invariants(*from, y), after = invariants(*to, z);
      const std::string which = name(q) + ", roughness " + test::text(roughness);
      expect_same_shape(before, after, which);
      EXPECT_LE(after.elastic_energy, before.elastic_energy * (1. + 1e-14)) << which;
    }
}

TEST(MeshTransfer, ThereAndBackAgain)
{
  for (unsigned int q = 1; q <= ReferenceElement::highest_degree; ++q)
  {
    const Meshes meshes(q);
    const auto from = std::make_unique<PositionForm>(meshes.scene, *meshes.coarse),
               via  = std::make_unique<PositionForm>(meshes.scene, *meshes.fine),
               to   = std::make_unique<PositionForm>(meshes.scene, *meshes.again);
    const auto y    = state(*from, 0.1);
    test::expect_near(transferred(*via, transferred(*from, y, *via), *to), y, 1e-13, name(q));
  }
}
