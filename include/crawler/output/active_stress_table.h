// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>
#include <crawler/scene/unit_names.h>

#include <filesystem>
#include <string>
#include <vector>

namespace crawler
{
  /// Throws InputError unless the entry Output/Active stress table is empty, or two whole numbers from 2 on, and the
  /// active stress is a function of s and t alone.
  void
  require_table_fits(const std::vector<double> &size, const ActiveStress &stress);

  /**
   * Writes the samples of an active stress at @p n_s equally spaced places of the whole body [length] and @p n_t
   * equally spaced times from 0 to @p end_time [time]: CSV with the header s,t,m, which the generator "table" reads.
   * Returns an error message, and writes nothing, if a sample is not a finite number. Throws FileError.
   */
  std::string
  write_active_stress_table(const std::filesystem::path &path,
                            const ActiveStress &stress,
                            double length,
                            double end_time,
                            unsigned int n_s,
                            unsigned int n_t);

  /// Throws InputError if Output/Segment table asks for @p n_parts and the active stress has no segments, or too many.
  void
  require_segment_table_fits(unsigned int n_parts, const ActiveStress &stress);

  /**
   * Writes the input of a controller of segments: segments.csv has a column with the active stress of each segment, and
   * rows at the ends of @p n_parts equal parts of the duration and two at each jump; segment_switching.csv has a row
   * for each switching time. Throws FileError.
   */
  void
  write_segment_tables(const std::filesystem::path &folder,
                       const ActiveStress &stress,
                       double end_time,
                       unsigned int n_parts,
                       const UnitNames &units);
} // namespace crawler
