// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/position_form.h>
#include <crawler/time/radau_tableau.h>
#include <crawler/time/time_integration.h>

#include <list>

namespace crawler
{
  /**
   * The level "linear": the equation at a = 0 (friction does not depend on the stretch) in the position form,
   *
   *   F(t, u, u') = M u' + K u + f(t) = 0,   with constant M and K,
   *
   * by the Radau IIA methods (radau_loops.h). The stages are solved exactly, by one real and (s-1)/2 complex
   * block-tridiagonal eliminations: no Newton iteration. The time to the next output time is divided into equal steps,
   * and again when the error asks for other ones; each size needs one factorization. Error control as in time/radau.h.
   */
  class LinearStepper : public TimeIntegration
  {
  public:
    /// @p form must be that of a plain scene with a = 0 in natural units, and outlive the stepper. Without @p adaptive
    /// all steps have one size, the initial one or the next smaller that fits.
    LinearStepper(PositionForm &form, unsigned int n_stages, bool adaptive);

    /// The end time is 1.
    TimeOutcome
    solve(std::vector<double> &y,
          const std::vector<double> &output_times,
          double tolerance,
          double initial_step,
          std::span<const StepLimit> limits,
          double start_time) override;
    void
    interpolate(double time, Vector y) override;
    bool
    exchange(Archive &archive) override;

    /// How often the systems of a step size have been factorized so far.
    unsigned int
    n_factorizations() const
    {
      return n_factorizations_;
    }

  private:
    /// The systems K + (lambda/h) M of a step size h.
    struct Factors
    {
      double h;
      BlockTridiagonalMatrix<double> real;
      std::vector<BlockTridiagonalMatrix<std::complex<double>>> complex;
    };

    /// Equal steps on the way to the next output time.
    struct Plan
    {
      double next        = 0.; ///< size that is wanted
      double h           = 0.; ///< size of the steps
      unsigned long left = 0;  ///< of them; 0: to be planned
      unsigned int limit = 0;  ///< present one of the step limits
    };

    template <typename Number>
    void
    fill(BlockTridiagonalMatrix<Number> &matrix, Number of_mass) const;
    const Factors &
    factors(double h);
    void
    plan_steps(Plan &plan, double t, double end, std::span<const StepLimit> limits) const;
    bool
    make_step(double t, double h, ConstVector y);
    double
    error_of_step(double t, double h, ConstVector y);
    void
    plan_next_step(Plan &plan, double factor) const;
    double
    mean(ConstVector x) const;
    double
    root_mean_square(ConstVector x) const;
    void
    show_rates();

    PositionForm &form_;
    const RadauTableau &tableau_;
    const bool adaptive_;
    BlockTridiagonalMatrix<double> mass_, stiffness_;
    std::vector<double> row_sums_; ///< M 1
    std::list<Factors> factors_;   ///< latest first
    unsigned int n_factorizations_ = 0;

    unsigned int steps_ = 0, rejected_ = 0;
    double tolerance_ = 0., time_ = 0.;
    Plan plan_;
    bool goes_on_ = false;
    // The step that was made last.
    double end_ = 0., size_ = 0.;
    std::vector<double> start_, z_; ///< [unknowns], [stages][unknowns] increments
    std::vector<double> right_, work_, rate_, error_;
    std::vector<std::complex<double>> complex_work_;
  };
} // namespace crawler
