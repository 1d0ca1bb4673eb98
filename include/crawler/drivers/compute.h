// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/drivers/numerics_choice.h>
#include <crawler/drivers/parameters.h>
#include <crawler/drivers/simulation.h>

#include <functional>

namespace crawler
{
  /// One run without files.
  struct Computed
  {
    SimulationResult result;
    NumericsChoice choice;
  };

  /**
   * What `crawler run` computes for @p scene (made from @p parameters), on this rank alone and without files: choice of
   * the numerics, simulation, self-check. @p keep_going is asked after every step, those of
   * pilot runs too; if it stops one of these, the status is "stopped" and nothing else is known. The place where
   * studies of many runs make a Simulation.
   */
  Computed
  compute(const Parameters &parameters, const Scene &scene, const std::function<bool()> &keep_going);
} // namespace crawler
