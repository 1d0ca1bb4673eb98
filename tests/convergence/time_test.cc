// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Required orders in time of every integrator that is offered, on the crawler itself: the displacement of the Fig. S1
// case (chi = 0.3), against the same mesh with a far smaller tolerance.
#include "../support/observed_order.h"
#include "../support/run_text.h"
#include "../support/test.h"

#include <petscsys.h>

using namespace crawler;

namespace
{
  const Numerics mesh{4, 8, 0., 0.};
} // namespace

/// On a stress that starts smoothly; from a sudden start, as that of the wave, no method of high order has its order.
TEST(Time, RadauReachesItsOrder)
{
  const auto displacement = [](const std::string &name, const unsigned int n, const std::string &krylov) {
    auto parameters =
      test::parameters_with(test::set("p = 2; expression; Active stress = 0.4*sin(pi*t)^8*cos(2*pi*(s-t))"));
    parameters.time.integrator   = name;
    parameters.time.step_control = StepControl::fixed;
    parameters.time.initial_step = 1. / n;
    if (!krylov.empty())
      PetscOptionsSetValue(nullptr, "-ksp_type", krylov.c_str());
    const Scene scene = parameters.create_scene();
    Simulation simulation(MPI_COMM_WORLD, scene, parameters.time, {mesh.degree, mesh.n_cells, 1e-13, 1. / n});
    PetscOptionsClearValue(nullptr, "-ksp_type");
    const auto result = simulation.run({}, {});
    EXPECT_EQ(result.time.status, Status::finished) << name;
    EXPECT_EQ(result.time.steps, n) << name;
    return result.displacement;
  };
  const double exact = displacement("radau 9", 200, "");
  for (const std::string krylov : {"", "gmres"})
    for (const auto &[name, steps] : {std::pair("radau 5", std::vector<double>{40, 80, 160}),
                                      std::pair("radau 9", std::vector<double>{16, 24, 32})})
    {
      std::vector<double> errors;
      for (const double n : steps)
        errors.push_back(std::abs(displacement(name, static_cast<unsigned int>(n), krylov) - exact));
      const double observed = test::observed_order(name + (" " + krylov), steps, errors);
      EXPECT_GE(observed, name == std::string("radau 5") ? 4.8 : 8.) << name;
    }
}

/// bdf starts with small steps of low order, so its order is that of error over steps as the tolerance decreases.
TEST(Time, BdfReachesItsOrder)
{
  const auto run = [](const unsigned int order, const double tolerance) {
    auto parameters            = test::parameters_with(test::wave(-1., 0.3));
    parameters.time.integrator = "bdf";
    parameters.time.order      = order;
    const Scene scene          = parameters.create_scene();
    Simulation simulation(MPI_COMM_WORLD, scene, parameters.time, {mesh.degree, mesh.n_cells, tolerance, 1e-6});
    return simulation.run({}, {});
  };
  const double exact = run(5, 1e-14).displacement;
  for (unsigned int order = 1; order <= 5; ++order)
  {
    std::vector<double> steps, errors;
    for (const double tolerance :
         order == 1 ? std::vector<double>{1e-6, 1e-7, 1e-8} : std::vector<double>{1e-7, 1e-8, 1e-9, 1e-10})
    {
      const auto result = run(order, tolerance);
      ASSERT_EQ(result.time.status, Status::finished);
      steps.push_back(result.time.steps);
      errors.push_back(std::abs(result.displacement - exact));
    }
    const double observed = test::observed_order("bdf " + std::to_string(order), steps, errors);
    EXPECT_GE(observed, order - 0.3) << order;
  }
}
