// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/tradeoff/tradeoff_settings.h>

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// Row of a setting that is not computed, for this reason; with the limit [s] if it would take too long.
  TradeoffTexts
  gap(const std::string &status,
      const std::string &reason,
      const std::string &message,
      double limit = std::numeric_limits<double>::quiet_NaN());

  /**
   * Row of a setting: the computation of `crawler run` without snapshots, on this rank alone; @p entries are those of
   * the setting. The first run gives displacement and memory, and must keep the time limit; the others are timed. The
   * cost is the processor time to build the simulation and run it, without the choice of the numerics, in a process
   * that has done so before. Returns nothing if it was interrupted. Failures are the status of the row.
   */
  std::optional<TradeoffTexts>
  measure(const Input &input,
          const TradeoffSetting &setting,
          const std::vector<std::string> &overrides,
          const std::function<bool()> &interrupted);
} // namespace crawler
