// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The extremes of what can be asked for: each ends in the right outcome, under its name, with the right number.
#include "../support/answers.h"
#include "../support/test.h"

#include <crawler/base/exceptions.h>

using namespace crawler;
using test::with;

namespace
{
  /// The displacement of Fig. S1 with chi = 0.4 (doc/theory.md, section 5).
  constexpr double fig_s1 = 9.0072529800e-2;
  /// That of a = +1, c = -1, whose mirror image is c = 1.
  constexpr double prograde = -8.1377661410e-2;
} // namespace

/// Exponents, moduli and collapses of an independent solver (contrib/reference/extremes.py), with the automatic choice
/// of form and mesh: a run ends as the body does, with the displacement, or the time of the inversion, that it says.
TEST(Extremes, ThoseOfAnIndependentSolver)
{
  const auto words = [](const nlohmann::json &numbers) {
    std::string text;
    for (const double number : numbers)
      text += (text.empty() ? "" : ", ") + test::text(number);
    return text.empty() ? "0" : text;
  };
  std::ifstream file(CRAWLER_SOURCE_DIR "/contrib/reference/extremes.json");
  const auto rows = nlohmann::json::parse(file)["rows"];
  EXPECT_FALSE(rows.empty());
  for (const auto &row : rows)
  {
    const auto name             = row["name"].get<std::string>();
    const auto [result, choice] = test::run_with(
      test::with(test::wave(row["exponent"], row["chi"], row["speed"], row["end_time"], row["elastic_modulus"]),
                 "Accuracy = 1e-3; optimal wave; Sine coefficients = {}; Cosine coefficients = {}",
                 words(row["sine"]),
                 words(row["cosine"])));
    if (row.contains("inversion") && !row["inversion"].is_null())
    {
      ASSERT_TRUE(result.inversion) << name;
      EXPECT_NEAR(result.inversion->t, row["inversion"]["t"].get<double>(), 1e-3 * row["end_time"].get<double>())
        << name;
      continue;
    }
    EXPECT_EQ(result.time.status, Status::finished) << name;
    EXPECT_NEAR(
      result.displacement, row["displacement"].get<double>(), choice.wanted_error + row["error"].get<double>())
      << name;
  }
}

/// One cell of degree 1 has one stretch, so net friction = 0 means that its middle stays where it is. One of degree 8
/// resolves a wave as long as the body. A mesh with layers has four cells at least.
TEST(Extremes, OneCell)
{
  for (const std::string formulation : {"position", "stretch"})
    for (unsigned int degree = 1; degree <= (formulation == "position" ? 8u : 1u); ++degree)
    {
      const auto result = test::run_with(with(test::wave(-1., 0.1),
                                              "degree = {}; cells = 1; Discretization/Formulation = {}; "
                                              "Discretization/Mesh = uniform; tolerance = 1e-10",
                                              degree,
                                              formulation))
                            .result;
      ASSERT_EQ(result.time.status, Status::finished) << formulation << degree;
      EXPECT_LT(result.residuals.net_friction, 1e-11) << formulation << degree;
      EXPECT_LT(result.energy_balance->residual(), 1e-6) << formulation << degree;
      const double expected = degree == 1 ? 0. : 5.020242991e-3, error = degree == 1 ? 1e-15 : 5e-7;
      if (degree == 1 || degree == 8)
      {
        EXPECT_NEAR(result.displacement, expected, error) << formulation << degree;
      }
    }
}

/// With the same time steps a million cells and a few of high degree give the same up to the error in space, which is
/// that of a thousand cells divided by 1000^2 (degree 1), and to rounding.
TEST(Extremes, AMillionCells)
{
  const auto displacement = [](const char *degree, const char *cells) {
    const auto result =
      test::run_with(with(test::wave(-1., 0.4, 1., 0.05),
                          "degree = {}; cells = {}; Time/Step control = fixed; Time/Initial step = 0.025",
                          degree,
                          cells),
                     {.energy_balance = false})
        .result;
    EXPECT_EQ(result.time.status, Status::finished);
    EXPECT_EQ(result.time.steps, 2u);
    return result.displacement;
  };
  const double exact = displacement("8", "10");
  EXPECT_NEAR(displacement("1", "1000000") / exact, 1., 1e-9);
}

/// Time steps and tolerances of the user's own. What finishes has the right number, or its energy balance would tell.
TEST(Extremes, StepsAndTolerances)
{
  struct Case
  {
    test::Settings settings;
    std::string outcome; ///< status and reason
    double error = 0.;   ///< of the displacement, relative
  };
  const std::vector<Case> cases = {
    {{{"Time/Tolerance", "1e-99"}}, "failed step_underflow"},
    {{{"Time/Tolerance", "1e-30"}}, "failed step_underflow"},
    {{{"Time/Tolerance", "1e-16"}}, "finished ", 1e-6},
    {{{"Time/Tolerance", "1e10"}}, "finished ", 5e-3},
    {{{"Time/Tolerance", "1e99"}}, "finished ", 5e-3},
    {{{"Time/Initial step", "1e-99"}}, "finished ", 1e-6},
    {{{"Time/Initial step", "1e-30"}}, "finished ", 1e-6},
    {{{"Time/Initial step", "1"}}, "finished ", 1e-6},
    {{{"Time/Initial step", "1e-30"}, {"Time/Step control", "fixed"}}, "failed step_underflow"},
    {{{"Time/Initial step", "1"}, {"Time/Step control", "fixed"}}, "finished ", 2e-2},
    {{{"Time/Maximum number of steps", "1"}}, "stopped step_limit"},
  };
  for (const Case &c : cases)
  {
    const auto [result, choice] = test::run_with(with(test::wave(-1., 0.4), c.settings));
    const std::string name      = c.settings[0].first + " = " + c.settings[0].second;
    EXPECT_EQ(std::string(word_of(result.time.status)) + " " + result.time.reason, c.outcome) << name;
    EXPECT_TRUE(std::isfinite(result.displacement)) << name;
    if (result.time.status == Status::finished)
      EXPECT_NEAR(result.displacement / fig_s1, 1., c.error) << name;
    else
      EXPECT_NE(result.time.message, "") << name;
  }
}

/// Numbers that double precision cannot carry are refused before anything is computed; what is harmless is not.
TEST(Extremes, TinyAndHugeInput)
{
  const std::string wave                 = "Active stress/Optimal wave/";
  const std::vector<std::string> entries = {"Body/Length",
                                            "Body/Elastic modulus",
                                            "Body/Friction coefficient",
                                            "Body/Anchoring exponent",
                                            "Time/End time",
                                            "Time/Tolerance",
                                            "Time/Initial step",
                                            wave + "Perturbation parameter",
                                            wave + "Sine coefficients",
                                            wave + "Wave speed"};
  // Exponents that are 0 or nearly so are not extreme, and a wave without strength leaves the body where it is.
  const std::set<std::pair<std::string, std::string>> harmless = {{"Body/Anchoring exponent", "-0.0"},
                                                                  {"Body/Anchoring exponent", "4e-320"},
                                                                  {"Body/Anchoring exponent", "1e-200"},
                                                                  {wave + "Perturbation parameter", "-0.0"}};
  for (const std::string &entry : entries)
    for (const std::string value : {"-0.0", "4e-320", "1e-200", "1e200", "1e308", "-1e308"})
    {
      const auto settings = with(test::wave(-1., 0.4), {{entry, value}});
      if (!harmless.contains({entry, value}))
      {
        EXPECT_THROW(test::parameters_with(settings).create_scene(), InputError) << entry << " = " << value;
        continue;
      }
      const auto result     = test::run_with(settings).result;
      const double expected = entry == "Body/Anchoring exponent" ? prograde : 0.;
      EXPECT_EQ(result.time.status, Status::finished) << entry << " = " << value;
      EXPECT_NEAR(result.displacement, expected, 1e-6 * std::abs(expected)) << entry << " = " << value;
    }
}

/// The stretch of an end is 1 - m/k: that tells when it is 0, also where friction is so steep that the position form
/// fails shortly before, since the stretch beside the end is tiny.
TEST(Extremes, InversionAtAnEnd)
{
  const auto expect_inversion = [](const test::Settings &settings, const double t) {
    const SimulationResult result = test::answer_to(settings);
    EXPECT_EQ(result.time.status, Status::inverted);
    EXPECT_EQ(result.time.reason, "inverted_at_end") << result.time.message;
    ASSERT_TRUE(result.inversion);
    EXPECT_NEAR(result.inversion->t, t, 1e-9);
    EXPECT_TRUE(result.inversion->s == 0. || result.inversion->s == 1.);
    EXPECT_LE(result.time.time, result.inversion->t);
  };
  for (const char *p : {"-3", "0.5", "1", "1.5", "2", "21"})
  {
    expect_inversion(test::set("p = {}; expression; Active stress = 2*t", p), 0.5);
    // A reflex: 2 t - (w - 1)/2 + w - 1 = 0 has no solution w > 0 from t = 1/4 on.
    expect_inversion(test::set("p = {}; strain feedback; Active stress = 2*t-0.5*(w-1)", p), 0.25);
  }
  expect_inversion(test::set("p = -1; strain feedback; Active stress = 1.1*(1-s)-0.5*(w-1)"), 0.);
  expect_inversion(test::set("p = -1; strain feedback; Active stress = 2*t+0.1*w*log(w)"), 0.5);
  // The force is positive without stretch, too, but 0 at w = 0.93.
  EXPECT_EQ(test::answer_to(test::set("p = -1; strain feedback; Active stress = 1.2*exp(-3*w)*(1+s/5)")).time.status,
            Status::finished);
  const double chi = 1.2;
  expect_inversion(test::wave(-1., chi), (std::numbers::pi + std::asin(1. / chi)) / (2. * std::numbers::pi));
  const double k = 1.065687391169341, amplitude = 1.3692980755928033;
  for (const char *accuracy : {"1e-2", "1e-4"})
    expect_inversion(test::set("p = 3.7742919342516785; k = {}; Accuracy = {}; travelling wave; Amplitude = {}; "
                               "Wave number = 1; Frequency = 1",
                               k,
                               accuracy,
                               amplitude),
                     std::asin(k / amplitude) / (2. * std::numbers::pi));
}
