// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/model_choice.h>
#include <crawler/accuracy/numerics_choice.h>
#include <crawler/run/numerics.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/log.h>

#include <string>

namespace crawler
{
  /// Mesh and steps in words, for the user.
  std::string
  in_words(const Numerics &numerics, const Input &input);

  /// Logs what will be computed. @p choice: null on a level that needs no mesh.
  void
  report_plan(Log &log, const Input &input, const ModelChoice &model, const NumericsChoice *choice);
} // namespace crawler
