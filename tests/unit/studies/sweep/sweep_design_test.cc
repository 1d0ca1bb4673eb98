// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../../support/complaint.h"
#include "../../../support/temporary_folder.h"
#include "../../../support/test.h"

#include <crawler/studies/sweep/sweep_design.h>

namespace
{
  using namespace crawler;

  SweepDesign
  design(const std::string &kind, const std::string &axes, const unsigned int n = 50, const unsigned int seed = 1)
  {
    SweepParameters parameters;
    parameters.design   = kind;
    parameters.axes     = axes;
    parameters.n_points = n;
    parameters.seed     = seed;
    return SweepDesign(parameters);
  }

  TEST(SweepDesign, NeighboursAreOneStepAwayOnOneAxis)
  {
    using List    = std::vector<unsigned long>;
    const auto of = [](const SweepDesign &all, const unsigned long point) {
      List list = all.neighbours(point);
      std::ranges::sort(list);
      return list;
    };
    const SweepDesign grid = design("grid", "A/x : 1, 2, 3; A/y : 0, 1, 2, 3");
    EXPECT_EQ(of(grid, 0), (List{1, 4}));
    EXPECT_EQ(of(grid, 5), (List{1, 4, 6, 9}));
    EXPECT_EQ(of(grid, 11), (List{7, 10}));
    const SweepDesign zip = design("zip", "A/x : 1, 1, 2; A/y : 5, 6, 7");
    EXPECT_EQ(of(zip, 0), List{1});
    EXPECT_EQ(of(zip, 1), (List{0, 2}));
  }

  TEST(SweepDesign, ALatinHypercubeHasOnePointInEachPartOfEachAxis)
  {
    const unsigned int n     = 50;
    const SweepDesign square = design("latin hypercube", "A/x : uniform(-1, 3); A/y : loguniform(0.01, 100)", n);
    std::set<int> x, y;
    for (unsigned long i = 0; i < n; ++i)
    {
      x.insert(static_cast<int>(std::floor((std::stod(square.value(0, i)) + 1.) / 4. * n)));
      y.insert(static_cast<int>(std::floor((std::log10(std::stod(square.value(1, i))) + 2.) / 4. * n)));
    }
    EXPECT_EQ(x.size(), n);
    EXPECT_EQ(y.size(), n);
    EXPECT_EQ(*x.begin(), 0);
    EXPECT_EQ(*x.rbegin(), static_cast<int>(n) - 1);
  }

  TEST(SweepDesign, RandomNumbersAreEvenAndIndependent)
  {
    for (const char *kind : {"random", "latin hypercube"})
    {
      const unsigned int n       = 20000;
      const SweepDesign design_2 = design(kind, "A/x : uniform(0, 1); A/y : uniform(0, 1); A/w : a, b, c, d", n);
      double x = 0., xx = 0., xy = 0., neighbours = 0., last = 0.5;
      std::map<std::string, unsigned int> words;
      for (unsigned long i = 0; i < n; ++i)
      {
        const double dx = std::stod(design_2.value(0, i)) - 0.5, dy = std::stod(design_2.value(1, i)) - 0.5;
        ASSERT_TRUE(dx >= -0.5 && dx < 0.5);
        x += dx / n;
        xx += 12. * dx * dx / n;
        xy += 12. * dx * dy / n;
        neighbours += 12. * dx * last / n;
        last = dx;
        ++words[design_2.value(2, i)];
      }
      // Four standard deviations of a mean, a variance and a correlation.
      const double deviation = 4. / std::sqrt(n);
      EXPECT_NEAR(x, 0., deviation / std::sqrt(12.)) << kind;
      EXPECT_NEAR(xx, 1., deviation * std::sqrt(0.8)) << kind;
      EXPECT_NEAR(xy, 0., deviation) << kind;
      EXPECT_NEAR(neighbours, 0., deviation) << kind;
      for (const auto &[word, count] : words)
        EXPECT_NEAR(count / double(n), 0.25, deviation * std::sqrt(0.25 * 0.75)) << kind << word;
    }
  }

  TEST(SweepDesign, RandomPointsDependOnTheSeedAlone)
  {
    const std::string axes = "A/x : uniform(0, 1); A/y : 1, 2, 3";
    const SweepDesign one = design("random", axes, 20, 7), same = design("random", axes, 20, 7),
                      other  = design("random", axes, 20, 8);
    unsigned int differences = 0;
    for (unsigned long i = 0; i < 20; ++i)
    {
      EXPECT_EQ(one.value(0, i), same.value(0, i));
      EXPECT_EQ(one.value(1, i), same.value(1, i));
      differences += one.value(0, i) != other.value(0, i);
    }
    EXPECT_EQ(differences, 20u);
    EXPECT_EQ(one.value(0, 0), design("random", axes, 5, 7).value(0, 0));
  }

  TEST(SweepDesign, AColumnIsReadWithoutRemarksAndAGridHasNoPointTwice)
  {
    const test::TemporaryFolder folder;
    const auto path = folder.path / "table.csv";
    write_file(path, "\xef\xbb\xbf# a remark\r\np, \"a, b\"\r\n\r\n2,x\r\n#3,y\r\n2.0,\"y, \"\"z\"\"\"\r\n");
    const std::string p     = "A/x : column(" + path.string() + ", p)",
                      words = "; A/y : column(" + path.string() + ", \"a, b\")";
    const SweepDesign zip   = design("zip", p + words);
    EXPECT_EQ(zip.n_points(), 2u);
    EXPECT_EQ(zip.value(0, 1), "2.0");
    EXPECT_EQ(zip.value(1, 1), "y, \"z\"");
    EXPECT_THROW(design("grid", p), InputError);
    EXPECT_EQ(design("grid", "A/x : 1, 2" + words).n_points(), 4u);
    write_file(path, "p;q\n1,5;2\n");
    test::expect_words(test::complaint_of([&]() { design("zip", p); }), {"has its columns between semicolons"});
  }

  TEST(SweepDesign, SemicolonsAndColonsWithinQuotesBelongToTheValue)
  {
    const SweepDesign grid = design("grid", "A/x : \"a;b\", \"c : d\", x<0 ? 1 : 2; A/y : 1;");
    EXPECT_EQ(grid.axes()[0].values, (std::vector<std::string>{"a;b", "c : d", "x<0 ? 1 : 2"}));
  }

  TEST(SweepDesign, WhatMakesNoSenseIsRefused)
  {
    for (const char *axes : {"A/x :", ": 1"}) // others: cli/sweep, cli/bad_input
      EXPECT_THROW(design("grid", axes), InputError) << axes;
    EXPECT_THROW(design("zip", "A/x : 1, 2; A/y : 5, 6, 7"), InputError);
    EXPECT_THROW(design("random", "A/x : uniform(1, 0)"), InputError);
    EXPECT_THROW(design("random", "A/x : loguniform(0, 1)"), InputError);
    EXPECT_THROW(design("grid", "A/x : linspace(0, 1, 100000); A/y : linspace(0, 1, 100000)"),
                 InputError); // 1e10 points
  }
} // namespace
