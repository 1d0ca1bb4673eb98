// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/mesh/block_tridiagonal_matrix.h>
#include <crawler/scene/scene.h>
#include <crawler/time/radau_tableau.h>
#include <crawler/time/time_integration.h>

#include <list>
#include <memory>

namespace crawler
{
  /**
   * The level "linear": the equation at a = 0 (friction does not depend on the stretch) in the position form,
   *
   *   M u' + K u + f(t) = 0,   M_ij = int gamma phi_j phi_i,   K_ij = int k phi_j,s phi_i,s,   f_i = int m phi_i,s,
   *
   * by the Radau IIA methods (radau_tableau.h). The stages are solved exactly, by one real and (s-1)/2 complex
   * block-tridiagonal eliminations: no Newton iteration. The time to the next output time is divided into equal steps,
   * and again when the error asks for other ones; each size needs one factorization. Error control as in time/radau.h.
   */
  class LinearStepper : public TimeIntegration
  {
  public:
    /// @p scene must have a = 0, be in natural units and, like the mesh, outlive the stepper. Without @p adaptive all
    /// steps have one size, the initial one or the next smaller that fits.
    LinearStepper(const Scene &scene, const Discretization &discretization, unsigned int n_stages, bool adaptive);

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

    template <typename Number>
    void
    fill(BlockTridiagonalMatrix<Number> &matrix, Number of_mass, double of_stiffness) const;
    const Factors &
    factors(double h);
    void
    load(double t, Vector f);
    bool
    make_step(double t, double h, ConstVector y);
    double
    error_of_step(double t, double h, ConstVector y);
    double
    mean(ConstVector x) const;
    double
    root_mean_square(ConstVector x) const;
    void
    show_rates();

    const Discretization &discretization_;
    const double k_;
    const RadauTableau &tableau_;
    const bool adaptive_;
    const std::unique_ptr<ActiveStressAtPoints> stress_;
    BlockTridiagonalMatrix<double> mass_, stiffness_;
    std::vector<double> row_sums_; ///< M 1
    std::list<Factors> factors_;   ///< latest first
    unsigned int n_factorizations_ = 0;

    unsigned int steps_ = 0;
    double tolerance_   = 0.;
    // The step that was made last.
    double end_ = 0., size_ = 0.;
    std::vector<double> start_, z_; ///< [unknowns], [stages][unknowns] increments
    std::vector<double> m_, local_, f_, f_start_, f_end_, stiff_, right_, work_, rate_, error_;
    double f_time_ = -1.; ///< that f_start_ is known for
    std::vector<std::complex<double>> complex_work_;
  };
} // namespace crawler
