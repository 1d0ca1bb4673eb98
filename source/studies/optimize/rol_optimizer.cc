// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/optimize/rol_optimizer.h>

#include <ROL_Bounds.hpp>
#include <ROL_ParameterList.hpp>
#include <ROL_Problem.hpp>
#include <ROL_Solver.hpp>
#include <ROL_StdConstraint.hpp>
#include <ROL_StdObjective.hpp>
#include <ROL_StdVector.hpp>

#include <cmath>
#include <sstream>

namespace crawler
{
  namespace
  {
    using List = std::vector<double>;

    /// An approximation of a Hessian by the gradients at the points where it was asked for.
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

    class Objective : public ROL::StdObjective<double>
    {
    public:
      explicit Objective(GaitProblem &problem)
        : problem_(problem)
      {
      }
      double
      value(const List &y, double &) override
      {
        return problem_.at(y, false).objective;
      }
      void
      gradient(List &gradient, const List &y, double &) override
      {
        gradient = problem_.at(y, true).gradient;
      }
      void
      hessVec(List &result, const List &v, const List &y, double &) override
      {
        hessian_.see(y, problem_.at(y, true).gradient);
        result.assign(v.size(), 0.);
        hessian_.add(1., v, result);
      }

    private:
      GaitProblem &problem_;
      RankOneHessian hessian_;
    };

    class Constraint : public ROL::StdConstraint<double>
    {
    public:
      explicit Constraint(GaitProblem &problem)
        : problem_(problem)
        , hessians_(problem.n_rows())
      {
      }
      void
      value(List &c, const List &y, double &) override
      {
        c = problem_.at(y, false).constraints;
      }
      void
      applyJacobian(List &result, const List &v, const List &y, double &) override
      {
        problem_.apply_jacobian(problem_.at(y, true), v, result);
      }
      void
      applyAdjointJacobian(List &result, const List &v, const List &y, double &) override
      {
        problem_.apply_transposed(problem_.at(y, true), v, result);
      }
      void
      applyAdjointHessian(List &result, const List &u, const List &v, const List &y, double &) override
      {
        const GaitProblem::Point &point = problem_.at(y, true);
        result.assign(v.size(), 0.);
        for (std::size_t r = 0; r < point.rows.size(); ++r)
        {
          hessians_[r].see(y, point.rows[r]);
          hessians_[r].add(u[r], v, result);
        }
      }

    private:
      GaitProblem &problem_;
      std::vector<RankOneHessian> hessians_;
    };

    ROL::Ptr<ROL::StdVector<double>>
    vector_of(const List &list)
    {
      return ROL::makePtr<ROL::StdVector<double>>(ROL::makePtr<List>(list));
    }

    ROL::Ptr<ROL::BoundConstraint<double>>
    bounds_of(const List &lower, const List &upper)
    {
      const auto finite = [](List list) {
        for (double &one : list)
          one = std::isfinite(one) ? one : std::copysign(ROL::ROL_INF<double>(), one);
        return vector_of(list);
      };
      return ROL::makePtr<ROL::Bounds<double>>(finite(lower), finite(upper));
    }

    ROL::ParameterList
    settings(const double tolerance, const unsigned int most_iterations)
    {
      ROL::ParameterList list;
      ROL::ParameterList &step = list.sublist("Step"), &lagrangian = step.sublist("Augmented Lagrangian"),
                         &test = list.sublist("Status Test");
      step.set("Type", "Augmented Lagrangian");
      lagrangian.set("Use Default Problem Scaling", false);
      lagrangian.set("Subproblem Iteration Limit", 200);
      lagrangian.set("Initial Optimality Tolerance", 1e-2);
      test.set("Gradient Tolerance", tolerance);
      test.set("Constraint Tolerance", 0.1 * tolerance);
      test.set("Step Tolerance", 1e-12);
      test.set("Iteration Limit", static_cast<int>(most_iterations));
      return list;
    }
  } // namespace

  OptimizerEnd
  minimise(GaitProblem &problem,
           const std::vector<double> &y,
           std::vector<double> first_multipliers,
           const double tolerance,
           const unsigned int most_iterations)
  {
    const auto unknowns = vector_of(y);
    ROL::Ptr<ROL::Problem<double>> rol =
      ROL::makePtr<ROL::Problem<double>>(ROL::makePtr<Objective>(problem), unknowns);
    rol->addBoundConstraint(bounds_of(List(y.size(), 0.), List(y.size(), 1.)));
    first_multipliers.resize(problem.lower().size());
    const auto multipliers  = vector_of(first_multipliers);
    ROL::ParameterList list = settings(tolerance, most_iterations);
    if (problem.lower().empty())
      list.sublist("Step").set("Type", "Trust Region");
    else
    {
      const ROL::Ptr<ROL::Constraint<double>> limits = ROL::makePtr<Constraint>(problem);
      const ROL::Ptr<ROL::Vector<double>> of_limits  = multipliers;
      rol->addConstraint("limits", limits, of_limits, bounds_of(problem.lower(), problem.upper()));
    }
    std::ostringstream unread;
    rol->finalize(false, false, unread);
    ROL::Solver<double> solver(rol, list);
    solver.solve(unread);
    const auto state = solver.getAlgorithmState();
    const bool is_good =
      state->statusFlag == ROL::EXITSTATUS_CONVERGED || state->statusFlag == ROL::EXITSTATUS_STEPTOL;
    return {is_good,
            is_good ? "" : ROL::EExitStatusToString(state->statusFlag),
            static_cast<unsigned int>(state->iter),
            *multipliers->getVector()};
  }
} // namespace crawler
