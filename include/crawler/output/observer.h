// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/equation/assembler.h>
#include <crawler/equation/energy_balance.h>
#include <crawler/output/picture_times.h>
#include <crawler/time/stepper.h>

namespace crawler
{
  /// A state of a run, read-only, in the user's units except for what the equation is computed in: assembler, y, v and
  /// computed_time, whose units are given. It is the end of an accepted step, or what the integrator knows of a time
  /// within one; the first is the initial state.
  struct Snapshot
  {
    const Step &step;           ///< with the time of this state, which may be within the step
    bool is_step_end;           ///< an accepted state
    bool is_in_lost_step;       ///< seen before an inversion, but later than the answer's last state
    PictureKinds pictures;      ///< what it was asked for
    const Assembler &assembler; ///< mesh and formulation; may be another one in the next snapshot ...
    unsigned int mesh_number;   ///< ... and then this number is another one
    const Units &units;
    double computed_time;
    std::span<const double> y;      ///< the unknowns (assembler.h), owned values of this rank
    std::span<const double> v;      ///< velocity at the nodes; without an energy balance of pictures only
    const CellIntegrals &integrals; ///< those with v are as old as v
    const StretchRange &stretch;
    const EnergyBalance &energy_balance;
  };

  /// Looks at the accepted states of a run and at those that were asked for. Called on all ranks together.
  class Observer
  {
  public:
    virtual ~Observer() = default;

    virtual void
    observe(const Snapshot &snapshot) = 0;

    /// What it has seen so far, for one that goes on with the same files. Throws FileError if these are not there.
    virtual void
    exchange(Archive &)
    {
    }

    /// After the last state, however the run ended.
    virtual void
    end()
    {
    }
  };
} // namespace crawler
