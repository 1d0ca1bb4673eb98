// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>
#include <crawler/scene/active_stress/expression.h>
#include <crawler/scene/active_stress/optimal_wave.h>
#include <crawler/scene/active_stress/prescribed_strain.h>
#include <crawler/scene/active_stress/pulse.h>
#include <crawler/scene/active_stress/standing_wave.h>
#include <crawler/scene/active_stress/strain_feedback.h>
#include <crawler/scene/active_stress/table.h>
#include <crawler/scene/active_stress/travelling_wave.h>

namespace crawler
{
  /// Section "Active stress": the generator's name, and the section of each generator.
  struct ActiveStressParameters
  {
    std::string generator = "optimal wave";
    OptimalWaveParameters optimal_wave;
    TravellingWaveParameters travelling_wave;
    StandingWaveParameters standing_wave;
    PulseParameters pulse;
    ExpressionParameters expression;
    PrescribedStrainParameters prescribed_strain;
    StrainFeedbackParameters strain_feedback;
    TableParameters table;

    void
    add_parameters(Declarations &declarations);
  };

  /// The generator that the parameters name. Throws InputError if its own parameters do not make sense.
  std::unique_ptr<ActiveStress>
  create_active_stress(const ActiveStressParameters &parameters, const Body &body, double end_time);
} // namespace crawler
