// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/derivative.h"
#include "../../support/expect_near.h"
#include "../../support/stress.h"
#include "../../support/temporary_folder.h"
#include "../../support/test.h"

#include <crawler/base/exceptions.h>
#include <crawler/formula/formula_gradient.h>
#include <crawler/scene/active_stress/formula_input.h>

using namespace crawler;

namespace
{
  void
  expect_message(const test::Settings &settings, const std::string &entry, const std::string &part)
  {
    test::expect_complaint(settings, {entry + ": ", part});
  }

  class ProfileFile : public testing::Test
  {
  protected:
    std::string
    file(const std::string &content)
    {
      const auto path = folder.path / "profile.csv";
      write_file(path, content);
      return path.string();
    }
    std::shared_ptr<const Profile>
    table(const std::string &content, const std::string &interpolation, const std::string &outside = "hold")
    {
      return read_profile(
        {{"profile", file(content), "", "Ground/Profile", "", {"x"}}, interpolation, outside}, 1., 1.);
    }
    test::TemporaryFolder folder;
  };
} // namespace

/// The derivative of a formula with respect to each of its variables, with every operator and function, against
/// differences.
TEST(FormulaGradient, MatchesDifferences)
{
  for (const std::string text : {"s*w^2*sin(t)+exp(-w_t)*w+(w_t>0 ? w_near*w : w_near^3)+max(w,2*w_t)",
                                 "s*t + t^2 - 3*t/(s+2) + -t",
                                 "sin(t*s) + cos(3*t) + tan(t/3)",
                                 "asin(t/2) - acos(t*s/3) + atan(t) + atan2(t, s+1)",
                                 "sinh(t) + cosh(s*t) + tanh(t-s) + asinh(t) + acosh(t+2) + atanh(t/3)",
                                 "log(t+1) + ln(t+s+1) + log2(t+1) + log10(t+2) + exp(-t^2) + sqrt(t+s+1)",
                                 "abs(t-1) + abs(t) + sign(t)*t + floor(7*t) + ceil(t) + rint(9*t)",
                                 "t^3 + t^4 + 2*t+1 + s^t + t^s + pow(t, 2.5) + 2^t",
                                 "mod(3*t, 0.71) + erf(t) + erfc(t*s)",
                                 "min(t, s, 2) + max(t*s, 0.1) + sum(t, s, t^2) + avg(t, 3*t)",
                                 "t > 0.9 ? sin(t) : cos(t)",
                                 "(t > 0.9 || s < 0.1) && t < 2 ? t^2 : (t == 3 ? 1 : t*s)"})
  {
    const auto formula = read_formula({"m", text, "", "f", "c", {"s", "t", "w", "w_t", "w_near"}}, 1., 1.);
    FormulaGradient gradient(formula);
    constexpr std::size_t n = 100; // more than one block
    std::vector<std::vector<double>> x(5, std::vector<double>(n));
    for (std::size_t v = 0; v < 5; ++v)
      for (std::size_t i = 0; i < n; ++i)
        x[v][i] = 0.9 + 0.5 * std::sin(3. * static_cast<double>(v) + 0.7 * static_cast<double>(i));
    for (std::size_t v = 0; v < 5; ++v)
    {
      if (!formula->uses(v))
        continue;
      std::vector<double> slope(n);
      const auto moved = [&](const double step) {
        auto shifted = x;
        for (double &value : shifted[v])
          value += step;
        std::vector<double> f(n);
        std::vector<std::span<const double>> arguments(shifted.begin(), shifted.end());
        std::vector<std::span<double>> derivatives(5);
        if (step == 0.)
          derivatives[v] = slope;
        gradient.evaluate(arguments, f, derivatives);
        return f;
      };
      moved(0.);
      test::expect_near(slope, test::derivative(moved), 1e-8, text + ", variable " + std::to_string(v));
    }
  }
}

TEST_F(ProfileFile, InterpolatesAndHolds)
{
  // The exponential of a cubic polynomial is reproduced by the spline of logarithms, with its slope.
  const auto cubic_of = [](const double x) { return std::exp(0.5 + x - 0.5 * x * x + 0.3 * x * x * x); };
  std::string rows    = "x,value\n";
  for (const double x : {0., 0.3, 0.5, 1.1, 2.})
    rows += to_text(x) + "," + to_text(cubic_of(x)) + "\r\n";
  const auto cubic = table(rows, "cubic");
  for (const double x : {0., 0.4, 1.9})
  {
    double f = 0., slope = 0.;
    cubic->values({&x, 1}, {&f, 1}, {&slope, 1});
    EXPECT_NEAR(f, cubic_of(x), 2e-13);
    EXPECT_NEAR(slope, (1. - x + 0.9 * x * x) * f, 1e-12);
  }
  const auto linear = table("x,value\n0,1\n\n1,3\n", "linear");
  EXPECT_DOUBLE_EQ(linear->value(0.25), 1.5);
  EXPECT_EQ(linear->value(-7.), 1.);
  EXPECT_EQ(linear->value(7.), 3.);
  EXPECT_TRUE(std::isnan(table("x,value\n0,1\n1,3\n", "linear", "error")->value(1.1)));
  // Units of the places do not change the profile.
  const auto scaled = in_units(linear, 10.);
  const double x    = 0.025;
  double f = 0., slope = 0.;
  scaled->values({&x, 1}, {&f, 1}, {&slope, 1});
  EXPECT_DOUBLE_EQ(f, 1.5);
  EXPECT_DOUBLE_EQ(slope, 20.);
}

/// A list has its values at places that are equally spaced along the body; steep ones do not become negative between.
TEST_F(ProfileFile, AListIsATableOverTheBody)
{
  for (const char *interpolation : {"cubic", "linear"})
  {
    const auto of_list =
      read_profile({{"profile", "2, 0.001, 0.001, 3", "", "Body/X", "", {"s"}}, interpolation}, 1.5, 1.);
    const auto of_file = table("x,value\n0,2\n0.5,0.001\n1,0.001\n1.5,3\n", interpolation);
    for (double s = 0.; s <= 1.5; s += 0.01)
    {
      EXPECT_NEAR(of_list->value(s), of_file->value(s), 1e-14);
      EXPECT_GT(of_list->value(s), 0.);
    }
  }
}

TEST_F(ProfileFile, BadFilesAreNamedWithTheirRow)
{
  const auto expect = [&](const std::string &content, const std::string &part) {
    expect_message(
      {{"Ground/Profile", file(content)}, {"Ground/Profile interpolation", "linear"}}, "Ground/Profile", part);
  };
  expect("s,value\n0,1\n1,1\n", "the header x,value is expected");
  expect("x,value\n0,1\n1,two\n", "row 3 ");
  expect("x,value\n0,1\n1\n", "row 3 ");
  expect("x,value\n0,1\n1,-1\n", "positive number is expected");
  expect("x,value\n0,1\n0,2\n", "increasing numbers are expected");
  expect("x,value\n0,1\n", "at least 2 are expected");
  expect_message({{"Ground/Profile", "nowhere.csv"}}, "Ground/Profile", "cannot read");
}

TEST(GeneralInput, IsCheckedInOneSentence)
{
  expect_message(
    {{"Body/Elastic modulus profile", "1-2*s"}}, "Body/Elastic modulus profile", "positive number is expected");
  expect_message(
    {{"Body/Friction profile", "1/(s-0.5)^0"}, {"Body/Initial stretch", "s"}}, "Body/Initial stretch", "at s = 0");
  expect_message({{"Ground/Profile", "1+t"}}, "Ground/Profile", "position 3");
  expect_message({{"Ground/Profile", "1, 1, 1, 1"}}, "Ground/Profile", "several, separated by a comma");
  expect_message({{"Body/Friction profile", "1, 2, 3"}}, "Body/Friction profile", "at least 4 are expected");
  expect_message({{"Body/Friction profile", "1, 2, 0, 1"}}, "Body/Friction profile", "number 3 of");
  expect_message({{"Body/Friction profile", "1+g*s"}}, "Body/Friction profile", "\"Body/Constants\", like g=1");
  expect_message({{"Body/Friction profile", "1+g*s"}, {"Body/Constants", "g"}}, "Body/Constants", "name=number");
  expect_message(
    {{"Ground/Friction law", "expression"}, {"Ground/Expression", "w-1"}}, "Ground/Expression", "positive");
  expect_message(
    {{"Ground/Friction law", "expression"}, {"Ground/Expression", ""}}, "Ground/Expression", "expression of w");
  expect_message({{"Ground/Backward ratio", "2"}}, "Ground/Backward ratio", "a velocity is expected");
  expect_message({{"Ground/Profile", "1+x"}, {"Model", "kinematic"}}, "Model", "Ground/Profile");
  expect_message({{"Ground/Profile", "1+x"}, {"Time/Cycle stop", "on"}, {"Output/Number of snapshots", "0"}},
                 "Time/Cycle stop",
                 "Ground/Profile");
  const auto feedback = [](const std::string &formula) {
    return test::set("strain feedback; Active stress = {}", formula);
  };
  const std::string section = "Active stress/Strain feedback/";
  expect_message(feedback("w_neer"), section + "Active stress", "nearest name is \"w_near\"");
  expect_message(feedback("w_near"), section + "Distance", "other than 0");
  expect_message(feedback("w_delayed"), section + "Delay", "at least");
  expect_message(feedback("log(w-1)"), section + "Active stress", "finite number is expected");
  EXPECT_EQ(test::complaint(feedback("w_t*(w-1)")), "nothing");
  // Ill-posed: k + dm/dw < 0 without a viscosity, or a negative viscosity, at the initial state.
  const std::string generator = "Active stress/Generator";
  expect_message(feedback("-1.01*(w-1)"), generator, "with respect to w is -1.01, but -k, -1, or more");
  expect_message(feedback("-1.5*(w_near-1); Distance = 0.2"), // the end sees itself
                 generator,
                 "at s = 1, t = 0 the derivative of the active stress with respect to w (and to w_near at an "
                 "end that sees itself) is -1.5");
  expect_message(feedback("-0.1*w_t"), generator, "with respect to w_t is -0.1, but 0 or a positive number");
  for (const char *well_posed : {"-0.99*(w-1)",
                                 "-2*(w-1)+0.1*w_t",
                                 "-2*max(0,w-1)",
                                 "-2*(w-1)*t",
                                 "-0.1*w_t*abs(w_t)",
                                 "-0.9*(w_near-1); Distance = -0.2",
                                 "-1.5*(w_near-1); Sensor length = 0.1"})
    EXPECT_EQ(test::complaint(feedback(well_posed)), "nothing") << well_posed;
  expect_message(test::with(feedback("-0.5*(w-1)"), "Body/Elastic modulus profile = 1-0.6*s"),
                 generator,
                 "with respect to w is -0.5, but -k, -0.4");
  EXPECT_EQ(test::complaint(feedback("-0.6*(w-1)^2")), "nothing");
  expect_message(test::with(feedback("-0.6*(w-1)^2"), "Body/Initial stretch = 2"),
                 generator,
                 "with respect to w is -1.2, but -k, -1");
  expect_message(feedback("w_near; Sensor length = 1.5"), section + "Sensor length", "from 1e-06 to 1");
  expect_message(feedback("w_near; Sensor length = 1e-9"), section + "Sensor length", "from 1e-06 to 1");
  EXPECT_EQ(test::complaint(feedback("w_near; Sensor length = 0.3")), "nothing");
}
