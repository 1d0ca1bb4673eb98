// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>
#include <crawler/scene/active_stress/expression.h>
#include <crawler/scene/active_stress/library.h>
#include <crawler/scene/active_stress/modes.h>
#include <crawler/scene/active_stress/optimal_wave.h>
#include <crawler/scene/active_stress/prescribed_strain.h>
#include <crawler/scene/active_stress/pulse.h>
#include <crawler/scene/active_stress/segments.h>
#include <crawler/scene/active_stress/strain_feedback.h>
#include <crawler/scene/active_stress/sum.h>
#include <crawler/scene/active_stress/table.h>
#include <crawler/scene/active_stress/two_level_wave.h>
#include <crawler/scene/active_stress/waves.h>

namespace crawler
{
  struct Scene;
  struct TermParameters;

  /// Section "Active stress/Sum": a subsection for each term, "Term 1", "Term 2", ..., as many as the file has
  /// (Parameters::count_terms).
  struct SumParameters
  {
    std::vector<TermParameters> terms;

    void
    add_parameters(Declarations &declarations);
  };

  /// Section "Active stress": the generator's name, and the section of each generator.
  struct ActiveStressParameters
  {
    std::string generator = "optimal wave";
    OptimalWaveParameters optimal_wave;
    TravellingWaveParameters travelling_wave;
    StandingWaveParameters standing_wave;
    PulseParameters pulse;
    SegmentsParameters segments;
    ExpressionParameters expression;
    PrescribedStrainParameters prescribed_strain;
    TwoLevelWaveParameters two_level_wave;
    LibraryParameters library;
    StrainFeedbackParameters strain_feedback;
    TableParameters table;
    ModesParameters modes;
    SumParameters sum;

    void
    add_parameters(Declarations &declarations);

    /// Declares all generators but the sum in the present section: also for a term of a sum.
    void
    add_generators(Declarations &declarations, bool is_term);
  };

  /// Section "Active stress/Sum/Term N": a section "Active stress" without the sum, and how the term is combined.
  struct TermParameters
  {
    SumTermParameters combination;
    ActiveStressParameters stress;

    void
    add_parameters(Declarations &declarations);
  };

  /// Names of all generators. The section of each has the same name, with a capital letter.
  std::vector<std::string>
  generator_names();

  /// Creates the generator that the parameters name, for the body, the ground and the duration of @p scene, which has
  /// no active stress yet. Throws InputError if the generator's parameters do not make sense.
  std::unique_ptr<ActiveStress>
  create_active_stress(const ActiveStressParameters &parameters, const Scene &scene);
} // namespace crawler
