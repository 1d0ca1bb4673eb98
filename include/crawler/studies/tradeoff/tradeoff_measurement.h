// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>
#include <crawler/studies/tradeoff/tradeoff_table.h>

#include <functional>
#include <optional>

namespace crawler
{
  /// Processor time of this process [s].
  double
  processor_seconds();

  /// Bytes of the heap that are in use; not a number where the C library does not say (it does with glibc).
  double
  heap_bytes();

  /// Measures settings one after the other.
  class TradeoffMeasurement
  {
  public:
    /// Both references are kept. @p size is that to which tolerances are relative [length].
    TradeoffMeasurement(const Parameters &parameters,
                        const Scene &scene,
                        double size,
                        std::function<bool()> interrupted);

    /**
     * The row of a setting: what `crawler run` computes without snapshots, on this rank alone. The first run gives
     * displacement and memory, and must keep the time limit, or tighter tolerances on the same mesh are not tried; the
     * others are timed. The cost is the processor time to build the simulation and run it, without the choice of the
     * numerics, in a process that has done so before. Nothing is returned if it was interrupted. What goes wrong is
     * the status of the row.
     */
    std::optional<TradeoffRow>
    measure(const TradeoffSetting &setting);

  private:
    using KeepGoing = std::function<bool()>;

    SimulationResult
    run(const Parameters &own, const Numerics &numerics, const KeepGoing &keep_going) const;
    bool
    measure(TradeoffRow &row);
    bool
    time_runs(TradeoffRow &row, const Parameters &own, const Numerics &numerics, double first_seconds) const;

    const Parameters &parameters_;
    const Scene &scene_;
    const double size_;
    const std::function<bool()> interrupted_;
    TradeoffSetting setting_;    ///< the last one
    bool took_too_long_ = false; ///< a looser tolerance on this mesh
  };
} // namespace crawler
