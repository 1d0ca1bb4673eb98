// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/parabola.h>
#include <crawler/drivers/simulation.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// A stretch below this is lost: nothing that is computed from it has a digit left.
    constexpr double lost = 1e-12;

    double
    now()
    {
      return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    }
  } // namespace

  Simulation::Simulation(MPI_Comm communicator,
                         const Scene &scene,
                         const TimeParameters &time,
                         const Numerics &numerics)
    : scene_(scene)
    , numerics_(numerics)
    , discretization_(communicator, scene.body.length, numerics.n_cells, numerics.degree)
    , assembler_(scene, discretization_)
    , jacobian_(discretization_)
    , stepper_(communicator, discretization_.n_owned(), time)
    , u_(discretization_.n_owned())
    , v_(discretization_.n_owned())
  {
    using Vector               = TimeStepper::Vector;
    using ConstVector          = TimeStepper::ConstVector;
    stepper_.implicit_function = [this](const double t, const ConstVector u, const ConstVector v, const Vector F)
    {
      return assembler_.residual(t, u, v, F);
    };
    stepper_.setup_jacobian = [this](const double t, const ConstVector u, const ConstVector v, const double shift)
    {
      assembler_.jacobian(t, u, v, shift, jacobian_);
      return jacobian_.factorize();
    };
    stepper_.solve_with_jacobian = [this](const ConstVector b, const Vector x)
    {
      jacobian_.solve(b, x);
    };
    stepper_.jacobian_vmult = [this](const ConstVector x, const Vector y)
    {
      jacobian_.multiply(x, y);
    };
  }

  Simulation::~Simulation() = default;

  SimulationResult
  Simulation::run(const std::vector<double> &frames,
                  const Options &options,
                  const std::vector<std::unique_ptr<Observer>> &observers,
                  const std::function<bool()> &keep_going)
  {
    const double start    = now();
    result_               = {};
    quadrature_           = {};
    diagnosis_            = {};
    largest_              = {};
    previous_min_stretch_ = 1.;
    std::fill(u_.begin(), u_.end(), 0.);
    if (options.ledger)
      result_.ledger.emplace();
    const Ledger no_ledger;

    stepper_.monitor = [&](const Step &step, const std::span<const double> u)
    {
      const bool ok = examine(step, u, options, !observers.empty());
      if (!ok)
        return false; // an inverted state is not shown to anybody
      const double before = now();
      for (const auto &observer : observers)
        observer->observe({step,
                           step.number == 0 || step.is_frame,
                           u,
                           v_,
                           integrals_,
                           stretch_,
                           result_.ledger ? *result_.ledger : no_ledger});
      result_.output_seconds += now() - before;
      return !keep_going || keep_going();
    };
    result_.time     = stepper_.solve(u_, frames, numerics_.tolerance, numerics_.initial_step, numerics_.largest_step);
    stepper_.monitor = nullptr;

    if (!diagnosis_ && result_.time.status == "failed" && result_.time.domain_error)
    {
      // No state with positive stretch could be found, however small the step.
      const auto &bad = assembler_.bad_stretch();
      lost_stretch(bad ? bad->value : 0., bad ? bad->s : 0., result_.time.time, 1e-9 * scene_.end_time);
    }
    if (diagnosis_)
    {
      result_.time.status  = diagnosis_->status;
      result_.time.reason  = diagnosis_->reason;
      result_.time.message = diagnosis_->message;
    }
    else if (!options.ledger && observers.empty())
      result_.displacement = assembler_.integrals(result_.time.time, u_, v_).displacement / scene_.body.length;

    for (const auto &observer : observers)
      observer->end();
    result_.solve_seconds = now() - start - result_.output_seconds;
    return result_;
  }

  /// Looks at an accepted state; returns false if it must not be used.
  bool
  Simulation::examine(const Step &step,
                      const std::span<const double> u,
                      const Options &options,
                      const bool has_observers)
  {
    stretch_          = assembler_.stretch_range(u);
    const bool finite = std::isfinite(stretch_.min.value) && std::isfinite(stretch_.max.value);
    if (!finite)
    {
      diagnosis_ = {
        "failed",
        "nonfinite",
        fmt::format("the stretch at s = {:.6g}, t = {:.6g} is not a finite number", stretch_.min.s, step.time)};
      return false;
    }
    if (stretch_.min.value <= lost)
    {
      // The place is known; the time by linear interpolation within the step.
      const double w0 = previous_min_stretch_, w1 = stretch_.min.value;
      lost_stretch(w1, stretch_.min.s, step.time - step.size * w1 / (w1 - w0), step.size);
      return false;
    }
    previous_min_stretch_ = stretch_.min.value;
    const bool is_first   = step.number == 0;
    const StretchAt &low = stretch_.min, &high = stretch_.max;
    record({low.value, low.s, step.time}, 1., is_first, min_history_, result_.min_stretch);
    record({high.value, high.s, step.time}, -1., is_first, max_history_, result_.max_stretch);

    // Pictures need the velocity at frames only, the ledger always.
    const bool with_velocity = options.ledger || (has_observers && (step.is_frame || step.number == 0));
    if (with_velocity)
    {
      if (!assembler_.velocity(step.time, u, v_))
      {
        diagnosis_ = {
          "failed",
          "linear_failed",
          fmt::format("the velocity at t = {:.6g} cannot be computed: the friction matrix is singular", step.time)};
        return false;
      }
    }
    if (options.ledger || has_observers)
    {
      integrals_           = assembler_.integrals(step.time, u, v_);
      result_.displacement = integrals_.displacement / scene_.body.length;
      if (with_velocity && !std::isfinite(integrals_.dissipation))
      {
        diagnosis_ = {
          "failed",
          "nonfinite",
          fmt::format("the velocity at t = {:.6g} is not a finite number; the smallest stretch is {:.3g} at "
                      "s = {:.6g}",
                      step.time,
                      stretch_.min.value,
                      stretch_.min.s)};
        return false;
      }
    }
    if (options.ledger)
    {
      Ledger &ledger                        = *result_.ledger;
      const RateQuadrature::Rates rates     = {{integrals_.stress_power,
                                                integrals_.dissipation,
                                                integrals_.positive_power,
                                                integrals_.absolute_power,
                                                assembler_.end_power(step.time, v_)}};
      const RateQuadrature::Rates increment = quadrature_.advance(step.time, rates);
      ledger.stress_power += increment[0];
      ledger.dissipation += increment[1];
      ledger.positive_power += increment[2];
      ledger.exchanged += increment[3];
      ledger.end_work += increment[4];
      ledger.elastic_energy = integrals_.elastic_energy;
      if (integrals_.abs_friction > 0.)
        result_.net_friction =
          std::max(result_.net_friction, std::abs(integrals_.net_friction) / integrals_.abs_friction);
    }
    if (options.resolution)
    {
      const Resolution resolution = assembler_.resolution(u);
      largest_.highest_mode       = std::max(largest_.highest_mode, resolution.highest_mode);
      largest_.strain             = std::max(largest_.strain, resolution.strain);
      result_.unresolved          = largest_.strain > 0. ? largest_.highest_mode / largest_.strain : 0.;
      result_.largest_u           = std::max(result_.largest_u, assembler_.root_mean_square(u));
    }
    return true;
  }

  /// Keeps the smallest value (times sign) so far. Between steps the parabola through three of them comes closer.
  void
  Simulation::record(const SimulationResult::Extreme &now,
                     const double sign,
                     const bool is_first,
                     History &history,
                     SimulationResult::Extreme &extreme)
  {
    if (is_first)
    {
      history.fill(now);
      extreme = now;
      return;
    }
    history = {{history[1], history[2], now}};
    if (sign * now.value < sign * extreme.value)
      extreme = now;
    const auto &[before, middle, after] = history;
    if (before.t < middle.t && sign * middle.value < sign * before.value && sign * middle.value < sign * after.value)
    {
      const auto [t, value] = parabola_vertex(before.t, before.value, middle.t, middle.value, after.t, after.value);
      if (sign * value < sign * extreme.value && value > 0.)
        extreme = {value, middle.s, t};
    }
  }

  /**
   * For a <= -1 the stretch inside stays positive as long as the ends do (doc/theory.md, "When a body can invert"), so
   * a loss of stretch that is not that of an end, 1 - m/k <= 0, is an error of the mesh and is called that.
   */
  void
  Simulation::lost_stretch(const double value, double s, const double t, const double reach)
  {
    const double k = scene_.body.elastic_modulus, length = scene_.body.length;
    // The stretch that the end conditions prescribe, m + k (w - 1) = 0, at t and a little later.
    const auto [left, right]             = assembler_.end_stress(t);
    const auto [left_later, right_later] = assembler_.end_stress(t + reach);
    const double left_stretch            = 1. - std::max(left, left_later) / k,
                 right_stretch           = 1. - std::max(right, right_later) / k;
    const bool at_end                    = left_stretch <= 0. || right_stretch <= 0.;
    if (!at_end && scene_.body.friction_exponent() <= -1.)
    {
      diagnosis_ = {
        "failed",
        "under_resolved",
        fmt::format("the computed stretch reached {:.3g} at s = {:.6g}, t = {:.6g}, where the body itself stays "
                    "uninverted (a <= -1): {} cells of degree {} are too coarse; a larger "
                    "Discretization/Number of cells is needed",
                    value,
                    s,
                    t,
                    numerics_.n_cells,
                    numerics_.degree)};
      return;
    }
    if (at_end)
      s = left_stretch <= right_stretch ? 0. : length;
    result_.inversion = SimulationResult::Extreme{value, s, t};
    diagnosis_        = {
             "inverted",
      at_end ? "inverted_at_end" : "inverted_inside",
             fmt::format("the body inverted: its stretch reached 0 at s = {:.6g}, t = {:.6g}{}; the model ends there",
                  s,
                  t,
                  at_end ? " (at this end 1 - m/k is not positive)" : "")};
  }
} // namespace crawler
