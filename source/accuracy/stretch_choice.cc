// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/mesh_choices.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    /// Cells of the coarsest mesh, cells for each length in which the active stress changes, and the time tolerance
    /// relative to the strain, as a multiple of Accuracy and at most.
    constexpr unsigned int first_family_cells = 25;
    constexpr double cells_of_length = 4., family_tolerance = 10., largest_family_tolerance = 1e-3;
    /// Layers: layer_lengths times k/max|m_s| thick, at most this part of the body.
    constexpr double layer_lengths = 1., largest_layer = 0.02;
  } // namespace

  void
  choose_stretch_form(const Pilots &pilots, NumericsChoice &choice)
  {
    using namespace mesh_choice;
    const RunParameters &own = pilots.parameters;
    const Scene &scene       = pilots.scene;
    const double L = scene.body.length, length = pilots.scales.length;
    const double m_s = pilots.scales.stress / length, a = std::max(1., std::abs(scene.friction_exponent()));
    const auto &user_cells = own.discretization.n_cells;
    Numerics &n            = choice.numerics;
    n.formulation          = Formulation::stretch;
    n.degree               = 1;
    n.mesh                 = {};
    n.grading              = {};
    n.layer =
      m_s > 0. ? std::min(largest_layer * L, layer_lengths / a * scene.body.elastic_modulus / m_s) : largest_layer * L;
    if (own.discretization.mesh == MeshKind::uniform)
      n.layer = 0.;
    n.parts            = 1;
    n.integrator       = "radau 5";
    choice.strain      = std::min(pilots.scale / std::min(L, length), 0.3);
    const double first = std::clamp(std::ceil(cells_of_length * L / length), 1. * first_family_cells, 0.25 * max_cells);
    n.n_cells          = user_cells.value_or(static_cast<unsigned int>(first));
    n.tolerance        = own.time.tolerance.value_or(
      std::max(std::min(family_tolerance * own.accuracy, largest_family_tolerance) * choice.strain * L, 1e-13 * L));
    if (!own.time.initial_step)
      n.initial_step = 1e-4 * scene.end_time;
    choice.is_family    = !user_cells;
    choice.is_users     = !choice.is_family;
    choice.wanted_error = choice.space_share = std::numeric_limits<double>::quiet_NaN();
    choice.explanation =
      choice.is_family
        ? fmt::format("for Accuracy {:g}: the stretch form, on ever finer meshes until the displacement settles",
                      own.accuracy)
        : "stretch form, with cells as set by the user";
  }
} // namespace crawler
