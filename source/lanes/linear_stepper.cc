// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/lanes/linear_stepper.h>
#include <crawler/time/radau_loops.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// There is no Newton's method that a long step could hurt.
    constexpr double most_growth = 10.;
    /// Steps are not made longer for less than this: a new size must be factorized.
    constexpr double least_growth = 1.5;
    constexpr double least_step   = 1e-14;
    /// So many step sizes are kept.
    constexpr std::size_t most_factors = 24;
    /// Step sizes are the same if they differ by less than this part.
    constexpr double same_size = 1e-9;
  } // namespace

  LinearStepper::LinearStepper(const Scene &scene,
                               const Discretization &discretization,
                               const unsigned int n_stages,
                               const bool adaptive)
    : discretization_(discretization)
    , k_(scene.body.elastic_modulus)
    , tableau_(radau_tableau(n_stages))
    , adaptive_(adaptive)
    , stress_(scene.active_stress->at(discretization.points(discretization.element().points)))
    , mass_(discretization)
    , stiffness_(discretization)
    , m_(static_cast<std::size_t>(discretization.n_local_cells()) * discretization.element().n)
  {
    for (unsigned int i = 0; i < n_stages; ++i)
      quadrature_.push_back({tableau_.c[i], tableau_.b[i]});
    fill(mass_, 1., 0.);
    fill(stiffness_, 0., 1.);
    for (auto *vector : {&f_, &f_start_, &f_end_, &stiff_, &work_, &rate_, &error_, &start_})
      vector->resize(discretization.n_owned());
    row_sums_.resize(discretization.n_owned());
    mass_.multiply(std::vector<double>(discretization.n_owned(), 1.), row_sums_);
    for (auto *vector : {&right_, &z_})
      vector->resize(n_stages * discretization.n_owned());
  }

  /// The blocks of of_mass M + of_stiffness K; gamma = 1 in natural units.
  template <typename Number>
  void
  LinearStepper::fill(BlockTridiagonalMatrix<Number> &matrix, const Number of_mass, const double of_stiffness) const
  {
    const ReferenceElement &e = discretization_.element();
    const auto &sizes         = discretization_.cell_size();
    Number *block             = matrix.blocks().data();
    for (std::size_t c = 0; c < sizes.size(); ++c, block += e.n * e.n)
      for (unsigned int i = 0; i < e.n; ++i)
        for (unsigned int j = 0; j < e.n; ++j)
        {
          double mass = 0.;
          for (unsigned int p = 0; p < e.n; ++p)
            mass += e.weights[p] * e.values[p * e.n + i] * e.values[p * e.n + j];
          block[i * e.n + j] = of_mass * (sizes[c] * mass) + of_stiffness * k_ / sizes[c] * e.stiffness[i * e.n + j];
        }
  }

  const LinearStepper::Factors &
  LinearStepper::factors(const double h)
  {
    for (auto known = factors_.begin(); known != factors_.end(); ++known)
      if (std::abs(known->h - h) <= same_size * h)
      {
        factors_.splice(factors_.begin(), factors_, known);
        return factors_.front();
      }
    if (factors_.size() == most_factors)
      factors_.pop_back();
    factors_.push_front({h, BlockTridiagonalMatrix<double>(discretization_), {}});
    Factors &made = factors_.front();
    // Both matrices are positive (semi)definite and the shifts are in the right half plane: no pivot vanishes.
    fill(made.real, tableau_.real_eigenvalue / h, 1.);
    bool ok = made.real.factorize();
    for (const auto lambda : tableau_.eigenvalues)
    {
      made.complex.emplace_back(discretization_);
      fill(made.complex.back(), lambda / h, 1.);
      ok = made.complex.back().factorize() && ok;
    }
    if (!ok)
      throw std::logic_error("a system of the linear model is singular");
    ++n_factorizations_;
    return made;
  }

  /// f_i = int m phi_i,s
  void
  LinearStepper::load(const double t, const Vector f)
  {
    const ReferenceElement &e = discretization_.element();
    stress_->values(t, m_);
    local_.assign(discretization_.n_local(), 0.);
    for (unsigned int c = 0; c < discretization_.n_local_cells(); ++c)
      for (unsigned int p = 0; p < e.n; ++p)
      {
        const double m = e.weights[p] * m_[c * e.n + p];
        for (unsigned int i = 0; i < e.n; ++i)
          local_[c * e.degree + i] += m * e.derivatives[p * e.n + i];
      }
    discretization_.add_to_owned<double>(local_, f);
  }

  /**
   * The increments z_i = u(t + c_i h) - u(t), from  M sum_j (A^-1)_ij z_j/h + K (u + z_i) + f(t + c_i h) = 0. In the
   * basis of the eigenvectors of A^-1 the stages do not depend on each other (Hairer and Wanner, section IV.8). Returns
   * false if the result is not finite.
   */
  bool
  LinearStepper::make_step(const double t, const double h, const ConstVector y)
  {
    const std::size_t size = y.size();
    const unsigned int n   = tableau_.n;
    const Factors &systems = factors(h);
    std::copy(y.begin(), y.end(), start_.begin());
    stiffness_.multiply(y, stiff_);
    for (unsigned int i = 0; i < n; ++i)
    {
      const Vector right(right_.data() + i * size, size);
      load(t + tableau_.c[i] * h, right);
      if (i + 1 == n)
        std::copy(right.begin(), right.end(), f_end_.begin());
      for (std::size_t d = 0; d < size; ++d)
        right[d] = -right[d] - stiff_[d];
    }

    const int s = static_cast<int>(n), unknowns = static_cast<int>(size);
    complex_work_.resize(tableau_.n_pairs() * size);
    radau::to_eigenbasis(s, parts(tableau_.rows), right_.data(), unknowns, work_.data(), complex_work_.data());
    systems.real.solve(work_, work_);
    for (unsigned int p = 0; p < tableau_.n_pairs(); ++p)
    {
      const std::span<std::complex<double>> own(complex_work_.data() + p * size, size);
      systems.complex[p].solve(own, own);
    }
    for (int i = 0; i < s; ++i)
      for (int d = 0; d < unknowns; ++d)
        z_[static_cast<std::size_t>(i * unknowns + d)] =
          radau::from_eigenbasis(s, parts(tableau_.vectors), i, d, unknowns, work_.data(), complex_work_.data());
    // The centre of mass stays where it is, the sum of all equations says; so it does to round-off of one step.
    for (unsigned int i = 0; i < n; ++i)
    {
      const double displacement = mean({z_.data() + i * size, size});
      for (std::size_t d = 0; d < size; ++d)
        z_[i * size + d] -= displacement;
    }
    end_  = t + h;
    size_ = h;
    return std::isfinite(root_mean_square({z_.data() + (n - 1) * size, size}));
  }

  /// (K + sigma M)^-1 ( -F(t, y, -sigma e.z) ), the error of the embedded formula, in units of the tolerance
  /// (time/radau.cc).
  double
  LinearStepper::error_of_step(const double t, const double h, const ConstVector y)
  {
    radau::error_rate(static_cast<int>(tableau_.n),
                      tableau_.error_weights.data(),
                      tableau_.real_eigenvalue,
                      1. / h,
                      z_.data(),
                      static_cast<int>(y.size()),
                      rate_.data());
    if (t != f_time_) // else it is known from the step before
      load(t, f_start_);
    f_time_ = t;
    mass_.multiply(rate_, work_);
    for (std::size_t d = 0; d < y.size(); ++d)
      f_[d] = f_start_[d] + work_[d];
    double error = 0.;
    for (unsigned int round = 0; round < (steps_ < radau::settling_steps ? 2 : 1); ++round)
    {
      for (std::size_t d = 0; d < y.size(); ++d)
        work_[d] = y[d] + (round > 0 ? error_[d] : 0.);
      stiffness_.multiply(work_, stiff_);
      for (std::size_t d = 0; d < y.size(); ++d)
        work_[d] = -stiff_[d] - f_[d];
      factors(h).real.solve(work_, error_);
      error = root_mean_square(error_) / tolerance_;
      if (round > 0) // filtered twice: the step must not grow
        error = std::max(error, radau::error_without_growth(static_cast<int>(tableau_.n)));
      if (error < 1.)
        break;
    }
    return error;
  }

  /// int x ds
  double
  LinearStepper::mean(const ConstVector x) const
  {
    double sum = 0.;
    for (std::size_t d = 0; d < x.size(); ++d)
      sum += row_sums_[d] * x[d];
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, discretization_.communicator());
    return sum;
  }

  double
  LinearStepper::root_mean_square(const ConstVector x) const
  {
    double sum = 0.;
    for (const double value : x)
      sum += value * value;
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, discretization_.communicator());
    return std::sqrt(sum / static_cast<double>(discretization_.n_unknowns()));
  }

  TimeOutcome
  LinearStepper::solve(std::vector<double> &y,
                       const std::vector<double> &output_times,
                       const double tolerance,
                       const double initial_step,
                       const std::span<const StepLimit> limits,
                       const double start_time)
  {
    std::vector<double> ends = output_times;
    if (ends.empty() || ends.back() < 1.)
      ends.push_back(1.);
    TimeOutcome outcome;
    outcome.time       = start_time;
    steps_             = 0;
    tolerance_         = tolerance;
    f_time_            = -1.;
    double next        = initial_step;
    unsigned int limit = 0;
    if (monitor && !monitor({start_time, 0., 0, false, 0, 0}, y))
    {
      outcome.status    = "stopped";
      outcome.step_size = next;
      return outcome;
    }
    for (const double end : ends)
    {
      unsigned long left = 0; // steps of size h to the end
      double h           = 0.;
      while (outcome.time < end)
      {
        const double t = outcome.time;
        if (adaptive_)
        {
          const double wanted = left > 0 ? h : next,
                       most = admitted_step(limits.data(), static_cast<unsigned int>(limits.size()), limit, t, wanted);
          if (most < wanted)
          {
            next = most;
            left = 0;
          }
        }
        if (left == 0)
        {
          left = static_cast<unsigned long>(std::max(1., std::ceil((end - t) / next * (1. - same_size))));
          h    = (end - t) / static_cast<double>(left);
        }
        outcome.step_size   = h;
        const bool finite   = make_step(t, h, y);
        const double error  = finite && adaptive_ ? error_of_step(t, h, y) : 0.;
        const double factor = error > 0. ? radau::safety * std::pow(error, -1. / (tableau_.n + 1.)) : most_growth;
        if (!finite || h < least_step)
        {
          outcome.status  = "failed";
          outcome.reason  = finite ? "step_underflow" : "nonfinite";
          outcome.message = finite ? "the step size fell below the resolution of the time"
                                   : "a state of the linear model is not finite";
          return outcome;
        }
        if (!(error <= 1.))
        {
          ++outcome.rejected_steps;
          next = std::max(factor, radau::least_change) * h;
          left = 0;
          continue;
        }
        const std::size_t last = (tableau_.n - 1) * y.size();
        for (std::size_t d = 0; d < y.size(); ++d)
          y[d] = start_[d] + z_[last + d];
        --left;
        outcome.steps = ++steps_;
        outcome.time  = left == 0 ? end : t + h;
        end_          = outcome.time;
        std::swap(f_start_, f_end_);
        f_time_ = end_;
        // A new size is a new factorization.
        next = h;
        if (adaptive_ && (factor < 1. || factor > least_growth))
        {
          next = std::min(factor, most_growth) * h;
          if (next != h)
            left = 0;
        }
        const bool is_output_time = outcome.time == end;
        if (stage_rates)
          show_rates();
        if (monitor && !monitor({outcome.time, h, steps_, is_output_time, outcome.rejected_steps, 0}, y))
        {
          outcome.status    = "stopped";
          outcome.step_size = next;
          return outcome;
        }
      }
    }
    outcome.status = "finished";
    return outcome;
  }

  void
  LinearStepper::show_rates()
  {
    for (unsigned int i = 0; i < tableau_.n; ++i)
    {
      radau::stage_rate(static_cast<int>(tableau_.n),
                        tableau_.inverse.data(),
                        static_cast<int>(i),
                        1. / size_,
                        z_.data(),
                        static_cast<int>(rate_.size()),
                        rate_.data());
      stage_rates(end_ - (1. - tableau_.c[i]) * size_, rate_);
    }
  }

  void
  LinearStepper::interpolate(const double time, const Vector y)
  {
    const int s = static_cast<int>(tableau_.n);
    double weights[radau::most_stages];
    radau::collocation_weights(s, tableau_.c.data(), 1. - (end_ - time) / size_, weights);
    radau::combine(s, weights, z_.data(), static_cast<int>(y.size()), y.data());
    for (std::size_t d = 0; d < y.size(); ++d)
      y[d] += start_[d];
  }
} // namespace crawler
