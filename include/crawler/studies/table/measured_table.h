// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/table/preparation.h>

#include <cstdint>
#include <string>
#include <vector>

namespace crawler
{
  /// What the command line says behind `crawler table`.
  struct TableOptions
  {
    std::string input, output; ///< files
    SampleSettings samples;
    PreparationSettings preparation;
    std::string scene; ///< a parameter file: the uncertainty of its displacement is found
    std::vector<std::string> overrides;
    unsigned int n_copies = 64;
    std::uint64_t seed    = 1;
    bool overwrite = false, quiet = false;
  };

  /**
   * crawler table: turns a file of measured samples into a table for the generators "table" and "prescribed strain".
   * Writes OUT.csv, the samples as they were in OUT_before.csv, and what was changed in OUT_report.txt. Throws
   * InputError and FileError.
   */
  void
  make_table(const TableOptions &options);
} // namespace crawler
