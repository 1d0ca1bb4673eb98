// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/adjoint/cell_points.h>
#include <crawler/adjoint/forces_at_points.h>

#include <array>
#include <vector>

namespace crawler
{
  /// Quantity of a gradient; the works over the whole run as in EnergyBalance, displacement and speed of the last
  /// stride as in Gait.
  enum class Quantity
  {
    displacement,
    stress_work,
    dissipation,
    positive_work,
    paper_energy,
    stride,
    speed
  };

  inline constexpr std::array<Quantity, 7> all_quantities = {{Quantity::displacement,
                                                              Quantity::stress_work,
                                                              Quantity::dissipation,
                                                              Quantity::positive_work,
                                                              Quantity::paper_energy,
                                                              Quantity::stride,
                                                              Quantity::speed}};

  inline bool
  is_work(const Quantity quantity)
  {
    return quantity >= Quantity::stress_work && quantity <= Quantity::paper_energy;
  }

  /// Forces of a scene at points in the body and at its ends.
  struct ForcesOfScene
  {
    ForcesOfScene(const Scene &physical, const Scene &other, const std::vector<double> &points);

    /// Evaluates at a state, @p at_ends of the body, within a step that ends at @p end.
    void
    evaluate(double end, const StateAtPoints &at, const StateAtPoints &at_ends);

    ForcesAtPoints inside, ends;
  };

  /// Rate at which a work grows, in natural units, at a state that was evaluated. The state is that of another scene,
  /// and so are lengths and times: the rate is per unit of time of that scene.
  double
  work_rate(Quantity work,
            const CellPoints &cells,
            const ForcesOfScene &forces,
            const StateAtPoints &at,
            const StateAtPoints &at_ends);

  /// Adds @p weight times the derivatives of the rate by displacement and velocity at the nodes; of the scene itself.
  void
  add_slopes_of_work(Quantity work,
                     double weight,
                     const CellPoints &cells,
                     ForcesOfScene &forces,
                     const StateAtPoints &at,
                     std::size_t n_nodes,
                     double *by_u,
                     double *by_v);
} // namespace crawler
