// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Reading samples on a grid (grid_table.h) and interpolating them (grid_interpolation.h).
#include "../../support/complaint.h"
#include "../../support/grid_text.h"
#include "../../support/hdf5_file.h"
#include "../../support/temporary_folder.h"
#include "../../support/test.h"

#include <crawler/base/grid_interpolation.h>

using namespace crawler;
using test::joined;
using test::rows_of;
using test::samples;

namespace
{
  using std::numbers::pi;

  double
  wave_of(const double s, const double t)
  {
    return std::sin(2. * pi * (s + t)) * std::exp(-s);
  }

  GridTable
  read(const std::string &content)
  {
    const test::TemporaryFolder folder;
    write_file(folder.path / "m.csv", content);
    return read_grid_table((folder.path / "m.csv").string(), "m", 0, "entry");
  }

  /// What is wrong with this file, its name left out.
  std::string
  complaint_about(const std::filesystem::path &file)
  {
    std::string message    = test::complaint_of([&]() { read_grid_table(file.string(), "m", 0, ""); });
    const std::string name = "\"" + file.string() + "\"";
    if (const auto place = message.find(name); place != std::string::npos)
      message.replace(place, name.size(), "FILE");
    return message;
  }

  std::string
  complaint(const std::string &content)
  {
    const test::TemporaryFolder folder;
    write_file(folder.path / "m.csv", content);
    return complaint_about(folder.path / "m.csv");
  }

  void
  expect_same(const GridTable &a, const GridTable &b)
  {
    EXPECT_EQ(a.s, b.s);
    EXPECT_EQ(a.t, b.t);
    EXPECT_EQ(a.values, b.values);
  }

  const std::vector<double> some_s = {0., 0.1, 0.35, 0.7, 1.}, some_t = {-1., 0.25, 0.5, 2.};
} // namespace

/// In any order, with whatever programs put into such files.
TEST(GridTable, ReadsCsv)
{
  const GridTable grid = samples(some_s, some_t, wave_of);
  auto rows            = rows_of(grid);
  expect_same(read(joined(rows)), grid);
  expect_same(read(joined(rows, "\xEF\xBB\xBFs,t,m\r\n", "\r\n")), grid);
  expect_same(read(joined(rows, " s , t, m\n\n", " \n\n")), grid);
  std::mt19937 generator(1);
  std::shuffle(rows.begin(), rows.end(), generator);
  expect_same(read(joined(rows)), grid);
  std::string text = joined(rows);
  text.pop_back(); // the end of the last line
  expect_same(read(text), grid);
  const GridTable numbers = read("s,t,m\n0,+1e-2,.5\n1,0.01,-2E3\n");
  EXPECT_EQ(numbers.t, std::vector<double>{0.01});
  EXPECT_EQ(numbers.values, (std::vector<double>{0.5, -2000.}));
}

/// 0.1 + 0.2 is not 0.3, but the same row of the grid.
TEST(GridTable, RoundOffMakesNoNewRows)
{
  const GridTable grid = read("s,t,m\n0,0,1\n0.3,0,2\n1,0,3\n0,1,4\n0.30000000000000004,1,5\n1,1,6\n");
  EXPECT_EQ(grid.s, (std::vector<double>{0., 0.3, 1.}));
  EXPECT_EQ(grid.values, (std::vector<double>{1., 2., 3., 4., 5., 6.}));
}

TEST(GridTable, SaysWhatIsWrongInCsv)
{
  const std::string three = "but three numbers s,t,m are expected";
  EXPECT_EQ(complaint("s,t,strain\n"), "the first row of FILE is \"s,t,strain\", but the header s,t,m is expected");
  EXPECT_EQ(complaint("0,0,1\n"), "the first row of FILE is \"0,0,1\", but the header s,t,m is expected");
  EXPECT_EQ(complaint("s;t;m\n0;0;1\n"),
            "the first row of FILE is \"s;t;m\", but the header s,t,m is expected (columns are separated by commas, "
            "and decimals written with a point; \"crawler table IN OUT\" does that)");
  EXPECT_EQ(complaint("s,t,m\n0,0,1\n0,1,\n"),
            "row 3 of FILE is \"0,1,\", " + three + " (\"crawler table IN OUT\" fills gaps)");
  EXPECT_EQ(complaint("s,t,m\n0,0,1\n\n0,1,nan\n"),
            "row 4 of FILE is \"0,1,nan\", " + three + " (\"crawler table IN OUT\" fills gaps)");
  EXPECT_EQ(complaint("s,t,m\n0,0,-inf\n"), "row 2 of FILE is \"0,0,-inf\", " + three);
  EXPECT_EQ(complaint("s,t,m\n0,0,1e999\n"), "row 2 of FILE is \"0,0,1e999\", " + three);
  EXPECT_EQ(complaint("s,t,m\n0,0,1,2\n"), "row 2 of FILE is \"0,0,1,2\", " + three);
  EXPECT_EQ(complaint("s,t,m\n0 0 1\n0,0,1x\n"), "row 2 of FILE is \"0 0 1\", " + three + "; 1 more row is like it: 3");
  EXPECT_EQ(complaint("s,t,m\nx\nx\nx\nx\nx\nx\n"),
            "row 2 of FILE is \"x\", " + three + "; 5 more rows are like it: 3, 4, 5, 6, ...");
  EXPECT_EQ(complaint("s,t,m\n0,0,1\n0,1,2\n1,0,3\n1,1,4\n0,1,5\n0,0,6\n"),
            "row 6 of FILE gives s = 0, t = 1 a second time, after row 3; 1 more row is like it: 7");
  EXPECT_EQ(
    complaint("s,t,m\n0,0,1\n0,1,2\n1,0,3\n"),
    "FILE has 3 rows after the header, but 4 are expected, one for each pair of 2 values of s and 2 values of t; "
    "the first that is missing is s = 1, t = 1 (\"crawler table IN OUT\" fills gaps)");
  EXPECT_EQ(
    complaint("s,t,m\n0,0,1\n1,1,2\n2,2,3\n"),
    "FILE has 3 rows after the header, but 9 are expected, one for each pair of 3 values of s and 3 values of t; "
    "the first that are missing are s = 1, t = 0; s = 2, t = 0; s = 0, t = 1 (\"crawler table IN OUT\" fills gaps)");
  std::string scattered = "s,t,m\n";
  for (unsigned int i = 0; i < 200; ++i)
    scattered += fmt::format("{0},{0},0\n", i);
  EXPECT_EQ(complaint(scattered),
            "FILE has 200 rows after the header with 200 different values of s and 200 of t, but a full grid, a row "
            "for each pair of these, is expected");
  const std::string nothing = "cannot read FILE, or it is empty; the name of a CSV file with the header s,t,m or of an "
                              "HDF5 file is expected";
  EXPECT_EQ(complaint(""), nothing);
  EXPECT_EQ(complaint_about("/there/is/no/such/file"), nothing);
  EXPECT_EQ(complaint_about("/tmp"), nothing);
}

TEST(GridTable, SaysWhatIsWrongInHdf5)
{
  const test::TemporaryFolder folder;
  const auto file      = folder.path / "m.h5";
  const auto complaint = [&](const std::vector<test::Dataset> &datasets) {
    std::filesystem::remove(file);
    test::write_hdf5_file(file, datasets);
    return complaint_about(file);
  };
  const test::Dataset s{"s", {3}, {0., 0.5, 1.}}, t{"t", {2}, {0., 1.}}, m{"m", {2, 3}, {1., 2., 3., 4., 5., 6.}};
  const std::string expected = ", but the datasets s[ns], t[nt] and m[nt,ns] are expected";
  EXPECT_EQ(complaint({s, t, m}), "nothing");
  EXPECT_EQ(complaint({s, m}), "FILE has no dataset t" + expected);
  EXPECT_EQ(complaint({s, t, {"m", {6}, m.values}}), "FILE has a dataset m with 1 dimensions" + expected);
  EXPECT_EQ(complaint({s, t, {"m", {3, 2}, m.values}}),
            "m[3,2] in FILE does not match s[3] and t[2]; m[2,3] is expected: the order of s and t is reversed, as "
            "MATLAB, R and Fortran store arrays");
  EXPECT_EQ(complaint({{"s", {3}, {0., 1., 0.5}}, t, m}),
            "s[2] = 0.5 follows s[1] = 1 in FILE, but increasing values are expected");
  EXPECT_EQ(complaint({{"s", {3}, {0., 0., 1.}}, t, m}),
            "s[1] = 0 follows s[0] = 0 in FILE, but increasing values are expected");
  EXPECT_EQ(complaint({s, {"t", {2}, {0., HUGE_VAL}}, m}), "t[1] in FILE is inf, but a finite number is expected");
  EXPECT_EQ(complaint({s, t, {"m", {2, 3}, {1., 2., 3., 4., std::nan(""), 6.}}}),
            "m[1,1] in FILE (s = 0.5, t = 1) is nan, but a finite number is expected");
  write_file(file, read_whole_file(file).substr(0, 300));
  EXPECT_EQ(complaint_about(file), "FILE begins like an HDF5 file, but HDF5 cannot open it");
}

/// Doubling both grids divides the errors by 4 (linear) and 16 (cubic), those of the rate by 2 and 8.
TEST(GridInterpolation, Orders)
{
  using Method      = GridInterpolation::Method;
  const auto points = equal_parts(0., 1., 100);
  const auto errors = [&](const unsigned int n, const Method method, const GridInterpolation::Outside outside) {
    const GridInterpolation table(samples(equal_parts(0., 1., n), equal_parts(0., 1., n), wave_of), method, outside);
    const auto at = table.at(points);
    std::vector<double> m(points.size()), m_t(points.size());
    double value = 0., rate = 0.;
    for (unsigned int j = 0; j <= 97; ++j)
    {
      const double t = j / 97.;
      at->values(t, m);
      at->rates(t, m_t);
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        value = std::max(value, std::abs(m[i] - wave_of(points[i], t)));
        rate  = std::max(rate, std::abs(m_t[i] - 2. * pi * std::cos(2. * pi * (points[i] + t)) * std::exp(-points[i])));
      }
    }
    return std::pair(value, rate);
  };
  for (const auto outside : {GridInterpolation::Outside::go_on, GridInterpolation::Outside::periodic})
  {
    const auto coarse = errors(32, Method::cubic, outside), fine = errors(64, Method::cubic, outside);
    EXPECT_GT(std::log2(coarse.first / fine.first), 3.8);
    EXPECT_GT(std::log2(coarse.second / fine.second), 2.8);
    const auto rough = errors(32, Method::linear, outside), less_rough = errors(64, Method::linear, outside);
    EXPECT_NEAR(std::log2(rough.first / less_rough.first), 2., 0.1);
    EXPECT_NEAR(std::log2(rough.second / less_rough.second), 1., 0.1);
  }
}

/// What is prepared for few points is what is computed for many.
TEST(GridInterpolation, FewAndManyPoints)
{
  for (const auto method : {GridInterpolation::Method::linear, GridInterpolation::Method::cubic})
  {
    const GridInterpolation table(samples(some_s, some_t, wave_of), method, GridInterpolation::Outside::hold);
    const auto points = equal_parts(-0.1, 1.1, 49);
    std::vector<double> m(50), m_t(50), one(1);
    const auto many = table.at(points);
    for (const double t : {-2., -0.3, 0.25, 1., 3.})
    {
      many->values(t, m);
      many->rates(t, m_t);
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        const auto alone = table.at({points[i]});
        alone->values(t, one);
        EXPECT_NEAR(m[i], one[0], 1e-14);
        alone->rates(t, one);
        EXPECT_NEAR(m_t[i], one[0], 1e-14);
      }
    }
  }
}

/// Before the first and after the last s and t.
TEST(GridInterpolation, Outside)
{
  std::vector<double> inside(2), outside(2);
  for (const auto method : {GridInterpolation::Method::linear, GridInterpolation::Method::cubic})
  {
    const GridTable grid = samples({0.2, 0.4, 0.6, 0.8}, {0., 0.25, 0.5, 0.75, 1.}, wave_of);
    const auto held      = GridInterpolation(grid, method, GridInterpolation::Outside::hold);
    held.at({0.2, 0.8})->values(1., inside);
    held.at({0., 1.})->values(1.7, outside);
    EXPECT_EQ(inside, outside);
    held.at({0., 1.})->rates(1.7, outside);
    EXPECT_EQ(outside, (std::vector<double>{0., 0.}));

    const auto periodic = GridInterpolation(grid, method, GridInterpolation::Outside::periodic);
    const auto at       = periodic.at({0.3, 0.7});
    for (const double shift : {-2., 1., 5.})
    {
      at->values(0.375, inside);
      at->values(0.375 + shift, outside);
      EXPECT_EQ(inside, outside);
      at->rates(0.375, inside);
      at->rates(0.375 + shift, outside);
      EXPECT_EQ(inside, outside);
    }
  }
}
