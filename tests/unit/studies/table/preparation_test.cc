// SPDX-License-Identifier: LGPL-2.1-or-later
//
// From files as instruments leave them to full tables.
#include <crawler/base/exceptions.h>
#include <crawler/studies/table/period_search.h>
#include <crawler/studies/table/preparation.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

using namespace crawler;

namespace
{
  constexpr double pi = std::numbers::pi;

  /// Samples of f(s,t) for 0 <= s <= 1.
  Samples
  samples_of(const auto &f, const std::size_t n_s, const std::size_t n_t, const double duration)
  {
    Samples samples;
    for (std::size_t i = 0; i < n_s; ++i)
      samples.s.push_back(static_cast<double>(i) / static_cast<double>(n_s - 1));
    for (std::size_t j = 0; j < n_t; ++j)
      samples.t.push_back(duration * static_cast<double>(j) / static_cast<double>(n_t - 1));
    for (const double t : samples.t)
      for (const double s : samples.s)
        samples.values.push_back(f(s, t));
    return samples;
  }

  Samples
  read(const std::string &text, const SampleSettings &settings = {})
  {
    std::vector<std::string> words;
    return read_samples(read_measured_file(text, "file"), settings, words);
  }

  PreparationSettings
  settings_with(const auto &change)
  {
    PreparationSettings settings;
    change(settings);
    return settings;
  }

  double
  value(const PreparedTable &table, const std::size_t j, const std::size_t i)
  {
    return table.grid.values[j * table.grid.s.size() + i];
  }

  /// Is the input refused with a sentence that has these words?
  testing::AssertionResult
  refuses(const std::string &words, const auto &function)
  {
    try
    {
      function();
    }
    catch (const InputError &error)
    {
      if (std::string(error.what()).find(words) != std::string::npos)
        return testing::AssertionSuccess();
      return testing::AssertionFailure() << error.what();
    }
    return testing::AssertionFailure() << "nothing refused";
  }

  const std::string wide = "0;1;2;3;4\n1;5;6;7;8\n2;9;10;11;12\n3;13;14;15;16\n", names = "t;0;0.5;1;1.5\n";

  std::string
  with(std::string text, const char separator)
  {
    for (char &c : text)
      c = c == ';' ? separator : c;
    return text;
  }
} // namespace

TEST(MeasuredFile, reads_what_instruments_write)
{
  const Samples expected = read(names + wide);
  EXPECT_EQ(expected.s, (std::vector<double>{0., 0.5, 1., 1.5}));
  EXPECT_EQ(expected.at(2, 1), 10.);
  for (const std::string &text : {"\xEF\xBB\xBFt;0,0;0,5;1,0;1,5\r\n" + wide,
                                  "# made today\nMy title\ntime [ms];0;0.5;1;1.5\nms;N;N;N;N\n" + wide,
                                  with(names + wide, ','),
                                  "\"t\"\t0\t0,5\t1\t1,5\n" + with(wide, '\t'),
                                  "# t 0 0.5 1 1.5\n" + with(wide, ' ')})
  {
    const Samples samples = read(text);
    EXPECT_EQ(samples.s, expected.s) << text;
    EXPECT_EQ(samples.values, expected.values) << text;
  }
  std::string list = "m;s;t\n";
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      list += (i == 1 && j == 2 ? "NaN" : std::to_string(1 + i + 4 * j) + ",0") + ";" + std::to_string(5 * i) + "e-1;" +
              std::to_string(j) + "\n";
  const Samples samples = read(list);
  EXPECT_EQ(samples.s, expected.s);
  EXPECT_TRUE(std::isnan(samples.at(2, 1)));
  EXPECT_EQ(samples.at(3, 1), 14.);
}

TEST(MeasuredFile, turns_units_and_shifts)
{
  SampleSettings settings;
  settings.unit_of_s     = "4";
  settings.unit_of_t     = "s";
  settings.unit_of_value = "-1";
  settings.shift_s       = "2";
  settings.shift_t       = "first";
  const Samples samples  = read("t [ms];0;0.5;1;1.5\n" + wide, settings);
  EXPECT_EQ(samples.s, (std::vector<double>{2., 4., 6., 8.}));
  EXPECT_DOUBLE_EQ(samples.t[3], 3e-3);
  EXPECT_EQ(samples.at(0, 0), -1.);
}

TEST(MeasuredFile, refuses_with_lines)
{
  const auto is_refused = [](const std::string &text, const std::string &words, const std::string &unit_of_t = "") {
    SampleSettings settings;
    settings.unit_of_t = unit_of_t;
    return refuses(words, [&]() { read(text, settings); });
  };
  EXPECT_TRUE(is_refused(names + wide + "4;1;2;x;4\n", "row 6 of \"file\" has \"x\" under 1,"));
  EXPECT_TRUE(is_refused(names + wide + "4;1;2;3\n5;1;1;1;1\n", "row 6 of \"file\" has 4 cells, but 5"));
  EXPECT_TRUE(is_refused(wide, "no line of 5 names"));
  EXPECT_TRUE(is_refused("t;a;b;c;d\n" + wide, "column 2 of \"file\" is \"a\""));
  EXPECT_TRUE(is_refused("a;b;c;d;e\n" + wide, "has the columns a, b, c, d, e"));
  EXPECT_TRUE(is_refused(names + wide, "has no unit", "s"));
  EXPECT_TRUE(is_refused(names + wide, "a number or a unit", "seconds"));
  EXPECT_TRUE(is_refused(names + wide + "2;1;1;1;1\n", "row 6 of \"file\" gives s = 0, t = 2 a second time"));
}

TEST(Preparation, fills_gaps_of_cubics_exactly)
{
  const auto f = [](const double s, const double t) {
    return 1. + s - t + 2. * t * t - 3. * t * t * t + s * t * t * t - s * s * s;
  };
  Samples samples = samples_of(f, 6, 12, 1.);
  for (const std::size_t j : {4u, 5u, 6u, 9u})
    samples.at(j, 2) = gap;
  samples.at(0, 3) = gap; // from its neighbours along the body
  for (const double width : {0., 0.5})
  {
    const PreparedTable table = prepare_table(samples, settings_with([=](auto &p) { p.width_t = width; }));
    for (std::size_t j = 0; j < 12; ++j)
      for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(value(table, j, i), f(samples.s[i], samples.t[j]), 1e-10);
  }
  for (std::size_t i = 1; i < 5; ++i)
    samples.at(5, i) = samples.at(6, i) = samples.at(7, i) = samples.at(8, i) = gap;
  EXPECT_TRUE(refuses("in a row, but at most 3", [&]() { prepare_table(samples, {}); }));
}

TEST(Preparation, finds_periods)
{
  const double period = 0.7310987;
  const auto f        = [&](const double s, const double t) {
    const double x = 2. * pi * (t / period - s);
    return std::exp(std::cos(x)) + 0.4 * std::sin(2. * x);
  };
  for (const double cycles : {1.4, 2., 5.3})
  {
    const Samples samples = samples_of(f, 5, static_cast<std::size_t>(40. * cycles), cycles * period);
    const auto found      = find_period(samples);
    ASSERT_TRUE(found) << cycles;
    EXPECT_NEAR(*found, period, 1e-4 * period) << cycles;
    const PreparedTable table = prepare_table(samples, settings_with([](auto &p) { p.period = "find"; }));
    for (std::size_t i = 0; i < 5; ++i)
      EXPECT_EQ(value(table, 0, i), value(table, table.grid.t.size() - 1, i));
    for (std::size_t j = 0; j < table.grid.t.size(); ++j)
      EXPECT_NEAR(value(table, j, 1), f(samples.s[1], table.grid.t[j]), 2e-3);
  }
  const Samples drift = samples_of([](const double s, const double t) { return s + t; }, 5, 50, 1.);
  EXPECT_FALSE(find_period(drift));
  EXPECT_TRUE(refuses("more than 5 times the noise",
                      [&]() { prepare_table(drift, settings_with([](auto &p) { p.period = "whole"; })); }));
}

/// Cycles are averaged: the noise of the table is smaller than that of the samples.
TEST(Preparation, averages_noisy_cycles)
{
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0., 0.05);
  const auto f    = [&](const double s, const double t) { return std::sin(2. * pi * (s + t)); };
  Samples samples = samples_of(f, 9, 401, 10.);
  for (double &one : samples.values)
    one += normal(random);
  EXPECT_NEAR(estimated_noise(samples), 0.05, 0.002);
  for (std::size_t j = 100; j < 103; ++j)
    samples.at(j, 4) = gap;
  const PreparedTable table = prepare_table(samples, settings_with([](auto &p) {
                                              p.width_t = 0.2;
                                              p.period  = "find";
                                            }));
  EXPECT_NEAR(*table.period, 1., 2e-3);
  double square = 0.;
  for (std::size_t j = 0; j < table.grid.t.size(); ++j)
    for (std::size_t i = 0; i < 9; ++i)
      square += std::pow(value(table, j, i) - f(samples.s[i], table.grid.t[j]), 2);
  EXPECT_LT(std::sqrt(square / static_cast<double>(table.grid.values.size())), 0.05 / std::sqrt(10.));
}

/// Of a known motion; without noise the error falls with the third power of the distance of markers.
TEST(Preparation, turns_tracks_into_strain)
{
  const auto strain = [](const double s, const double t) { return 0.3 * std::sin(pi * t) * std::cos(2. * pi * s + t); };
  const auto place  = [&](const double s, const double t) {
    return 5. + s + 0.1 * t + 0.3 * std::sin(pi * t) * (std::sin(2. * pi * s + t) - std::sin(t)) / (2. * pi);
  };
  const auto error = [&](const std::size_t n, const double width) {
    Samples tracks        = samples_of(place, n, 21, 0.8);
    tracks.quantity       = MeasuredQuantity::marker;
    const PreparedTable e = prepare_table(tracks, settings_with([=](auto &p) { p.width_s = width; }));
    double largest        = 0.;
    EXPECT_EQ(e.quantity, MeasuredQuantity::strain);
    EXPECT_DOUBLE_EQ(e.grid.s.back(), 1.);
    for (std::size_t j = 0; j < e.grid.t.size(); ++j)
      for (std::size_t i = 0; i < e.grid.s.size(); ++i)
        largest = std::max(largest, std::abs(value(e, j, i) - strain(e.grid.s[i], e.grid.t[j])));
    return largest;
  };
  EXPECT_LT(error(11, 0.), 0.02);
  EXPECT_NEAR(std::log2(error(17, 0.) / error(33, 0.)), 3., 0.4);
  EXPECT_LT(error(33, 0.2), 0.03); // smoothing flattens it, most at the ends
  EXPECT_LT(error(33, 0.1), 0.01);
}

TEST(Preparation, extrapolates_strain_as_stated)
{
  // The strain 0.2 t s of a body from 0 to 1, with markers from 0.2 to 0.8.
  Samples tracks = samples_of(
    [](const double part, const double t) {
      const double s = 0.2 + 0.6 * part;
      return s + 0.1 * t * s * s;
    },
    7,
    5,
    1.);
  tracks.quantity              = MeasuredQuantity::marker;
  PreparationSettings settings = settings_with([](auto &p) {
    p.n_s          = 6;
    p.first_marker = 0.2;
    p.length       = 1.;
  });
  const PreparedTable held     = prepare_table(tracks, settings);
  EXPECT_NEAR(value(held, 4, 0), 0.04, 1e-12);
  EXPECT_NEAR(value(held, 4, 5), 0.16, 1e-12);
  EXPECT_EQ(value(held, 0, 3), 0.);
  settings.ends              = "linear";
  const PreparedTable linear = prepare_table(tracks, settings);
  EXPECT_NEAR(value(linear, 4, 0), 0., 1e-12);
  EXPECT_NEAR(value(linear, 4, 5), 0.2, 1e-12);
}
