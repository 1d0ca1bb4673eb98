// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/assembler.h>
#include <crawler/observers/ledger.h>
#include <crawler/time/time_stepper.h>

namespace crawler
{
  /// An accepted state of a run, read-only. Vectors are the owned values of this rank.
  struct Snapshot
  {
    const Step &step;
    bool is_frame;                  ///< one of the snapshots that were asked for, the initial state included
    std::span<const double> u;      ///< displacement [length]
    std::span<const double> v;      ///< velocity [length/time]; without a ledger of snapshots only
    const CellIntegrals &integrals; ///< those with v are as old as v
    const StretchRange &stretch;
    const Ledger &ledger;
  };

  /// Looks at the accepted states of a run. Called on all ranks together.
  class Observer
  {
  public:
    virtual ~Observer() = default;

    virtual void
    observe(const Snapshot &snapshot) = 0;

    /// After the last state, however the run ended.
    virtual void
    end()
    {
    }
  };
} // namespace crawler
