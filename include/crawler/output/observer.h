// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/equation/assembler.h>
#include <crawler/equation/energy_balance.h>
#include <crawler/output/picture_times.h>
#include <crawler/time/stepper.h>

#include <functional>
#include <memory>
#include <vector>

namespace crawler
{
  /// A state of a run, read-only, in the user's units except for assembler, y, v and computed_time, which are in
  /// `units`. It is the end of an accepted step, or interpolated within one; the first is the initial state.
  struct Snapshot
  {
    const Step &step;           ///< with the time of this state, which may be within the step
    bool is_step_end;           ///< an accepted state
    bool is_in_lost_step;       ///< before an inversion, but later than the answer's last state
    PictureKinds pictures;      ///< pictures for which it was requested
    const Assembler &assembler; ///< mesh and formulation; may change from one snapshot to the next ...
    unsigned int mesh_number;   ///< ... together with this number
    const Units &units;
    double computed_time;
    std::span<const double> y;      ///< the unknowns (assembler.h), owned values of this rank
    std::span<const double> v;      ///< velocity at the nodes; only for pictures if there is no energy balance
    const CellIntegrals &integrals; ///< those that contain v belong to the same time as `v`
    const StretchRange &stretch;
    const EnergyBalance &energy_balance;
  };

  /// Sees the accepted states of a run and the requested ones. Called on all ranks together.
  class Observer
  {
  public:
    virtual ~Observer() = default;

    virtual void
    observe(const Snapshot &snapshot) = 0;

    /// Exchanges the data collected so far, to continue the same files. Throws FileError if these are missing.
    virtual void
    exchange(Archive &)
    {
    }

    /// Called after the last state, however the run ended.
    virtual void
    end()
    {
    }
  };

  /// Observers, one in number, that show each snapshot of a run to @p see.
  inline std::vector<std::unique_ptr<Observer>>
  watched_by(std::function<void(const Snapshot &)> see)
  {
    struct Watcher : public Observer
    {
      explicit Watcher(std::function<void(const Snapshot &)> see)
        : see(std::move(see))
      {
      }
      void
      observe(const Snapshot &snapshot) override
      {
        see(snapshot);
      }
      const std::function<void(const Snapshot &)> see;
    };
    std::vector<std::unique_ptr<Observer>> observers;
    observers.push_back(std::make_unique<Watcher>(std::move(see)));
    return observers;
  }
} // namespace crawler
