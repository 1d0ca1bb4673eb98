// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/grid_table.h>
#include <crawler/studies/table/preparation_settings.h>
#include <crawler/studies/table/samples.h>

#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  struct PreparedTable
  {
    MeasuredQuantity quantity;      ///< active stress or strain
    GridTable grid;                 ///< full
    std::optional<double> period;   ///< its last samples are the first ones
    double noise;                   ///< as given, or as estimated from the samples
    std::vector<std::string> words; ///< what was changed
  };

  /**
   * A full table from samples with gaps and noise: tracks of markers become strains, gaps are filled by splines,
   * samples smoothed, the cycles of a period averaged and closed. Throws InputError where a gap is too large, where
   * there is no period, and where the ends of a period differ by more than the noise.
   */
  PreparedTable
  prepare_table(const Samples &samples, const PreparationSettings &settings);

  /// The standard deviation of the noise of samples, by differences of third order in time; what changes little from
  /// sample to sample does not count.
  double
  estimated_noise(const Samples &samples);
} // namespace crawler
