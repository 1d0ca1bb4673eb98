// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/base/extreme_history.h>
#include <crawler/equation/stretch_form.h>
#include <crawler/reduced_models/model.h>
#include <crawler/run/cycle_stop.h>
#include <crawler/run/displacement_error.h>
#include <crawler/run/gait.h>
#include <crawler/run/number_errors.h>
#include <crawler/time/stepper.h>

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /// The derivative of the displacement by an entry of the parameter file.
  struct EntrySensitivity
  {
    std::string entry;
    double at;                          ///< value of the entry
    std::optional<double> value, error; ///< and its bound [length/unit of the entry]; nothing if it is not known
    std::string reason;                 ///< why it is not known

    /// Of another number, by its key in the result table.
    struct OfNumber
    {
      std::string key;
      double value, error; ///< [its unit/unit of the entry]
    };
    std::vector<OfNumber> others = {};   ///< those that are known
    bool may_vary                = true; ///< from where it is
    double standard_deviation    = 0.;   ///< of the entry, if it is uncertain

    /// Of a number by its key, the displacement too.
    std::optional<OfNumber>
    of(const std::string &key) const;

    /// By how many per cent the displacement grows if the entry grows by one.
    double
    elasticity(const double displacement) const
    {
      return *value * at / displacement;
    }
  };

  /// What one simulation gives.
  struct SimulationResult
  {
    TimeOutcome time; ///< its status is "inverted" too
    Model model = Model::nonlinear;

    /// Of the centre of mass, (1/L) int u ds [length]; not a number if it was not looked at before the run broke off.
    double displacement = std::numeric_limits<double>::quiet_NaN();
    /// How: an integrator of time/integrators.h; petsc, fused, or "fused, petsc" where the fused engine gave up.
    std::string integrator, engine;
    std::optional<DisplacementError> error; ///< of the displacement
    /// The displacement corrected by its errors in space and time, and a bound of its own error [length].
    struct Corrected
    {
      double value, error;
    };
    std::optional<Corrected> corrected;          ///< if the adjoint gave it
    std::optional<NumberErrors> errors;          ///< of other numbers, if a finer run measured them
    std::vector<EntrySensitivity> sensitivities; ///< if they are wanted, those that matter most first

    /// The standard deviation of the number under a key of the result table that uncertain entries make, to first
    /// order; nothing if there are none, or if a derivative is not known.
    std::optional<double>
    standard_deviation(const std::string &key) const;
    double largest_u  = 0.; ///< root mean square of u over the body, largest over time [length]
    double unresolved = 0.; ///< Resolution: largest highest_mode over largest strain, if looked at
    double strain     = 0.; ///< largest int (w - 1)^2 ds over time, if the resolution is looked at [length]
    std::optional<EnergyBalance> energy_balance;
    /// The residual of an energy balance that is not kept, since works that do not balance are not known [1].
    std::optional<double> residual_of_unknown_works;
    bool jumps_move     = false; ///< the energy balance's integrals in time are not those of a smooth active stress
    double net_friction = 0.;    ///< largest |int g v ds| over largest int |g v| ds, both over time [1]

    using Extreme = crawler::Extreme;
    Extreme min_stretch, max_stretch;
    std::optional<Extreme> inversion; ///< where and when the body inverted; value is the stretch there
    /// What is lost together with it: in the stretch form, from the first to the last of these places [length].
    std::optional<std::pair<double, double>> inverted_places;
    std::optional<double> inversion_error; ///< of the time when it inverted, where that was measured [time]

    std::optional<Gait> gait;              ///< the last stride, if that is looked at and there is one
    std::optional<double> gait_efficiency; ///< of the whole run (gait.h), if it is known [1]
    std::optional<Cycles> cycles;          ///< if the run ended because they repeat; all above is that of the end time

    Formulation formulation   = Formulation::position;
    unsigned int mesh_changes = 0, most_cells = 0; ///< of an adaptive mesh
    /// The last mesh; nothing if there was none.
    struct Mesh
    {
      unsigned int n_cells, degree;
      std::size_t n_unknowns;
      bool is_shared; ///< by several ranks

      void
      exchange(auto &archive)
      {
        archive(n_cells, degree, n_unknowns, is_shared);
      }
    };
    std::optional<Mesh> mesh;
    double largest_indicator = 0.; ///< largest sum of the error indicators of an accepted state [length]
    double setup_seconds = 0., solve_seconds = 0., output_seconds = 0.;
    double estimate_seconds  = 0.; ///< that the error took (error_estimate.h)
    unsigned int refinements = 0;  ///< tries before this one, whose errors were too large

    /// All of it but sensitivities, which no run has.
    void
    exchange(Archive &archive);
  };
} // namespace crawler
