// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/form_choice.h>
#include <crawler/equation/stretch_form.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    // Constants measured by tests/benchmark/stretch_table.cc; doc/numerics.md, "Stretch form".
    /// Limits at low accuracy, the Accuracy below which they fall, and the powers by which they do.
    constexpr double softest = 1e-3, emptied = 0.06, emptied_if_it_inverts = 3e-3, moderate = 1e-5;
    constexpr double softness_power = 0.5, stretch_power = 0.35;
    /// Limits beyond which many cells of the position form are cheaper.
    constexpr double max_lengths = 30., min_accuracy = 1e-7;

    double
    falling(const double limit, const double accuracy, const double power)
    {
      return limit * std::pow(std::min(1., accuracy / moderate), power);
    }
  } // namespace

  bool
  may_be_stretch_form(const RunParameters &parameters, const Scene &scene)
  {
    const DiscretizationParameters &own = parameters.discretization;
    const TimeParameters &time          = parameters.time;
    // Meshes of the stretch form are as fine as the displacement requires.
    return !scene.keeps_its_centre() && own.formulation == FormulationEntry::automatic &&
           own.mesh == MeshKind::automatic && !own.degree && !own.n_cells && !time.tolerance &&
           time.step_control == StepControl::adaptive && time.engine == Engine::automatic &&
           (time.integrator == "automatic" || time.integrator.starts_with("radau")) &&
           reason_against_stretch_form(scene).empty();
  }

  bool
  is_soft(const double stiffness, const double exponent, const double accuracy)
  {
    return stiffness < falling(softest, accuracy, softness_power) * std::max(1., exponent * exponent);
  }

  bool
  is_cheaper_than_many_cells(const double lengths, const double accuracy)
  {
    return lengths < max_lengths && accuracy >= min_accuracy;
  }

  bool
  empties(const double smallest_stretch, const double exponent, const double accuracy)
  {
    if (exponent >= 0.) // contracted regions then slide easily
      return false;
    return smallest_stretch < falling(exponent > -1. ? emptied_if_it_inverts : emptied, accuracy, stretch_power);
  }
} // namespace crawler
