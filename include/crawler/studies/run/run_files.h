// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>
#include <crawler/base/exceptions.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/log.h>

#include <filesystem>
#include <string>

namespace crawler
{
  struct SimulationResult;

  /// Mesh and steps in words, for the user.
  std::string
  in_words(const Numerics &numerics, const Input &input);

  /// Logs what will be computed. @p choice: null on a level that needs no mesh.
  void
  report_plan(Log &log, const Input &input, const ModelChoice &model, const NumericsChoice *choice);

  /// Reports how a run ended, where its results are, and that @p animation among them opens in ParaView (empty: there
  /// is none). Returns the exit code.
  ExitCode
  report_end(Log &log,
             const SimulationResult &result,
             const UnitNames &units,
             const std::filesystem::path &folder,
             const std::string &animation);
} // namespace crawler
