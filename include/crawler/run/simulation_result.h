// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/base/extreme_history.h>
#include <crawler/equation/position_form.h>
#include <crawler/reduced_models/model.h>
#include <crawler/run/cycle_stop.h>
#include <crawler/run/gait.h>
#include <crawler/time/stepper.h>

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /// Estimated error of a displacement and its parts; not a number where unknown [length].
  struct DisplacementError
  {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    double total = unknown; ///< sum of the parts
    double space = unknown; ///< part of the mesh
    double time  = unknown; ///< part of the time steps, and of cycles that were extrapolated
    double model = unknown; ///< part of the model level; 0 if the full equation was solved
  };

  /// Size and resolution of a solution, largest over time, for the choice of the numerics (ResolutionWish).
  struct SolutionSize : Resolution
  {
    double largest_u         = 0.; ///< root mean square of u over the body [length]
    double last_u            = 0.; ///< the same of the last state [length]
    double largest_indicator = 0.; ///< sum of the error indicators of an accepted state [length]

    /// Part of the strain that the mesh does not resolve.
    double
    unresolved() const
    {
      return strain > 0. ? highest_mode / strain : 0.;
    }
  };

  /// Place and time at which the body inverted; value is the stretch there.
  struct Inversion : Extreme
  {
    /// Region of the stretch form that is lost at once, from the first to the last of these places [length].
    std::optional<std::pair<double, double>> places = {};
    std::optional<double> error                     = {}; ///< error of the time, where it was measured [time]

    void
    exchange(auto &archive)
    {
      archive(static_cast<Extreme &>(*this), places, error);
    }
  };

  /// Derivative of the displacement by an entry of the parameter file.
  struct EntrySensitivity
  {
    std::string entry;
    double at;                          ///< value of the entry
    std::optional<double> value, error; ///< derivative and its bound [length/unit of the entry]; nothing if unknown
    std::string reason;                 ///< reason why it is not known

    /// Derivative of another number, by its key in the result table.
    struct OfNumber
    {
      std::string key;
      double value, error; ///< [its unit/unit of the entry]
    };
    std::vector<OfNumber> others = {};   ///< derivatives that are known
    bool may_vary                = true; ///< true if the entry may be varied from its value
    double standard_deviation    = 0.;   ///< standard deviation of the entry, if it is uncertain

    /// Derivative of a number by its key, the displacement included.
    std::optional<OfNumber>
    of(const std::string &key) const;

    /// Growth of the displacement in per cent if the entry grows by one per cent.
    double
    elasticity(const double displacement) const
    {
      return *value * at / displacement;
    }
  };

  /// Way in which a result was computed.
  struct ResultProcess
  {
    Model model             = Model::nonlinear;
    Formulation formulation = Formulation::position;
    /// Integrator of time/integrators.h; engine: petsc, fused, or "fused, petsc" where the fused engine gave up.
    std::string integrator, engine;
    /// Last mesh, without cells if there was none; changes and most_cells count those of an adaptive one.
    struct Mesh
    {
      unsigned int n_cells = 0, degree = 0;
      std::size_t n_unknowns = 0;
      bool is_shared         = false; ///< true if several ranks share it
      unsigned int changes = 0, most_cells = 0;

      void
      exchange(auto &archive)
      {
        archive(n_cells, degree, n_unknowns, is_shared, changes, most_cells);
      }
    };
    Mesh mesh;
    bool jumps_move          = false; ///< true if the active stress is not smooth in time for the energy balance
    unsigned int refinements = 0;     ///< tries before this one, whose errors were too large
    /// Wall times; error: spent on the error (error_estimate.h).
    struct Seconds
    {
      double setup = 0., solve = 0., output = 0., error = 0.;
    };
    Seconds seconds;

    void
    exchange(auto &archive)
    {
      archive(model, formulation, integrator, engine, mesh, jumps_move, refinements, seconds);
    }
  };

  /// Result of one simulation.
  struct SimulationResult
  {
    TimeOutcome time; ///< status may also be "inverted"
    ResultProcess process;

    /// Displacement of the centre of mass, (1/L) int u ds [length]; not a number if it was not computed before the run
    /// broke off.
    double displacement = std::numeric_limits<double>::quiet_NaN();
    std::optional<DisplacementError> error; ///< error of the displacement
    /// Displacement corrected by its errors in space and time, and a bound of its own error [length].
    struct Corrected
    {
      double value, error;
    };
    std::optional<Corrected> corrected; ///< if the adjoint gave it
    /// Error bounds of the other numbers, in the order of entries_with_errors() (result_table.h); not a number where
    /// unknown, empty if no finer run measured them.
    std::vector<double> errors;
    std::vector<EntrySensitivity> sensitivities; ///< sensitivities, on request, the most important first

    /// Standard deviation of the number under a key of the result table that uncertain entries cause, to first order;
    /// nothing if there are none, or if a derivative is not known.
    std::optional<double>
    standard_deviation(const std::string &key) const;
    SolutionSize size;
    std::optional<EnergyBalance> energy_balance;
    struct Residuals
    {
      /// Energy residual of a balance that is discarded, since works that do not balance are not known [1].
      std::optional<double> unknown_works;
      double net_friction = 0.; ///< largest |int g v ds| over largest int |g v| ds, both over time [1]

      void
      exchange(auto &archive)
      {
        archive(unknown_works, net_friction);
      }
    };
    Residuals residuals;

    struct Stretch
    {
      Extreme min, max; ///< over body and time
    };
    Stretch stretch;
    std::optional<Inversion> inversion; ///< if the body inverted

    std::optional<Gait> gait;              ///< last stride, on request and if there is one
    std::optional<double> gait_efficiency; ///< efficiency of the whole run (gait.h), if it is known [1]
    std::optional<Cycles> cycles;          ///< set if the run ended as they repeat; numbers above are at the end time

    /// Exchanges everything but sensitivities, which no run has.
    void
    exchange(Archive &archive);
  };
} // namespace crawler
