// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/complaint.h"
#include "../../support/test.h"

#include <crawler/parameters/axis.h>

using namespace crawler;

namespace
{
  const std::string name = "Sweep/Axes";

  std::vector<std::string>
  values_of(const std::string &values)
  {
    return parse_values(values, name);
  }

  void
  expect_error(const std::string &text, const std::vector<std::string> &parts)
  {
    const std::string found = test::complaint_of([&]() { values_of(text); });
    EXPECT_TRUE(found.starts_with(name + ": ")) << found;
    test::expect_words(found, parts);
  }
} // namespace

TEST(Axis, LinspaceHasBothEndsAndNoRoundOff)
{
  EXPECT_EQ(values_of("linspace(0, 0.3, 4)"), (std::vector<std::string>{"0", "0.1", "0.2", "0.3"}));
  EXPECT_EQ(values_of("linspace(12, -10, 3)"), (std::vector<std::string>{"12", "1", "-10"}));
  EXPECT_EQ(values_of("linspace(5, 9, 1)"), (std::vector<std::string>{"5"}));
  EXPECT_EQ(values_of("linspace(0.01, 0.95, 48)").size(), 48u);
  EXPECT_EQ(values_of("linspace(0.01, 0.95, 48)")[1], "0.03");
}

TEST(Axis, LogspaceGivesPowersOfTen)
{
  EXPECT_EQ(values_of("logspace(-2, 2, 5)"), (std::vector<std::string>{"0.01", "0.1", "1", "10", "100"}));
}

TEST(Axis, ListsKeepTheTextOfTheValues)
{
  EXPECT_EQ(values_of("none ,optimal wave "), (std::vector<std::string>{"none", "optimal wave"}));
  EXPECT_EQ(values_of("1, 2.50"), (std::vector<std::string>{"1", "2.50"}));
}

TEST(Axis, CommasWithinParenthesesOrQuotesDoNotSeparate)
{
  EXPECT_EQ(values_of("max(1, x), 2"), (std::vector<std::string>{"max(1, x)", "2"}));
  EXPECT_EQ(values_of("2*max(1, min(x, 3))"), (std::vector<std::string>{"2*max(1, min(x, 3))"}));
  EXPECT_EQ(values_of("sin(x) + cos(x)"), (std::vector<std::string>{"sin(x) + cos(x)"}));
  EXPECT_EQ(values_of("\"1, 2\", \"max(1, x)\" , 3"), (std::vector<std::string>{"1, 2", "max(1, x)", "3"}));
  EXPECT_EQ(values_of("\"max(1, x)\""), (std::vector<std::string>{"max(1, x)"}));
  EXPECT_EQ(values_of("\"an (odd name\", b"), (std::vector<std::string>{"an (odd name", "b"}));
  const auto call = read_call("column(\"a, (b.csv\", p)");
  ASSERT_TRUE(call);
  EXPECT_EQ(call->function, "column");
  EXPECT_EQ(call->arguments, (std::vector<std::string>{"a, (b.csv", "p"}));
  EXPECT_FALSE(read_call("f(1) + g(2)"));
  EXPECT_EQ(split_parts("a : f(1; b : \"x;y\"", ';'), (std::vector<std::string>{"a : f(1", "b : \"x;y\""}));
}

TEST(Axis, WhatIsWrongIsSaid)
{
  expect_error("linspce(0, 1, 2)", {"\"linspce\"", "the nearest is \"linspace\""});
  expect_error("max(1, x)", {"\"max\"", "\"linspace\" or \"logspace\"", "in double quotes"});
  expect_error("1, linspace(0, 1, 2)", {"\"linspace(0, 1, 2)\"", "nothing else"});
  expect_error("1, max(1, (x)", {"as many closing as opening parentheses"});
  expect_error("1, \"2", {"a second double quote is expected"});
  expect_error("linspace(0, 1)", {"\"linspace(0, 1)\"", "three numbers"});
  expect_error("linspace(0, x, 3)", {"three numbers"});
  expect_error("linspace(0, 1, 3", {"three numbers"});
  expect_error("linspace(0, 1, 3) 4", {"three numbers"});
  expect_error("linspace(0, 1, 2.5)", {"\"2.5\"", "a whole number from 1 to 100000"});
  expect_error("linspace(0, 1, 0)", {"a whole number from 1"});
  expect_error("linspace(1, 1, 3)", {"the value 1 occurs twice"});
  expect_error("1, 2, 1.0", {"occurs twice"});
  expect_error("1,, 2", {"value 2 of the list", "empty"});
  expect_error("logspace(0, 400, 2)", {"400"});
}
