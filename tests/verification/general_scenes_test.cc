// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Whole runs of general bodies and grounds (doc/theory.md) against plain scenes, closed forms and symmetries. Every run
// must close its energy balance and balance its friction.
#include "../support/run_text.h"
#include "../support/temporary_folder.h"
#include "../support/test.h"

#include <crawler/base/exceptions.h>

using namespace crawler;

namespace
{
  using std::numbers::pi;
  using test::Settings;
  using test::text;

  Settings
  operator+(Settings a, const Settings &b)
  {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }

  Settings
  expression(const std::string &formula)
  {
    return test::set("expression; Active stress = {}", formula);
  }

  Settings
  feedback(const std::string &formula, const double distance = 0., const double delay = 0., const double sensor = 0.)
  {
    return test::set("strain feedback; Active stress = {}; Distance = {}; Delay = {}; Sensor length = {}",
                     formula,
                     distance,
                     delay,
                     sensor);
  }

  SimulationResult
  run(const Settings &settings, const double max_residual = 1e-6)
  {
    SimulationResult result = test::run_with(settings).result;
    EXPECT_EQ(result.time.status, Status::finished) << result.time.message;
    EXPECT_LT(result.energy_balance->residual(), max_residual);
    EXPECT_LT(result.residuals.net_friction, 1e-9);
    return result;
  }

  double
  displacement(const Settings &settings)
  {
    return run(settings).displacement;
  }

  void
  expect_near(const double found, const double expected, const double part)
  {
    EXPECT_NEAR(found, expected, part * std::abs(expected));
  }

  /// The part of its elastic energy that a body keeps until the end time.
  double
  energy_left(const Settings &settings)
  {
    const EnergyBalance energy_balance = *run(settings).energy_balance;
    return energy_balance.elastic_energy / energy_balance.initial_energy;
  }

  const std::string wave_formula = "0.3*sin(2*pi*(s+t))*s*(1-s)*4";
  const Settings petsc           = {{"Time/Engine", "petsc"}};
  const Settings stretch_form    = {{"Discretization/Formulation", "stretch"}};

  /// Of high order in space, in the position form; or the stretch form with many cells.
  Settings
  numerics(const bool stretch)
  {
    if (stretch)
      return stretch_form + test::set("cells = 1000; tolerance = 1e-13");
    return test::set("degree = 4; cells = 8; integrator = radau 9; tolerance = 1e-13");
  }
} // namespace

TEST(GeneralScenes, ConstantProfilesAreNumbers)
{
  const Settings wave =
    expression(wave_formula) + Settings{{"Discretization/Number of cells", "8"}, {"Time/Tolerance", "1e-10"}};
  const double by_body = displacement(wave + petsc + Settings{{"Body/Elastic modulus", "1.5"}});
  expect_near(displacement(wave + Settings{{"Body/Elastic modulus profile", "1.5"}}), by_body, 1e-11);
  const double by_friction = displacement(wave + petsc + Settings{{"Body/Friction coefficient", "1.5"}});
  expect_near(displacement(wave + Settings{{"Body/Friction profile", "1.5"}}), by_friction, 1e-10);
  expect_near(displacement(wave + Settings{{"Ground/Profile", "1.5"}}), by_friction, 1e-10);
}

TEST(GeneralScenes, LawsAgreeWithThePowerLaw)
{
  for (const double a : {-1.5, -1., 0.5})
  {
    const Settings wave = expression(wave_formula) + Settings{{"Body/Anchoring exponent", text(1. - a)}};
    const double power  = displacement(wave);
    const Settings law =
      test::set("Ground/Friction law = expression; Ground/Expression = w^a; Ground/Constants = a={}", a);
    expect_near(displacement(wave + law), power, 1e-10);
  }
  const Settings wave = expression(wave_formula);
  expect_near(displacement(wave + Settings{{"Ground/Friction law", "Newtonian"}}),
              displacement(wave + Settings{{"Body/Anchoring exponent", "0"}}),
              1e-10);
}

/// The active stress of the optimal wave is made for the power law that touches the friction law at the stretch 1.
TEST(GeneralScenes, WavesAreMadeForTheLaw)
{
  const Settings law = {{"Ground/Friction law", "expression"}, {"Ground/Expression", "w^2"}};
  expect_near(displacement(test::wave(-1., 0.2) + law), displacement(test::wave(2., 0.2) + petsc), 1e-10);
}

/// m = -kappa (w - 1) is a softer body. All integrators and both forms see the same.
TEST(GeneralScenes, LinearFeedbackIsAModulus)
{
  const double softer = displacement(expression(wave_formula) + Settings{{"Body/Elastic modulus", "0.6"}});
  const Settings same = feedback(wave_formula + "-0.4*(w-1)");
  for (const std::string integrator : {"automatic", "bdf", "radau 9"})
    expect_near(displacement(same + Settings{{"Time/Integrator", integrator}}), softer, 2e-6);
  expect_near(displacement(same + stretch_form), softer, 2e-6);
  expect_near(displacement(same + Settings{{"Discretization/Mesh", "adaptive"}}), softer, 2e-6);
}

/// doc/theory.md: strain modes decay at the rate k q^2/gamma, those of a Kelvin-Voigt body, m = eta w_t, at k
/// q^2/(gamma + eta q^2).
TEST(GeneralScenes, StrainModesDecay)
{
  constexpr double k = 0.7, gamma = 1.3, eta = 0.2, T = 0.4, small = 1e-5;
  for (const int mode : {1, 2})
    for (const double viscosity : {0., eta})
      for (const bool stretch : {false, true})
      {
        const double q = mode * pi, rate = k * q * q / (gamma + viscosity * q * q);
        const Settings body    = test::set("k = {}; gamma = {}; Body/Initial stretch = 1+{}*sin({}*pi*s); T = {}; none",
                                        k,
                                        gamma,
                                        small,
                                        mode,
                                        T / (mode * mode)),
                       viscous = viscosity > 0. ? feedback(text(viscosity) + "*w_t") : Settings();
        expect_near(energy_left(body + viscous + numerics(stretch)), std::exp(-2. * rate * T / (mode * mode)), 1e-4);
      }
}

/// The same with m = kappa (w_delayed - 1), by the method of steps: e' = -A e - B e(t - delay), e = 1 before t = 0.
TEST(GeneralScenes, DelayedModesDecay)
{
  constexpr double k = 0.05, kappa = 0.1, delay = 0.5;
  const double A = k * pi * pi, B = kappa * pi * pi;
  const auto first  = [&](const double t) { return (1. + B / A) * std::exp(-A * t) - B / A; };
  const auto second = [&](const double t) {
    return first(delay) * std::exp(-A * t) -
           B * ((1. + B / A) * t * std::exp(-A * t) - B / A * (1. - std::exp(-A * t)) / A);
  };
  for (const double T : {0.3, 1.})
    for (const std::string integrator : {"bdf", "radau 9"})
    {
      const Settings settings = test::set("k = {}; Body/Initial stretch = 1+1e-6*sin(pi*s); T = {}; "
                                          "degree = 4; cells = 8; tolerance = 1e-13; integrator = {}",
                                          k,
                                          T,
                                          integrator);
      const double e          = T <= delay ? first(T) : second(T - delay);
      expect_near(energy_left(settings + feedback(text(kappa) + "*(w_delayed-1)", 0., delay)), e * e, 1e-4);
    }
}

TEST(GeneralScenes, NearbyStretch)
{
  // Next to the place itself: linear feedback, up to the distance.
  const double softer = displacement(expression(wave_formula) + Settings{{"Body/Elastic modulus", "0.6"}});
  const Settings mesh = {{"Discretization/Number of cells", "12"}, {"Time/Tolerance", "1e-9"}};
  expect_near(displacement(feedback(wave_formula + "-0.4*(w_near-1)", 1e-6) + mesh), softer, 1e-4);
  // The mirror image moves the other way.
  const Settings to_right = feedback("0.3*sin(2*pi*(s+t))*s*(1-s)*4+0.5*(w_near-1)", 0.25),
                 to_left  = feedback("0.3*sin(2*pi*(1-s+t))*s*(1-s)*4+0.5*(w_near-1)", -0.25);
  expect_near(displacement(to_left), -displacement(to_right), 2e-5);
}

/// A sensor as long as the body, m = K (mean of w - 1): e = cos(p (s - L/2)) with N = 0 at the ends needs
/// k cos x + K sin(x)/x = 0, x = p L/2, and decays at the rate k p^2/gamma; with K < -k it grows as cosh, x imaginary.
TEST(GeneralScenes, ModesOfASensorAsLongAsTheBody)
{
  struct Case
  {
    double K, rate;
    std::string mode;
  };
  constexpr double k = 0.3, x = 2.028757838110434, y = 1.9150080481545;
  EXPECT_NEAR(std::tan(x), -x, 1e-12);
  EXPECT_NEAR(std::tanh(y), 0.5 * y, 1e-12);
  for (const Case &mode : {Case{k, -4. * k * x * x, "cos(" + text(2. * x) + "*(s-0.5))"},
                           Case{-2. * k, 4. * k * y * y, "cosh(" + text(2. * y) + "*(s-0.5))"}})
  {
    const double T = 0.2, expected = std::exp(2. * mode.rate * T);
    const double left = energy_left(feedback(text(mode.K) + "*(w_near-1)", 0., 0., 1.) + numerics(/*stretch=*/false) +
                                    test::set("k = {}; Body/Initial stretch = 1+1e-5*{}; T = {}", k, mode.mode, T));
    expect_near(left, expected, 5e-4);
  }
}

/// The mode of prm/examples/feedback.prm that grows, by contrib/feedback_modes.py: rate 4.8993, period 0.8765. The
/// elastic energy of one mode grows by exp(2 rate) over half a period.
TEST(GeneralScenes, AModeGrowsByItself)
{
  constexpr double rate = 4.8993, half_period = 0.43825, start = 1.6;
  const auto energy = [&](const double T) {
    return energy_left(feedback("0.05*tanh(10*(w_near-1))", -0.25, 0., 0.2) +
                       test::set("k = 0.1; Body/Initial stretch = 1+1e-7*exp(-((s-0.425)/0.05)^2); T = {}; "
                                 "degree = 6; cells = 16; integrator = radau 9; tolerance = 1e-10",
                                 T));
  };
  expect_near(energy(start + half_period) / energy(start), std::exp(2. * rate * half_period), 1e-3);
}

/// A motion that is known: w = 1 + E sin(t) sin(pi s), at a = 0 driven by m = -(E/pi^2) cos(t) sin(pi s) - k E sin(t)
/// sin(pi s). Feedback K (w_near - M) does not change it if w_near is M, the mean over the sensor. The elastic energy
/// and the largest stretch tell.
TEST(GeneralScenes, SensorsSeeTheMean)
{
  constexpr double E = 0.3, T = 1.;
  for (const double distance : {0., 0.3, -0.45})
    for (const double sensor : {0.03, 0.5, 1.})
      for (const Settings &own : {Settings{{"Discretization/Number of cells", "12"}},
                                  Settings{{"Discretization/Mesh", "adaptive"}},
                                  Settings{{"Time/Integrator", "bdf"}}})
      {
        const std::string left = "min(max(s+" + text(distance) + "-b/2,0),1-b)";
        const std::string mean = "(1+E*sin(t)*(cos(pi*" + left + ")-cos(pi*(" + left + "+b)))/(pi*b))";
        const auto result      = run(
          feedback("-E/pi^2*cos(t)*sin(pi*s)-E*sin(t)*sin(pi*s)+1.5*(w_near-" + mean + ")", distance, 0., sensor) +
          own + test::set("p = 1; T = {}; tolerance = 1e-8; strain feedback; Constants = E={}, b={}", T, E, sensor));
        expect_near(result.energy_balance->elastic_energy, 0.25 * E * E * std::sin(T) * std::sin(T), 1e-5);
        expect_near(result.stretch.max.value, 1. + E * std::sin(T), 1e-4);
      }
}

/// Uniform stretch w = 1 + e(t) on the ground c(x) = exp(beta x), with a = 0: the balance int c (s w' + h') ds = 0
/// gives zeta = s w + h with h = -log( (exp(beta w) - 1)/(beta w) beta/(exp(beta) - 1) )/beta.
TEST(GeneralScenes, GroundThatBecomesSticky)
{
  constexpr double beta = 1.2, E = 0.3;
  const auto h = [&](const double w) {
    return -std::log((std::exp(beta * w) - 1.) / (beta * w) * beta / (std::exp(beta) - 1.)) / beta;
  };
  const std::string w = "(1+E*sin(t)^2)", w_t = "(E*sin(2*t))", p = "(b*" + w + ")", power = "(exp(b*" + w + "*s)-1)",
                    whole = "(exp(b*" + w + ")-1)", h_of_t = "(-log(" + whole + "/" + p + "*b/(exp(b)-1))/b)",
                    h_t = "(-" + w_t + "*(exp(" + p + ")/" + whole + "-1/" + p + "))";
  // m = int_0^s c v ds - k e
  const Settings scene = expression("exp(b*" + h_of_t + ")*(" + w_t + "*(s*exp(" + p + "*s)/" + p + "-" + power + "/" +
                                    p + "^2)+" + h_t + "*" + power + "/" + p + ")-(" + w + "-1)") +
                         test::set("p = 1; Ground/Profile = exp(1.2*x); expression; Constants = b={}, E={}", beta, E);
  const double at_end = 1. + E * std::sin(1.) * std::sin(1.), expected = 0.5 * (at_end - 1.) + h(at_end);
  expect_near(displacement(scene), expected, 2e-6);
  EXPECT_LT(expected, 0.); // the sticky end holds less of the body back... and pulls it
}

/// A standing contraction at a = 0 goes nowhere on a ground like any other, and to +s where backward motion is held.
TEST(GeneralScenes, DirectionOfTheGround)
{
  const Settings standing = expression("0.4*sin(2*pi*t)^2*s*(1-s)*4") + Settings{{"Body/Anchoring exponent", "1"}};
  EXPECT_NEAR(displacement(standing + petsc), 0., 1e-12);
  const auto with_ratio = [&](const double ratio, const double gamma) {
    return displacement(
      standing + test::set("gamma = {}; Ground/Backward ratio = {}; Ground/Switching velocity = 0.2", gamma, ratio));
  };
  const double forward = with_ratio(4., 1.);
  EXPECT_GT(forward, 1e-3);
  // Seen in a mirror the ground has the reverse ratio, and its resistance to backward motion for its coefficient.
  expect_near(with_ratio(0.25, 4.), -forward, 1e-5);
}

/// Everything at once, with other integrators.
TEST(GeneralScenes, IntegratorsAgree)
{
  const Settings all =
    feedback("0.2*sin(2*pi*(s+t))*s*(1-s)*4-0.1*(w-1)+0.05*w_t+0.1*(w_near-1)-0.05*(w_delayed-1)", 0.5, 0.25) +
    test::set("Body/Elastic modulus profile = 1+0.3*s; Body/Friction profile = 1.2-0.3*s; "
              "Body/Initial stretch = 1+0.05*sin(pi*s)^2; Ground/Profile = 1+0.2*tanh(x); "
              "Ground/Friction law = expression; Ground/Expression = 0.3+0.7/w^1.5; "
              "Ground/Backward ratio = 2; Ground/Switching velocity = 0.2");
  const Settings fine    = {{"Discretization/Number of cells", "16"}, {"Time/Tolerance", "1e-9"}};
  const double reference = displacement(all + fine);
  for (const Settings &other :
       {fine + Settings{{"Time/Integrator", "bdf"}}, fine + Settings{{"Time/Integrator", "radau 9"}}})
    expect_near(displacement(all + other), reference, 1e-5);
}

TEST(GeneralScenes, LawsThatAreNotPositiveEndTheRunWithTheirName)
{
  const auto message = [](const Settings &settings) {
    const auto result = test::run_with(settings).result;
    EXPECT_EQ(result.time.status, Status::failed);
    EXPECT_EQ(result.time.reason, "law_not_positive");
    return result.time.message;
  };
  const Settings wave = test::wave(-1., 0.3);
  EXPECT_NE(message(wave + Settings{{"Ground/Friction law", "expression"}, {"Ground/Expression", "1.15-w"}})
              .find("friction law"),
            std::string::npos);
  EXPECT_NE(message(wave + Settings{{"Ground/Profile", "1.01-x"}}).find("profile of the ground"), std::string::npos);
  const test::TemporaryFolder folder; // one for each rank
  const std::string file = (folder.path / "ground.csv").string();
  std::ofstream(file) << "x,value\n0,1\n0.3,1.3\n0.6,1.6\n1,2\n";
  EXPECT_NE(message(wave + Settings{{"Ground/Profile", file}, {"Ground/Outside", "error"}}).find("is not known at x"),
            std::string::npos);
}

namespace
{
  /// Both forms, each with its own meshes and steps; the stretch form says how far it can be from the truth.
  void
  expect_forms_agree(const std::string &name, const Settings &scene, const std::string &accuracy = "1e-4")
  {
    const auto position = run(scene + Settings{{"Discretization/Formulation", "position"}, {"Accuracy", "1e-7"}}),
               stretch =
                 run(scene + stretch_form + Settings{{"Accuracy", accuracy}, {"Time/Maximum number of steps", "20000"}},
                     /*max_residual=*/1e-4);
    EXPECT_EQ(position.process.formulation, Formulation::position) << name;
    EXPECT_EQ(stretch.process.formulation, Formulation::stretch) << name;
    ASSERT_TRUE(stretch.error) << name;
    EXPECT_NEAR(
      stretch.displacement, position.displacement, stretch.error->total + 1e-7 * std::abs(position.displacement))
      << name;
    EXPECT_LE(stretch.error->total, 1.001 * std::stod(accuracy) * std::abs(stretch.displacement)) << name;
  }
} // namespace

/// Each law that both forms can have, and all of them together.
TEST(GeneralScenes, FormsAgree)
{
  const Settings wave                                            = expression(wave_formula);
  const std::vector<std::pair<std::string, Settings>> one_by_one = {
    {"elastic modulus", {{"Body/Elastic modulus profile", "1+0.5*s"}}},
    {"friction profile", {{"Body/Friction profile", "1.2-0.6*s"}}},
    {"initial stretch", {{"Body/Initial stretch", "1+0.2*sin(pi*s)^2*s"}}},
    {"friction law", {{"Ground/Friction law", "expression"}, {"Ground/Expression", "0.3+0.7/w^1.5"}}},
    {"growing friction law", {{"Ground/Friction law", "expression"}, {"Ground/Expression", "0.3+0.7*w^1.5"}}},
    {"direction", {{"Ground/Backward ratio", "3"}, {"Ground/Switching velocity", "0.2"}}},
  };
  Settings all;
  for (const auto &[name, settings] : one_by_one)
  {
    expect_forms_agree(name, wave + settings);
    if (name != "growing friction law" && name != "direction")
      all = all + settings;
  }
  for (const std::string formula :
       {"-0.3*(w-1)", "+0.2*(w-1)^2", "+0.1*w_t", "+0.05*w_t*w", "+0.02*w_t+0.02*tanh(w_t)*w"})
    expect_forms_agree(formula, feedback(wave_formula + formula));
  expect_forms_agree("all but direction", all + feedback(wave_formula + "-0.2*(w-1)+0.05*w_t*w"));
  const Settings direction = one_by_one.back().second;
  expect_forms_agree("all but rate", all + direction + feedback(wave_formula + "-0.2*(w-1)"));
}

/// Viscosity on a ground that holds more in one direction is for the position form.
TEST(GeneralScenes, ViscosityAndDirectionAreForThePositionForm)
{
  const Settings scene = feedback(wave_formula + "+0.05*w_t") +
                         Settings{{"Ground/Backward ratio", "3"}, {"Ground/Switching velocity", "0.2"}};
  EXPECT_THROW(run(scene + stretch_form), InputError);
  EXPECT_EQ(run(scene + Settings{{"Accuracy", "1e-4"}}, /*max_residual=*/1e-3).process.formulation,
            Formulation::position);
}
