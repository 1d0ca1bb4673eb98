// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What a change of the mesh keeps, also on several ranks.
#include "../../support/run_text.h"

#include <crawler/discretization/mesh_transfer.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <cmath>

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
    double length;           ///< between the ends [length]
    double stretched_length; ///< the integral of the stretch [length]
    double centre;           ///< of mass [length]
    double elastic_energy;
  };

  Invariants
  invariants(Assembler &form, const std::vector<double> &y)
  {
    const Discretization &d = form.discretization();
    const auto &element     = d.element();
    const auto u            = form.displacement(y);
    const auto log_w        = form.log_stretch(y);
    double own              = 0.;
    if (d.rank() == 0)
      own -= u.front();
    if (d.n_local() > 0 && !d.has_right_neighbour())
      own += u.back();
    const double length = 1. + dealii::Utilities::MPI::sum(own, MPI_COMM_WORLD);
    double stretched    = length;
    if (form.formulation() == Formulation::log_stretch)
    {
      own = 0.;
      for (unsigned int c = 0; c < d.n_local_cells(); ++c)
        for (unsigned int p = 0; p < element.degree; ++p)
          own += d.cell_size()[c] * element.stretch_weights[p] * std::exp(log_w[c * element.degree + p]);
      stretched = dealii::Utilities::MPI::sum(own, MPI_COMM_WORLD);
    }
    const CellIntegrals sum = form.integrals(0., y, std::vector<double>(d.n_owned(), 0.));
    return {length, stretched, sum.displacement, sum.elastic_energy};
  }

  void
  expect_same_shape(const Invariants &before, const Invariants &after, const std::string &which)
  {
    EXPECT_NEAR(before.length, after.length, 1e-14) << which;
    EXPECT_NEAR(before.stretched_length, after.stretched_length, 1e-14) << which;
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
  state(Assembler &form, const double roughness = 0.)
  {
    const Discretization &d = form.discretization();
    const auto &element     = d.element();
    const unsigned int q    = element.degree;
    const auto position     = create_assembler(Formulation::position, form.scene(), d);
    std::vector<double> local(d.n_local());
    for (unsigned int c = 0; c < d.n_local_cells(); ++c)
      for (unsigned int i = 0; i < element.n; ++i)
      {
        const double s   = d.cell_left()[c] + d.cell_size()[c] * element.nodes[i];
        local[c * q + i] = 0.06 * std::sin(5. * s) + 0.02 * s * s;
        if (form.formulation() == Formulation::position)
          local[c * q + i] +=
            roughness * d.cell_size()[c] / (q * q) * scattered((d.first_cell() + c) * static_cast<std::size_t>(q) + i);
      }
    const std::vector<double> u(local.begin() + (d.has_left_neighbour() ? 1 : 0), local.end());
    std::vector<double> y = MeshTransfer(element).transfer(*position, u, form);
    const auto log_w      = form.log_stretch(y);
    double *first         = y.data() + (log_w.data() - y.data());
    for (std::size_t i = 0; i < log_w.size(); ++i)
      first[i] += roughness * scattered(d.first_cell() * static_cast<std::size_t>(q) + i);
    return y;
  }

  const std::vector<Formulation> formulations = {Formulation::position, Formulation::log_stretch};

  std::string
  name(const Formulation formulation, const unsigned int degree)
  {
    return (formulation == Formulation::position ? "position, degree " : "log stretch, degree ") +
           std::to_string(degree);
  }
} // namespace

TEST(MeshTransfer, DivisionKeepsLengthCentreAndEnergy)
{
  for (unsigned int q = 1; q <= ReferenceElement::highest_degree; ++q)
    for (const Formulation formulation : formulations)
    {
      const Meshes meshes(q);
      ASSERT_EQ(meshes.fine->n_cells(), 8u);
      const auto from = create_assembler(formulation, meshes.scene, *meshes.coarse),
                 to   = create_assembler(formulation, meshes.scene, *meshes.fine);
      const auto y    = state(*from, 0.1);
      const auto z    = MeshTransfer(meshes.coarse->element()).transfer(*from, y, *to);
      ASSERT_EQ(z.size(), to->n_owned());
      const Invariants before = invariants(*from, y), after = invariants(*to, z);
      expect_same_shape(before, after, name(formulation, q));
      if (formulation == Formulation::position)
      {
        EXPECT_NEAR(before.elastic_energy, after.elastic_energy, 1e-14) << name(formulation, q);
      }
    }
}

TEST(MeshTransfer, JoiningKeepsLengthAndCentreAndEnergyAtMost)
{
  for (unsigned int q = 1; q <= ReferenceElement::highest_degree; ++q)
    for (const Formulation formulation : formulations)
      for (const double roughness : {0., 0.1, 0.3})
      {
        const Meshes meshes(q);
        ASSERT_EQ(meshes.again->n_cells(), 5u);
        const auto from = create_assembler(formulation, meshes.scene, *meshes.fine),
                   to   = create_assembler(formulation, meshes.scene, *meshes.again);
        const auto y    = state(*from, roughness);
        const auto z    = MeshTransfer(meshes.fine->element()).transfer(*from, y, *to);
        ASSERT_EQ(z.size(), to->n_owned());
        const Invariants before = invariants(*from, y), after = invariants(*to, z);
        const std::string which = name(formulation, q) + ", roughness " + test::text(roughness);
        expect_same_shape(before, after, which);
        // With more than one log w in a cell it is log w that is projected, not w: the error of that goes either way.
        const bool never_gains = formulation == Formulation::position || q == 1;
        EXPECT_LE(after.elastic_energy, before.elastic_energy * (1. + (never_gains ? 1e-14 : 1e-5))) << which;
      }
}

TEST(MeshTransfer, ThereAndBackAgain)
{
  for (unsigned int q = 1; q <= ReferenceElement::highest_degree; ++q)
    for (const Formulation formulation : formulations)
    {
      const Meshes meshes(q);
      const auto from = create_assembler(formulation, meshes.scene, *meshes.coarse),
                 via  = create_assembler(formulation, meshes.scene, *meshes.fine),
                 to   = create_assembler(formulation, meshes.scene, *meshes.again);
      const MeshTransfer transfer(meshes.coarse->element());
      const auto y    = state(*from, 0.1);
      const auto back = transfer.transfer(*via, transfer.transfer(*from, y, *via), *to);
      ASSERT_EQ(back.size(), y.size());
      for (std::size_t i = 0; i < y.size(); ++i)
        EXPECT_NEAR(back[i], y[i], 1e-13) << name(formulation, q) << ", unknown " << i;
    }
}

/// From one formulation to the other the shape stays.
TEST(MeshTransfer, ChangeOfFormulationKeepsLengthAndCentre)
{
  for (unsigned int q = 1; q <= ReferenceElement::highest_degree; ++q)
  {
    const Meshes meshes(q);
    const auto position = create_assembler(Formulation::position, meshes.scene, *meshes.coarse),
               log_form = create_assembler(Formulation::log_stretch, meshes.scene, *meshes.coarse);
    const auto u        = state(*position, 0.1);
    const auto y        = MeshTransfer(meshes.coarse->element()).transfer(*position, u, *log_form);
    ASSERT_EQ(y.size(), log_form->n_owned());
    expect_same_shape(invariants(*position, u), invariants(*log_form, y), name(Formulation::log_stretch, q));
  }
}
