// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/parameters/parameter_file.h>
#include <crawler/studies/table/preparation.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

namespace crawler
{
  /// The displacement by a table, and what the noise of its samples makes uncertain [length].
  struct NoisyDisplacement
  {
    double displacement;
    std::optional<double> bound; ///< of the numerical error, as of every run
    double mean, deviation;      ///< of the copies; the deviation is the uncertainty
    unsigned int n_copies;       ///< that finished
  };

  /// A table as the generators "table" and "prescribed strain" read it.
  std::string
  table_text(const PreparedTable &table);

  /**
   * Bootstrap: @p n_copies of the samples get normally distributed noise of the standard deviation prepared.noise each,
   * are prepared like the samples (with the period of @p prepared), and the scene is computed with each of these
   * tables, in the lanes of the batch engine where it fits (studies/core/compute.h). The smoothing, the mean of cycles
   * and the derivative of tracks act on the noise as they do on that of the measurement. Throws InputError if the scene
   * does not use a table of this kind, and if a run or more than a tenth of the copies do not finish. @p progress is
   * called now and then.
   */
  NoisyDisplacement
  noisy_displacement(const Samples &samples,
                     PreparationSettings settings,
                     const PreparedTable &prepared,
                     const ParameterFile &scene,
                     unsigned int n_copies,
                     std::uint64_t seed,
                     const std::function<void()> &progress);
} // namespace crawler
