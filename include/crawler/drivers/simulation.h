// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/assembler.h>
#include <crawler/observers/observer.h>
#include <crawler/time/time_stepper.h>

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// The numerical settings of one simulation; numerics_choice.h chooses those that the user leaves open.
  struct Numerics
  {
    unsigned int degree  = 0;
    unsigned int n_cells = 0;
    double tolerance     = 0.;                                      ///< [length]
    double initial_step  = 0.;                                      ///< [time]
    double largest_step  = std::numeric_limits<double>::infinity(); ///< [time]
  };

  /// What one simulation gives.
  struct SimulationResult
  {
    TimeOutcome time; ///< its status is "inverted" too

    /// Of the centre of mass, (1/L) int u ds [length]; not a number if nobody looked before the run broke off.
    double displacement = std::numeric_limits<double>::quiet_NaN();
    double largest_u    = 0.; ///< root mean square of u over the body, largest over time [length]
    double unresolved   = 0.; ///< Resolution: largest highest_mode over largest strain, if looked at
    std::optional<Ledger> ledger;
    double net_friction = 0.; ///< largest |int g v ds|/int |g v| ds over time [1]

    struct Extreme
    {
      double value = 1., s = 0., t = 0.;
    };
    Extreme min_stretch, max_stretch;
    std::optional<Extreme> inversion; ///< where and when the body inverted; value is the stretch there
    double setup_seconds = 0., solve_seconds = 0., output_seconds = 0.;
  };

  /**
   * One crawler: builds mesh, equation and time stepper in this order and connects them. It can run several times;
   * that reuses everything.
   */
  class Simulation
  {
  public:
    /// What is computed at each accepted step besides the state.
    struct Options
    {
      bool ledger     = false; ///< works, energies, net friction
      bool resolution = false; ///< SimulationResult::unresolved
    };

    Simulation(MPI_Comm communicator, const Scene &scene, const TimeParameters &time, const Numerics &numerics);
    ~Simulation();

    /// Runs from rest. @p frames are times in (0, T] where steps must end. @p keep_going is asked after every step.
    SimulationResult
    run(const std::vector<double> &frames,
        const Options &options,
        const std::vector<std::unique_ptr<Observer>> &observers = {},
        const std::function<bool()> &keep_going                 = {});

    const Discretization &
    discretization() const
    {
      return discretization_;
    }
    Assembler &
    assembler()
    {
      return assembler_;
    }

  private:
    bool
    examine(const Step &step, std::span<const double> u, const Options &options, bool has_observers);
    void
    diagnose_domain_error();
    void
    lost_stretch(double value, double s, double t, double reach);

    const Scene &scene_;
    const Numerics numerics_;
    const Discretization discretization_;
    Assembler assembler_;
    ChainMatrix jacobian_;
    TimeStepper stepper_;
    double setup_seconds_ = 0.;

    // The state of one run().
    /// The last three extremes of one kind, newest last, to sharpen those between steps.
    using History = std::array<SimulationResult::Extreme, 3>;
    static void
    record(const SimulationResult::Extreme &now,
           double sign,
           bool is_first,
           History &history,
           SimulationResult::Extreme &extreme);

    struct Diagnosis
    {
      std::string status, reason, message;
    };
    SimulationResult result_;
    std::optional<Diagnosis> diagnosis_; ///< replaces what the time stepper says
    RateQuadrature quadrature_;
    Resolution largest_{}; ///< over time, if looked at
    CellIntegrals integrals_;
    StretchRange stretch_;
    History min_history_, max_history_;
    double previous_min_stretch_ = 1.;
    std::vector<double> u_, v_;
  };
} // namespace crawler
