// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/optimize/rol_optimizer.h>

#include <ROL_Bounds.hpp>
#include <ROL_ParameterList.hpp>
#include <ROL_StdObjective.hpp>
#include <ROL_StdVector.hpp>
#include <ROL_TypeB_LinMoreAlgorithm.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace crawler
{
  namespace
  {
    using List = std::vector<double>;

    /// Approximate Hessian from the gradients at the points of evaluation.
    class RankOneHessian
    {
    public:
      void
      see(const List &y, const List &gradient)
      {
        const std::size_t n = y.size();
        if (matrix_.empty())
          matrix_.assign(n * n, 0.);
        if (y == y_)
          return;
        if (!y_.empty())
        {
          List s(n), r(n);
          double r_s = 0., r_r = 0., s_s = 0.;
          for (std::size_t i = 0; i < n; ++i)
            s[i] = y[i] - y_[i];
          for (std::size_t i = 0; i < n; ++i)
          {
            r[i] = gradient[i] - gradient_[i];
            for (std::size_t j = 0; j < n; ++j)
              r[i] -= matrix_[i * n + j] * s[j];
            r_s += r[i] * s[i];
            r_r += r[i] * r[i];
            s_s += s[i] * s[i];
          }
          constexpr double least = 1e-8;
          if (std::abs(r_s) > least * std::sqrt(r_r * s_s))
            for (std::size_t i = 0; i < n; ++i)
              for (std::size_t j = 0; j < n; ++j)
                matrix_[i * n + j] += r[i] * r[j] / r_s;
        }
        y_        = y;
        gradient_ = gradient;
      }

      void
      add(const double factor, const List &v, List &result) const
      {
        for (std::size_t i = 0; i < v.size(); ++i)
          for (std::size_t j = 0; j < v.size(); ++j)
            result[i] += factor * matrix_[i * v.size() + j] * v[j];
      }

    private:
      List y_, gradient_, matrix_;
    };

    /**
     * Augmented Lagrangian f + sum (t^2 - mu^2)/(2 rho), where t = mu + rho (c - bound) if that pulls c back to the
     * bound, and 0 otherwise (Rockafellar 1974): the slack variables of the limits are eliminated.
     */
    class Lagrangian : public ROL::StdObjective<double>
    {
    public:
      explicit Lagrangian(GaitProblem &problem, List multipliers)
        : mu(std::move(multipliers))
        , problem_(problem)
        , hessians_(problem.n_numbers())
      {
      }

      List mu; ///< multipliers of c
      double rho = 1.;

      /// t of all limits.
      List
      forces(const List &c) const
      {
        List t(c.size());
        for (std::size_t i = 0; i < c.size(); ++i)
          t[i] = std::max(mu[i] + rho * (c[i] - problem_.upper()[i]), 0.) +
                 std::min(mu[i] + rho * (c[i] - problem_.lower()[i]), 0.);
        return t;
      }

      double
      value(const List &y, double &) override
      {
        const GaitProblem::Point &point = problem_.at(y, false);
        const List t                    = forces(point.constraints);
        double sum                      = point.objective;
        for (std::size_t i = 0; i < t.size(); ++i)
          sum += (t[i] * t[i] - mu[i] * mu[i]) / (2. * rho);
        return sum;
      }
      void
      gradient(List &gradient, const List &y, double &) override
      {
        const List t                    = forces(problem_.at(y, false).constraints);
        const GaitProblem::Point &point = problem_.at(y, true, t);
        apply_transposed(point, t, gradient);
        for (std::size_t i = 0; i < y.size(); ++i)
          gradient[i] += point.gradient[i];
      }
      void
      hessVec(List &result, const List &v, const List &y, double &) override
      {
        const List t                    = forces(problem_.at(y, false).constraints);
        const GaitProblem::Point &point = problem_.at(y, true, t);
        List change(t.size());
        for (std::size_t i = 0; i < v.size(); ++i)
          for (std::size_t r = 0; r < t.size(); ++r)
            change[r] += point.jacobian[i][r] * v[i];
        for (std::size_t r = 0; r < t.size(); ++r)
          change[r] *= t[r] != 0. ? rho : 0.;
        apply_transposed(point, change, result);
        hessian_.see(y, point.gradient);
        hessian_.add(1., v, result);
        for (std::size_t r = 0; r < hessians_.size(); ++r)
        {
          List row;
          for (const List &derivatives : point.jacobian)
            row.push_back(derivatives[r]);
          hessians_[r].see(y, row);
          hessians_[r].add(t[r], v, result);
        }
      }

    private:
      /// Product of the transposed Jacobian of c with forces, most of which are 0.
      static void
      apply_transposed(const GaitProblem::Point &point, const List &t, List &sum)
      {
        sum.assign(point.gradient.size(), 0.);
        for (std::size_t r = 0; r < t.size(); ++r)
          if (t[r] != 0.)
            for (std::size_t i = 0; i < sum.size(); ++i)
              sum[i] += t[r] * point.jacobian[i][r];
      }

      GaitProblem &problem_;
      RankOneHessian hessian_;
      std::vector<RankOneHessian> hessians_;
    };

    ROL::Ptr<ROL::StdVector<double>>
    vector_of(const List &list)
    {
      return ROL::makePtr<ROL::StdVector<double>>(ROL::makePtr<List>(list));
    }

    ROL::ParameterList
    settings(const double tolerance)
    {
      constexpr int max_steps = 200;
      ROL::ParameterList list;
      ROL::ParameterList &test = list.sublist("Status Test");
      test.set("Gradient Tolerance", tolerance);
      test.set("Step Tolerance", 1e-2 * tolerance);
      test.set("Iteration Limit", max_steps);
      return list;
    }

    /// Largest violation of a limit, or distance from one whose multiplier is active: |t - mu|/rho is both (Birgin and
    /// Martinez, Practical Augmented Lagrangian Methods, 2014, section 4.1).
    double
    distance_from_complementarity(const List &t, const List &mu, const double rho)
    {
      double largest = 0.;
      for (std::size_t i = 0; i < t.size(); ++i)
        largest = std::max(largest, std::abs(t[i] - mu[i]) / rho);
      return largest;
    }
  } // namespace

  OptimizerEnd
  minimise(GaitProblem &problem,
           const std::vector<double> &y,
           std::vector<double> multipliers,
           const double tolerance,
           const unsigned int max_iterations)
  {
    constexpr double first_tolerance = 1e-2, first_penalty = 10., largest_penalty = 1e6, less = 0.25;
    constexpr unsigned int max_idle = 5;
    multipliers.resize(problem.lower().size());
    const auto lagrangian = ROL::makePtr<Lagrangian>(problem, std::move(multipliers));
    lagrangian->rho       = first_penalty;
    const auto unknowns   = vector_of(y);
    const bool has_limits = !problem.lower().empty();
    unsigned int n_idle   = 0; // iterations without improvement
    double inner = has_limits ? std::max(first_tolerance, tolerance) : tolerance, before = HUGE_VAL;
    ROL::Bounds<double> limits(vector_of(List(y.size(), 0.)), vector_of(List(y.size(), 1.)));
    std::ostringstream unread;
    for (unsigned int i = 1; i <= max_iterations; ++i)
    {
      ROL::ParameterList list = settings(inner);
      ROL::TypeB::LinMoreAlgorithm<double> algorithm(list);
      algorithm.run(*unknowns, *lagrangian, limits, unread);
      const ROL::EExitStatus end = algorithm.getState()->statusFlag;
      // Steps that became small because gaits there are impossible do not indicate an optimum.
      std::string impossible;
      if (end == ROL::EXITSTATUS_STEPTOL && algorithm.getState()->gnorm > inner)
        impossible = problem.latest_beside(*unknowns->getVector()).problem;
      const bool is_good = (end == ROL::EXITSTATUS_CONVERGED || end == ROL::EXITSTATUS_STEPTOL) && impossible.empty();
      if (!impossible.empty())
        impossible.insert(0, "better gaits are impossible: ");
      const List t     = lagrangian->forces(problem.at(*unknowns->getVector(), false).constraints);
      const double now = distance_from_complementarity(t, lagrangian->mu, lagrangian->rho);
      lagrangian->mu   = t;
      if (is_good && inner <= tolerance && now <= tolerance)
        return {*unknowns->getVector(), true, "", i, lagrangian->mu};
      if (!has_limits && !is_good)
        return {*unknowns->getVector(), false, impossible.empty() ? ROL::EExitStatusToString(end) : impossible, i, {}};
      n_idle = (is_good && now <= tolerance) || now < 0.9 * before ? 0 : n_idle + 1;
      if (n_idle == max_idle)
        return {*unknowns->getVector(),
                false,
                !impossible.empty() ? impossible
                : now > tolerance   ? "the limits seem to contradict each other, or the start is too far from them"
                                    : "the optimiser makes no progress",
                i,
                lagrangian->mu};
      if (now > less * before && now > tolerance)
        lagrangian->rho = std::min(10. * lagrangian->rho, largest_penalty);
      before = now;
      inner  = std::max(0.1 * inner, tolerance);
    }
    return {*unknowns->getVector(), false, "too many iterations", max_iterations, lagrangian->mu};
  }
} // namespace crawler
