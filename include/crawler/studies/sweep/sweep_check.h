// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/log.h>

#include <mpi.h>

#include <string>

namespace crawler
{
  class ParameterFile;
  class SweepDesign;

  /// Does the parameter file declare a sweep? Then says how large it is and how long it will take (`crawler check`).
  bool
  check_sweep(MPI_Comm communicator, const ParameterFile &file, Log &log);

  /// "6 points, grid over Body/Length (2 values), ..."
  std::string
  in_words(const SweepDesign &design, const std::string &design_name);
} // namespace crawler
