// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The generator "prescribed strain": its stress, its three sources of strain, and what it refuses; and the pieces that
// it is made of (Gauss panels).
#include "../../support/complaint.h"
#include "../../support/grid_text.h"
#include "../../support/run_text.h"
#include "../../support/temporary_folder.h"
#include "../../support/test.h"

#include <crawler/accuracy/model_choice.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/gauss_panels.h>
#include <crawler/scene/active_stress/prescribed_strain.h>

using namespace crawler;

namespace
{
  using std::numbers::pi;

  test::Settings
  strain(const std::string &formula)
  {
    return test::set("prescribed strain; Strain = {}", formula);
  }

  /// What is wrong with these settings.
  std::string
  complaint(const test::Settings &settings)
  {
    return test::complaint_of([&]() {
      const Parameters parameters = test::parameters_with(settings);
      choose_model(parameters, parameters.create_scene());
    });
  }

  /// A grid of n x n samples.
  std::string
  grid(const unsigned int n, double (*f)(double s, double t))
  {
    const auto places = equal_parts(0., 1., n - 1);
    return test::joined(test::rows_of(test::samples(places, places, f)), "s,t,strain\n");
  }

  double
  wave_of(const double s, const double t)
  {
    return 0.3 * (std::sin(2. * pi * (s + t)) - std::sin(2. * pi * s));
  }
} // namespace

/// Eight points integrate degree 15 exactly, and running integrals are exact for degree 7.
TEST(GaussPanels, AreExactForPolynomials)
{
  for (const GaussPanels &panels : {GaussPanels(0.5, 2., 3), GaussPanels({0.5, 0.6, 1.3, 2.})})
  {
    std::vector<double> f, g, running(panels.points().size()), at(4), transposed(running.size());
    for (const double x : panels.points())
    {
      f.push_back(std::pow(x, 15));
      g.push_back(std::pow(x, 7));
    }
    EXPECT_NEAR(panels.integral(f), (std::pow(2., 16) - std::pow(0.5, 16)) / 16., 1e-11);
    panels.running_integral(g, running);
    for (std::size_t i = 0; i < running.size(); ++i)
      EXPECT_NEAR(running[i], (std::pow(panels.points()[i], 8) - std::pow(0.5, 8)) / 8., 1e-13);
    panels.running_integral_transposed(f, transposed);
    EXPECT_NEAR(std::inner_product(f.begin(), f.end(), running.begin(), 0.),
                std::inner_product(g.begin(), g.end(), transposed.begin(), 0.),
                1e-13 * std::inner_product(f.begin(), f.end(), running.begin(), 0.));
    const std::vector<double> places = {0.5, 0.6, 1.234, 2.};
    GaussPanels::Places(panels, places).running_integral(g, at);
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_NEAR(at[i], (std::pow(places[i], 8) - std::pow(0.5, 8)) / 8., 1e-12);
  }
}

/// A wave, and a table of it, are the formula.
TEST(PrescribedStrain, WaveAndTable)
{
  const Scene by_formula = test::parameters_with(strain("0.05 + 0.2*sin(2*pi*1.5*(s - 0.7*t) + 0.3)")).create_scene();
  const Scene by_wave =
    test::parameters_with(test::set("prescribed strain; Given by = wave; Mean strain = 0.05; Amplitude = 0.2; Wave "
                                    "number = 1.5; Wave speed = -0.7; Phase = 0.3"))
      .create_scene();
  const std::vector<double> points = {0., 0.123, 0.5, 1.};
  std::vector<double> a(4), b(4);
  const ActiveStress &formula = *by_formula.active_stress->prescribed_strain(),
                     &wave    = *by_wave.active_stress->prescribed_strain();
  formula.at(points)->values(0.4, a);
  wave.at(points)->values(0.4, b);
  for (unsigned int i = 0; i < 4; ++i)
    EXPECT_NEAR(a[i], b[i], 1e-14);
  formula.rate_at(points)->values(0.4, a);
  wave.rate_at(points)->values(0.4, b);
  for (unsigned int i = 0; i < 4; ++i)
    EXPECT_NEAR(a[i], b[i], 1e-12);
}

TEST(StrainTable, MustCoverBodyAndDurationWithFourSamplesAtLeast)
{
  const test::TemporaryFolder folder;
  const std::string name = (folder.path / "strain.csv").string();
  write_file(name, grid(5, wave_of));
  const test::Settings table = test::set("prescribed strain; Given by = table; File = {}", name);
  EXPECT_EQ(complaint(table), "nothing");
  test::expect_words(complaint(test::with(table, "L = 2")), {"the whole body"});
  test::expect_words(complaint(test::with(table, "T = 1.5")), {"the whole duration"});
  write_file(name, grid(3, wave_of)); // too few for a spline
  test::expect_words(complaint(table), {"at least 4"});
}

TEST(PrescribedStrain, SaysWhatIsWrong)
{
  const std::vector<std::pair<std::string, std::string>> refused = {
    {"1/(s-0.5)/0*t", "the formula \"1/(s-0.5)/0*t\" gives"},
    {"0.1*t*(s-1/160)/(s-1/160)", "the strain is"}, // at places that only the search for extremes looks at
    {"0.1*s*floor(3*t)",
     "the strain at s = 1 changes by 0.1 from t = 0.324324 to 0.351351, "
     "but the integral of its rate is 0; a strain without jumps"},
    {"0.1*s*(t < 0.31 ? 1 : 0.99)*abs(sin(7*t))", "a strain without jumps"}, // beside kinks
    {"sn(s)", "error in the formula \"sn(s)\" at position 1"},
    {"", "the formula of the strain is empty"},
  };
  for (const auto &[formula, words] : refused)
    test::expect_words(complaint(strain(formula)), {words});
  EXPECT_EQ(complaint(strain("0.3*(sin(2*pi*(s+t)) - sin(2*pi*s))")), "nothing");
  // The nonlinear model starts from rest; the kinematic one does not.
  EXPECT_EQ(complaint(test::with(strain("0.3*sin(2*pi*(s+t))"), "Model = kinematic")), "nothing");
}
