// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/lanes/linear_stepper.h>
#include <crawler/time/radau_loops.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

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

  LinearStepper::LinearStepper(PositionForm &form, const unsigned int n_stages, const bool adaptive)
    : form_(form)
    , tableau_(radau_tableau(n_stages))
    , adaptive_(adaptive)
    , mass_(form.discretization())
    , stiffness_(form.discretization())
    , row_sums_(form.n_owned())
    , start_(form.n_owned())
    , z_(n_stages * form.n_owned())
    , right_(z_.size())
    , work_(form.n_owned())
    , rate_(form.n_owned())
    , error_(form.n_owned())
  {
    for (unsigned int i = 0; i < n_stages; ++i)
      stage_places_.push_back(tableau_.c[i]);
    form_.mass(0., start_, start_, mass_);
    form_.jacobian(0., start_, start_, 0., stiffness_);
    mass_.multiply(std::vector<double>(form.n_owned(), 1.), row_sums_);
  }

  /// The blocks of of_mass M + K.
  template <typename Number>
  void
  LinearStepper::fill(BlockTridiagonalMatrix<Number> &matrix, const Number of_mass) const
  {
    auto &blocks = matrix.blocks();
    for (std::size_t i = 0; i < blocks.size(); ++i)
      blocks[i] = stiffness_.blocks()[i] + of_mass * mass_.blocks()[i];
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
    factors_.push_front({h, BlockTridiagonalMatrix<double>(form_.discretization()), {}});
    Factors &made = factors_.front();
    // Both matrices are positive (semi)definite and the shifts are in the right half plane: no pivot vanishes.
    fill(made.real, tableau_.real_eigenvalue / h);
    bool ok = made.real.factorize();
    for (const auto lambda : tableau_.eigenvalues)
    {
      made.complex.emplace_back(form_.discretization());
      fill(made.complex.back(), lambda / h);
      ok = made.complex.back().factorize() && ok;
    }
    if (!ok)
      throw std::logic_error("a system of the linear model is singular");
    ++n_factorizations_;
    return made;
  }

  /**
   * The increments z_i = u(t + c_i h) - u(t), from  M sum_j (A^-1)_ij z_j/h + K z_i + F(t + c_i h, u, 0) = 0. In the
   * basis of the eigenvectors of A^-1 the stages do not depend on each other (@cite HairerWanner1996, section IV.8).
   * Returns false if the result is not finite.
   */
  bool
  LinearStepper::make_step(const double t, const double h, const ConstVector y)
  {
    const std::size_t size = y.size();
    const unsigned int n   = tableau_.n;
    const Factors &systems = factors(h);
    std::copy(y.begin(), y.end(), start_.begin());
    for (unsigned int i = 0; i < n; ++i)
      form_.residual(t + tableau_.c[i] * h, y, {}, {right_.data() + i * size, size});
    for (double &value : right_)
      value = -value;
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
    std::copy(y.begin(), y.end(), work_.begin());
    double error = 0.;
    for (unsigned int round = 0; round < (steps_ < radau::settling_steps ? 2 : 1); ++round)
    {
      form_.residual(t, work_, rate_, error_);
      for (double &value : error_)
        value = -value;
      factors(h).real.solve(error_, error_);
      error = root_mean_square(error_) / tolerance_;
      if (round > 0) // filtered twice: the step must not grow
        error = std::max(error, radau::error_without_growth(static_cast<int>(tableau_.n)));
      if (error < 1.)
        break;
      for (std::size_t d = 0; d < y.size(); ++d)
        work_[d] = y[d] + error_[d];
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
    if (form_.discretization().n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, form_.discretization().communicator());
    return sum;
  }

  double
  LinearStepper::root_mean_square(const ConstVector x) const
  {
    double sum = 0.;
    for (const double value : x)
      sum += value * value;
    if (form_.discretization().n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, form_.discretization().communicator());
    return std::sqrt(sum / static_cast<double>(form_.n_unknowns()));
  }

  /// Divides the time to @p end, unless that is still good.
  void
  LinearStepper::plan_steps(Plan &plan, const double t, const double end, const std::span<const StepLimit> limits) const
  {
    if (adaptive_)
    {
      const double wanted = plan.left > 0 ? plan.h : plan.next;
      const double most = admitted_step(limits.data(), static_cast<unsigned int>(limits.size()), plan.limit, t, wanted);
      if (most < wanted)
      {
        plan.next = most;
        plan.left = 0;
      }
    }
    if (plan.left > 0)
      return;
    plan.left = static_cast<unsigned long>(std::max(1., std::ceil((end - t) / plan.next * (1. - same_size))));
    plan.h    = (end - t) / static_cast<double>(plan.left);
  }

  /// After a step that could have been @p factor times as long. A new size is a new factorization.
  void
  LinearStepper::plan_next_step(Plan &plan, const double factor) const
  {
    plan.next = plan.h;
    if (!adaptive_ || (factor >= 1. && factor <= least_growth))
      return;
    plan.next = std::min(factor, most_growth) * plan.h;
    if (plan.next != plan.h)
      plan.left = 0;
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
    const bool is_first = !goes_on_;
    goes_on_            = false;
    if (is_first)
    {
      time_  = start_time;
      steps_ = rejected_ = 0;
      plan_              = Plan{initial_step};
    }
    tolerance_ = tolerance;
    TimeOutcome outcome;
    const auto ended = [&](const Status status, const double step_size) {
      outcome.status         = status;
      outcome.time           = time_;
      outcome.step_size      = step_size;
      outcome.steps          = steps_;
      outcome.rejected_steps = rejected_;
      return outcome;
    };
    const auto goes_on = [&](const double h, const bool is_output_time) {
      return !monitor || monitor({time_, h, steps_, is_output_time, rejected_, 0}, y);
    };
    if (is_first && !goes_on(0., false))
      return ended(Status::stopped, plan_.next);
    for (const double end : ends)
      while (time_ < end)
      {
        plan_steps(plan_, time_, end, limits);
        const double h      = plan_.h;
        const bool finite   = make_step(time_, h, y);
        const double error  = finite && adaptive_ ? error_of_step(time_, h, y) : 0.;
        const double factor = error > 0. ? radau::safety * std::pow(error, -1. / (tableau_.n + 1.)) : most_growth;
        if (!finite || h < least_step)
        {
          outcome.reason  = finite ? "step_underflow" : "nonfinite";
          outcome.message = finite ? "the step size fell below the resolution of the time"
                                   : "a state of the linear model is not finite";
          return ended(Status::failed, h);
        }
        if (!(error <= 1.))
        {
          ++rejected_;
          plan_.next = std::max(factor, radau::least_change) * h;
          plan_.left = 0;
          continue;
        }
        const std::size_t last = (tableau_.n - 1) * y.size();
        for (std::size_t d = 0; d < y.size(); ++d)
          y[d] = start_[d] + z_[last + d];
        --plan_.left;
        ++steps_;
        time_ = plan_.left == 0 ? end : time_ + h;
        end_  = time_;
        plan_next_step(plan_, factor);
        if (stage_rates)
          show_rates();
        if (!goes_on(h, time_ == end))
          return ended(Status::stopped, plan_.next);
      }
    return ended(Status::finished, plan_.h);
  }

  /// Factors of a size that is nearly another one are used for that, too, so they are those of then.
  bool
  LinearStepper::exchange(Archive &archive)
  {
    std::vector<double> sizes;
    for (const Factors &known : factors_)
      sizes.push_back(known.h);
    archive(sizes, plan_, steps_, rejected_, time_);
    if (archive.reads())
    {
      factors_.clear();
      for (auto h = sizes.rbegin(); h != sizes.rend(); ++h)
        factors(*h);
    }
    goes_on_ = archive.reads();
    return true;
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
