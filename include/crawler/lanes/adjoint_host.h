// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

/// Host and data of the adjoint of a run by the fused engine (lane_engine.h): plain data only, in natural units.
namespace crawler
{
  /// Run to traverse backwards. All arrays belong to the caller.
  struct LanePast
  {
    unsigned int n_steps = 0;
    const double *times = nullptr, *sizes = nullptr; ///< [n_steps] ends and lengths of the steps
    const double *z             = nullptr;           ///< [n_steps][stages][unknowns] as in LaneStep
    const double *end           = nullptr;           ///< [unknowns] last state
    const unsigned char *starts = nullptr;           ///< [n_steps] true if the body starts anew
    const double *gradient      = nullptr; ///< [unknowns] derivative of the quantity of interest by the last state
    bool has_sources            = false;   ///< true if the quantity of interest depends on the steps, too
  };

  /// Derivatives of the quantity of interest by the states of a step themselves. The arrays are 0 before.
  struct LaneSources
  {
    double *by_end;             ///< [unknowns] the state at the end of the step
    double *by_u, *by_velocity; ///< [stages][unknowns] displacements and velocities in the stages
  };

  /// Host of a run that is traversed backwards.
  class LaneAdjointHost
  {
  public:
    virtual ~LaneAdjointHost() = default;

    /// Takes the adjoint of a step. @p mu: [stages][unknowns] derivative of the quantity of interest by the residuals,
    /// with the sign of dF. @p zeta: [unknowns] M^-1 times the derivative of the quantity of interest by the state at
    /// the end of the step: minus the effect of an impulse there; null unless the body starts anew with the next step,
    /// or there is none.
    virtual void
    step(unsigned int step, const double *mu, const double *zeta) = 0;
    /// Called before each step of a run that has sources.
    virtual void
    sources(unsigned int step, const LaneSources &sources) = 0;
  };
} // namespace crawler
