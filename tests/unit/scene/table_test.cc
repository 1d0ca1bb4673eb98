// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The generator "table"; reading and interpolating are in base/grid_table_test.cc.
#include "../../support/grid_text.h"
#include "../../support/hdf5_file.h"
#include "../../support/stress.h"
#include "../../support/temporary_folder.h"
#include "../../support/test.h"

#include <crawler/scene/active_stress/optimal_wave.h>
#include <crawler/scene/active_stress/table.h>

using namespace crawler;
using test::values;

namespace
{
  using std::numbers::pi;

  /// A file with samples of f at n_s x n_t points over 0..length and from..to.
  class Samples
  {
  public:
    Samples(const unsigned int n_s,
            const unsigned int n_t,
            const std::function<double(double, double)> &f,
            const double length = 1.,
            const double from   = 0.,
            const double to     = 1.)
    {
      const auto grid = test::samples(equal_parts(0., length, n_s - 1), equal_parts(from, to, n_t - 1), f);
      csv             = (folder_.path / "m.csv").string();
      write_file(csv, test::joined(test::rows_of(grid)));
      hdf5 = (folder_.path / "m.h5").string();
      test::write_hdf5_file(hdf5, {{"s", {n_s}, grid.s}, {"t", {n_t}, grid.t}, {"m", {n_t, n_s}, grid.values}});
    }

    std::string csv, hdf5;

  private:
    const test::TemporaryFolder folder_;
  };

  double
  wave_of(const double s, const double t)
  {
    return 0.1 * std::sin(2. * pi * (s + t));
  }

  /// What is wrong, with the name of the file left out.
  std::string
  complaint(const Samples &samples, TableParameters parameters, const std::string &entry)
  {
    parameters.file     = samples.csv;
    std::string message = test::complaint_of([&]() { ActiveStressTable(parameters, 1., 1.); });
    if (entry.empty())
      return message;
    EXPECT_TRUE(message.starts_with("Active stress/Table/" + entry + ": ")) << message;
    message.erase(0, message.find(": ") + 2);
    return message.replace(message.find("\"" + samples.csv + "\""), samples.csv.size() + 2, "FILE");
  }
} // namespace

/// Fig. S1 at chi = 0.4 (doc/theory.md, "Reference numbers") from 65 x 129 samples of its wave; and both kinds of file
/// are the same to the last bit.
TEST(Table, OfTheOptimalWaveMovesTheBodyAsTheWaveDoes)
{
  Body body;
  body.anchoring_exponent = 2.;
  const OptimalWave wave({.perturbation_parameter = 0.4, .choose_wave_by = "wave speed"}, body, 1.);
  const Samples samples(65, 129, [&](const double s, const double t) { return values(wave, {s}, t)[0]; });
  const auto displacement = [&](const std::string &file) {
    return test::run_with(test::set("p = 2; Accuracy = 1e-7; table; File = {}", file)).result.displacement;
  };
  constexpr double reference = 9.0072529800e-2;
  const double by_csv        = displacement(samples.csv);
  EXPECT_NEAR(by_csv / reference, 1., 1e-6);
  EXPECT_EQ(by_csv, displacement(samples.hdf5));
}

/// m in mN over millimetres and milliseconds, say.
TEST(Table, Units)
{
  const Samples samples(
    9, 9, [](const double s, const double t) { return s * s / 10. + t / 100.; }, 10., 0., 2000.);
  const ActiveStressTable table(
    {.file = samples.csv, .unit_of_s = 0.1, .unit_of_t = 1e-3, .unit_of_m = -2.}, /*length=*/1., /*end_time=*/2.);
  const auto expected = [](const double s, const double t) { return -2. * (100. * s * s / 10. + 1000. * t / 100.); };
  const std::vector<double> points = {0., 0.33, 1.};
  std::vector<double> rate(3);
  for (const double t : {0.1, 1.3})
  {
    const auto m = values(table, points, t);
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_NEAR(m[i], expected(points[i], t), 1e-12);
    table.rate_at(points)->values(t, rate);
    for (const double m_t : rate)
      EXPECT_NEAR(m_t, -20., 1e-11);
  }
}

TEST(Table, PeriodIsFound)
{
  const auto period_of = [](const Samples &samples, const std::string &outside) {
    return ActiveStressTable({.file = samples.csv, .outside = outside}, 1., 1.).period();
  };
  const Samples one(5, 13, wave_of);
  EXPECT_EQ(period_of(one, "error"), std::nullopt);
  EXPECT_EQ(period_of(one, "periodic"), 1.);
  // Three strides in the table.
  const Samples three(5, 13, [](const double s, const double t) { return wave_of(s, 3. * t); });
  EXPECT_NEAR(period_of(three, "periodic").value(), 1. / 3., 1e-15);
  // A stride of 0.5 that begins at t = -0.2, in a run of T = 1.
  const Samples later(
    5, 9, [](const double s, const double t) { return wave_of(s, 2. * t); }, 1., -0.2, 0.3);
  const ActiveStressTable table({.file = later.csv, .outside = "periodic"}, 1., 1.);
  EXPECT_NEAR(table.period().value(), 0.5, 1e-15);
  for (const double t : {0.01, 0.3, 0.77})
    EXPECT_NEAR(values(table, {0.25}, t)[0], wave_of(0.25, 2. * t), 2e-3);
}

/// Kinks of linear interpolation, knots of a spline with few, and where a table that is held begins and ends.
TEST(Table, Breaks)
{
  using List = std::vector<double>;
  const Samples samples(5, 5, wave_of);
  const ActiveStressTable linear({.file = samples.csv, .interpolation = "linear"}, 1., 1.);
  EXPECT_EQ(linear.breaks_in_space(), (List{0.25, 0.5, 0.75}));
  EXPECT_EQ(linear.breaks_in_time(), (List{0.25, 0.5, 0.75}));
  const ActiveStressTable cubic({.file = samples.csv}, 1., 1.);
  EXPECT_EQ(cubic.breaks_in_space(), (List{0.25, 0.5, 0.75}));
  EXPECT_EQ(cubic.breaks_in_time(), List());
  const ActiveStressTable held({.file = samples.csv, .outside = "hold", .outside_in_s = "hold"}, 2., 3.);
  EXPECT_EQ(held.breaks_in_space(), (List{0.25, 0.5, 0.75, 1.}));
  EXPECT_EQ(held.breaks_in_time(), List{1.});
  const ActiveStressTable repeated({.file = samples.csv, .interpolation = "linear", .outside = "periodic"}, 1., 1.6);
  EXPECT_EQ(repeated.breaks_in_time(), (List{0.25, 0.5, 0.75, 1., 1.25, 1.5}));
  const ActiveStressTable fine({.file = Samples(300, 5, wave_of).csv, .interpolation = "linear"}, 1., 1.);
  EXPECT_EQ(fine.breaks_in_space(), List());
  EXPECT_EQ(ActiveStressTable({.file = Samples(40, 5, wave_of).csv}, 1., 1.).breaks_in_space(), List());
}

TEST(Table, SaysWhatIsWrong)
{
  const Samples small(3, 5, wave_of), good(5, 5, wave_of), high(5, 5, wave_of, 100.), late(5, 5, wave_of, 1., 2., 3.),
    twice(5, 5, wave_of, 1., 0., 0.3);
  EXPECT_EQ(complaint(good, {}, ""), "nothing");
  EXPECT_EQ(complaint(small, {}, "File"), "FILE has 3 different values of s, but at least 4 are expected");
  EXPECT_EQ(complaint(small, {.interpolation = "linear"}, ""), "nothing");
  EXPECT_EQ(complaint(good, {.unit_of_s = 0.5}, "Outside in s"),
            "FILE has s from 0 to 0.5, but the whole body, from 0 to 1, is expected");
  EXPECT_EQ(complaint(good, {.unit_of_t = 0.5}, "Outside"),
            "FILE has t from 0 to 0.5, but the whole duration, from 0 to 1, is expected");
  // Times in single precision may end a millionth too early.
  EXPECT_EQ(complaint(good, {.unit_of_t = 1. - 0.9e-6}, ""), "nothing");
  EXPECT_EQ(complaint(good, {.unit_of_t = 0.999997}, "Outside"),
            "FILE has t from 0 to 0.999997, but the whole duration, from 0 to 1, is expected");
  EXPECT_EQ(
    complaint(late, {.outside = "hold"}, "File"),
    "FILE has t from 2 to 3, none of it between 0 and 1, where it is needed; check \"Active stress/Table/Unit of "
    "t\"");
  EXPECT_EQ(
    complaint(twice, {.outside = "periodic"}, "Outside"),
    "FILE has m = 0 at s = 0, t = 0 but m = 0.0951057 at its last time, t = 0.3; equal values are expected, the "
    "period being the difference of these times (\"crawler table IN OUT --period whole\" closes it within the noise)");
}
