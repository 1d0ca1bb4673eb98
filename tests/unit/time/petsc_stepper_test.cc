// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The time stepper on a scalar equation with a mass that depends on the state, no mesh: (1 + y^2) y' = (1 + sin^2 t)
// cos t, whose solution from y(0) = 0 is y = sin t.
#include "../../support/test.h"

#include <crawler/time/petsc_stepper.h>

using namespace crawler;

namespace
{
  class ScalarEquation : public ImplicitSystem
  {
  public:
    explicit ScalarEquation(const TimeParameters &parameters)
      : end_time(parameters.end_time)
      , stepper(petsc_stepper(MPI_COMM_SELF, *this, parameters))
    {
    }

    std::size_t
    n_owned() const override
    {
      return 1;
    }
    bool
    residual(double t, ConstVector y, ConstVector y_dot, Vector F) override
    {
      F[0] = (1. + y[0] * y[0]) * y_dot[0] - (1. + std::sin(t) * std::sin(t)) * std::cos(t) + added_to_residual;
      return y[0] < largest_admissible;
    }
    bool
    setup_jacobian(double, ConstVector y, ConstVector y_dot, double sigma) override
    {
      setup_stage(0, 0., y, y_dot);
      jacobian = sigma * by_rate[0] + by_state[0];
      return !singular;
    }
    void
    solve_with_jacobian(ConstVector b, Vector x) override
    {
      x[0] = wrong_direction ? -b[0] : b[0] / jacobian;
    }
    void
    jacobian_vmult(ConstVector x, Vector y) override
    {
      y[0] = jacobian * x[0];
    }
    bool
    setup_complex_jacobians(double, ConstVector y, ConstVector y_dot, std::span<const Complex> sigma) override
    {
      setup_stage(0, 0., y, y_dot);
      complex_jacobians.clear();
      for (const Complex &value : sigma)
        complex_jacobians.push_back(value * by_rate[0] + by_state[0]);
      return !singular;
    }
    void
    solve_with_complex_jacobian(unsigned int i, std::span<const Complex> b, std::span<Complex> x) override
    {
      x[0] = b[0] / complex_jacobians.at(i);
    }
    void
    setup_stage(unsigned int stage, double, ConstVector y, ConstVector y_dot) override
    {
      by_rate[stage]  = 1. + y[0] * y[0];
      by_state[stage] = 2. * y[0] * y_dot[0];
    }
    void
    stage_vmult(unsigned int stage, ConstVector x, ConstVector x_dot, Vector result) override
    {
      result[0] = by_state[stage] * x[0] + by_rate[stage] * x_dot[0];
    }

    TimeOutcome
    solve(const double tolerance, const double step, const std::vector<double> &output_times = {})
    {
      y                        = {0.};
      steps                    = {{0., 0., 0, false, 0, 0}};
      states                   = y;
      std::vector<double> ends = output_times;
      if (ends.empty() || ends.back() < end_time)
        ends.push_back(end_time);
      stepper->begin(y, {0., ends, tolerance, step, /*limits=*/{}});
      while (const Step *made = stepper->next())
      {
        y.assign(stepper->state().begin(), stepper->state().end());
        steps.push_back(*made);
        states.push_back(y[0]);
        if (seen)
          seen(*made);
      }
      return stepper->outcome();
    }

    const double end_time;
    std::unique_ptr<Stepper> stepper;
    std::function<void(const Step &)> seen;
    std::vector<double> y, states;
    std::vector<Step> steps;
    double jacobian = 1., largest_admissible = 10., added_to_residual = 0.;
    std::array<double, 5> by_state{}, by_rate{}; ///< of the stages
    std::vector<Complex> complex_jacobians;
    bool singular = false, wrong_direction = false;
  };

  TimeParameters
  parameters_for(const std::string &name, const StepControl control = StepControl::adaptive)
  {
    TimeParameters parameters;
    parameters.end_time     = 1.5;
    parameters.integrator   = name;
    parameters.step_control = control;
    return parameters;
  }
} // namespace

TEST(PetscStepper, StepsEndExactlyAtOutputTimes)
{
  for (const StepControl control : {StepControl::adaptive, StepControl::fixed})
  {
    ScalarEquation equation(parameters_for("bdf", control));
    const std::vector<double> output_times = {0.1, 1. / 3., 0.7, 0.7000001, 1.5};
    ASSERT_EQ(equation.solve(1e-9, 1e-3, output_times).status, Status::finished);
    std::vector<double> found;
    for (const Step &step : equation.steps)
      if (step.is_output_time)
        found.push_back(step.time);
    EXPECT_EQ(found, output_times); // exactly
    EXPECT_EQ(equation.steps.back().time, 1.5);
    EXPECT_EQ(equation.steps.front().number, 0u);
    EXPECT_NEAR(equation.y[0], std::sin(1.5), control == StepControl::fixed ? 1e-4 : 1e-7);
  }
}

/// Also where the end of a step less its size is not its start to the last bit, as in steps that grow.
TEST(PetscStepper, KnowsStatesFromStartToEndOfEachStep)
{
  unsigned int n_below = 0;
  for (unsigned int i = 1; i <= 50; ++i)
  {
    ScalarEquation equation(parameters_for("bdf"));
    std::vector<double> y(1);
    double before = 0., start = 0.;
    equation.seen = [&](const Step &step) {
      n_below += step.time - step.size < start;
      equation.stepper->interpolate(step.time - step.size, y);
      EXPECT_NEAR(y[0], before, 1e-6);
      equation.stepper->interpolate(step.time, y);
      EXPECT_NEAR(y[0], equation.y[0], 1e-12);
      before = equation.y[0];
      start  = step.time;
    };
    EXPECT_EQ(equation.solve(1e-3, 1e-5 / i).status, Status::finished);
  }
  EXPECT_GT(n_below, 0u); // else nothing was tested
}

TEST(PetscStepper, SolvesAgainWithTheSameResult)
{
  ScalarEquation equation(parameters_for("bdf"));
  const auto first = equation.solve(1e-9, 1e-5);
  const double y   = equation.y[0];
  equation.solve(1e-4, 1e-3);
  const auto again = equation.solve(1e-9, 1e-5);
  EXPECT_EQ(equation.y[0], y);
  EXPECT_EQ(again.steps, first.steps);
  EXPECT_EQ(again.newton_iterations, first.newton_iterations);
}

/// y = sin t would pass 0.5 at t = 0.5236: no step, however small, goes on from there.
TEST(PetscStepper, ARefusedStateIsADomainError)
{
  ScalarEquation equation(parameters_for("bdf"));
  equation.largest_admissible = 0.5;
  const auto outcome          = equation.solve(1e-9, 1e-4);
  EXPECT_EQ(outcome.status, Status::failed);
  EXPECT_TRUE(outcome.domain_error);
  EXPECT_NEAR(outcome.time, std::asin(0.5), 1e-8);
  EXPECT_LT(equation.y[0], 0.5);
}

TEST(PetscStepper, FailuresHaveNames)
{
  {
    ScalarEquation equation(parameters_for("bdf"));
    equation.singular = true;
    EXPECT_EQ(equation.solve(1e-8, 1e-4).reason, "linear_failed");
  }
  {
    ScalarEquation equation(parameters_for("bdf"));
    equation.added_to_residual = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(equation.solve(1e-8, 1e-4).reason, "nonfinite");
  }
  {
    ScalarEquation equation(parameters_for("bdf"));
    equation.wrong_direction = true;
    const auto outcome       = equation.solve(1e-8, 1e-4);
    EXPECT_EQ(outcome.status, Status::failed);
    EXPECT_NE(outcome.reason, "");
  }
}

/// Radau's complex systems are only made if the real one could be factored; otherwise none of them may be solved.
TEST(PetscStepper, FactorsThatAreNotThereAreNotUsed)
{
  for (const std::string name : {"radau 5", "radau 9"})
  {
    ScalarEquation equation(parameters_for(name));
    equation.singular  = true;
    const auto outcome = equation.solve(1e-8, 1e-4);
    EXPECT_EQ(outcome.status, Status::failed) << name;
    EXPECT_NE(outcome.reason, "") << name;
  }
}
