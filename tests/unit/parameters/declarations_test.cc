// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/complaint.h"
#include "../../support/test.h"

#include <crawler/parameters/declarations.h>

using namespace crawler;

namespace
{
  struct Example
  {
    double length = 1.;
    std::optional<unsigned int> cells;
    std::vector<double> list = {1., 2.};
    std::string word         = "yes";
    Declarations declarations;

    Example()
    {
      declarations.enter("Body");
      declarations.number("Length", length, positive(), "length").means("A length.");
      declarations.whole_number("Cells", cells, 1, 10).means("A count.");
      declarations.leave();
      declarations.numbers("List", list, "1").means("A list.");
      declarations.choice("Word", word, {"yes", "no"}).means("A choice.");
    }
  };
} // namespace

TEST(Declarations, MembersFollowEntries)
{
  Example example;
  example.declarations.set("Body/Length", " 2.5e-3 ");
  example.declarations.set("Body/Cells", "7");
  example.declarations.set("List", "3, -4.5 ,6");
  example.declarations.set("Word", "no");
  EXPECT_EQ(example.length, 2.5e-3);
  EXPECT_EQ(example.cells, 7u);
  EXPECT_EQ(example.list, (std::vector<double>{3., -4.5, 6.}));
  EXPECT_EQ(example.word, "no");
  example.declarations.set("Body/Cells", "automatic");
  EXPECT_FALSE(example.cells.has_value());
}

/// In brackets behind the name: places of a list, constants by their names.
TEST(Declarations, NumbersOfAnEntryHaveNames)
{
  std::string constants = "a = 1, rate=-2e-3", profile = "1, 2", formula = "1+s";
  std::vector<double> list = {1.}, parts = {0.3};
  Declarations declarations;
  declarations.enter("X");
  declarations.constants("Constants", constants, {"Formula"}).means("C.");
  declarations.profile("Profile", profile).means("P.");
  declarations.profile("Formula", formula).means("F.");
  declarations.numbers("List", list, "1").means("L.");
  declarations.numbers("Parts", parts, "1", /*one_is_all=*/true).means("P.");
  declarations.leave();
  EXPECT_EQ(declarations.value("X/Constants[rate]"), "-0.002");
  declarations.set("X/Constants[ rate ]", "0.5");
  EXPECT_EQ(constants, "a = 1, rate = 0.5");
  declarations.set("X/Profile[2]", "3");
  EXPECT_EQ(profile, "1, 3");
  declarations.set("X/List[3]", "4");
  EXPECT_EQ(list, (std::vector<double>{1., 0., 4.}));
  EXPECT_EQ(declarations.info("X/Constants").values.words, (std::vector<std::string>{"X/Formula"}));
  for (const auto &[path, part] : {std::pair("X/Constants[rat]", "the nearest name is \"rate\""),
                                   std::pair("X/Constants[1]", "\"a\" or \"rate\" is expected"),
                                   std::pair("X/Profile[3]", "has 2 of them, so [1] to [2] are expected"),
                                   std::pair("X/Formula[1]", "is \"1+s\"; numbers at equally spaced places"),
                                   std::pair("X/Parts[2]", "is \"0.3\"; a number for each part is expected"),
                                   std::pair("X/List[0]", "a whole number from 1 to 10000")})
    EXPECT_NE(test::complaint_of([&, &path = path]() { declarations.value(path); }).find(part), std::string::npos)
      << path;
}

TEST(ToText, RoundTrips)
{
  for (const double value : {0., 1. / 3., 1e-300, -2.5e17, 0.1})
    EXPECT_EQ(*to_number(to_text(value)), value);
}
