// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/point_laws.h>
#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_friction.h>

/// Input and results of the loops over all cells (included by lane_kernels.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  template <typename Pack>
  struct LaneMesh
  {
    int n_cells;
    const double *sizes; ///< [n_cells]
    ElementTables tables;
    Pack k;
    LaneFriction<Pack> friction;
    const PointLaws<Pack> *laws = nullptr; ///< laws of general bodies for the present state, replacing k and friction
  };

  /// Eigenvalues of A^-1, divided by the size of the step: the systems of Newton's method are K + shift M.
  template <typename Pack, int pairs>
  struct LaneShifts
  {
    Pack real;
    Complex<Pack> complex[pairs];

    void
    set(const LaneSetup &setup, const Pack &inverse_h)
    {
      real = setup.method.real_eigenvalue * inverse_h;
      for (int j = 0; j < pairs; ++j)
        complex[j] = {setup.method.eigenvalues[2 * j] * inverse_h, setup.method.eigenvalues[2 * j + 1] * inverse_h};
    }
  };

  /// CellIntegrals of a pack of bodies.
  template <typename Pack>
  struct LaneIntegrals
  {
    Pack elastic_energy{}, stress_power{}, positive_power{}, absolute_power{}, dissipation{}, net_friction{},
      abs_friction{}, velocity{};
  };

  /// Extreme stretches, and the numbers of their samples.
  template <typename Pack>
  struct LaneExtremes
  {
    Pack least = broadcast<Pack>(HUGE_VAL), most = broadcast<Pack>(-HUGE_VAL), min_at{}, max_at{};

    /// Compares the stretch at a sample with the extremes so far.
    void
    see(const Pack &w, const Pack &sample)
    {
      min_at = w < least ? sample : min_at;
      least  = smaller(w, least);
      max_at = w > most ? sample : max_at;
      most   = w > most ? w : most;
    }
  };

  /// Observation of a state: extremes and integrals.
  template <typename Pack>
  struct LaneLook
  {
    LaneExtremes<Pack> stretch;
    LaneIntegrals<Pack> sums;
    Pack end_stretch[2] = {}, end_rate[2] = {}; ///< stretch at both ends, and its rate
  };

  /// State at all points: displacement, velocity, strain and its rate.
  template <typename Pack>
  struct LaneStateAtPoints
  {
    Pack *u, *v, *e, *rate;
  };

  /// Derivatives of friction f and force N at all points of a state: by velocity, stretch, place and stretch rate.
  /// Null: 0.
  template <typename Pack>
  struct LaneSlopes
  {
    Pack *f_v = nullptr, *f_w = nullptr, *N_w = nullptr, *f_u = nullptr, *N_rate = nullptr;
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
