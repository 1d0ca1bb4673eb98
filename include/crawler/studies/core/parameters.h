// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/run_parameters.h>
#include <crawler/studies/core/atlas_parameters.h>
#include <crawler/studies/core/sweep_parameters.h>
#include <crawler/studies/core/tradeoff_parameters.h>

namespace crawler
{
  /// All sections of the parameter file: those of one run, and those of each study of many runs.
  struct Parameters : RunParameters
  {
    SweepParameters sweep;
    AtlasParameters atlas;
    TradeoffParameters tradeoff;

    void
    add_parameters(Declarations &declarations);
  };
} // namespace crawler
