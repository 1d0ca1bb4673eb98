// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/words.h>

#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  class Declarations;

  /// Files of the snapshots: one for each (VTK), or one for all (XDMF and HDF5).
  enum class SnapshotFormat
  {
    vtu,
    xdmf
  };
  template <>
  inline constexpr const char *words_of<SnapshotFormat>[] = {"vtu", "xdmf"};

  /// Section "Output": results and files besides the displacement.
  struct OutputParameters
  {
    std::optional<unsigned int> n_snapshots;
    SnapshotFormat snapshot_format = SnapshotFormat::vtu;
    bool kymograph                 = true;
    bool statistics                = true;
    bool energy_balance            = true;
    std::optional<double> energy_balance_tolerance;
    std::vector<double> active_stress_table; ///< numbers of samples over s and t; empty: no table
    unsigned int segment_table = 0;          ///< parts of the duration; 0: no table
    std::string sensitivities  = "";         ///< entries, or "all" (studies/core/scene_numbers.h)
    std::string uncertainty    = "";         ///< entries and their standard deviations (likewise)

    /// True if derivatives by entries are wanted.
    bool
    differentiates() const
    {
      return !sensitivities.empty() || !uncertainty.empty();
    }

    bool
    has_snapshots() const
    {
      return n_snapshots != 0u;
    }

    void
    add_parameters(Declarations &declarations);
  };
} // namespace crawler
