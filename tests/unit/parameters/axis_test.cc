// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/axis.h>
#include <crawler/parameters/declarations.h>

#include <gtest/gtest.h>

using namespace crawler;

namespace
{
  const std::string name = "Atlas/First axis";

  std::vector<std::string>
  values_of(const std::string &values)
  {
    return parse_axis("Body/Length : " + values, name).values;
  }

  void
  expect_error(const std::string &text, const std::vector<std::string> &parts)
  {
    try
    {
      numbers_of(parse_axis(text, name), name);
      ADD_FAILURE() << "\"" << text << "\" was accepted";
    }
    catch (const InputError &error)
    {
      EXPECT_EQ(error.entry, name);
      for (const std::string &part : parts)
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << part << " not in: " << error.what();
    }
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
  const Axis axis = parse_axis("  Active stress / Generator:none ,optimal wave ", name);
  EXPECT_EQ(axis.entry, "Active stress/Generator");
  EXPECT_EQ(axis.values, (std::vector<std::string>{"none", "optimal wave"}));
  EXPECT_EQ(numbers_of(parse_axis("Body/Length : 1, 2.50", name), name), (std::vector<double>{1., 2.5}));
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
  expect_error("Body/Length", {"\"Body/Length\"", "linspace(first, last, count)"});
  expect_error("Body/Length :", {"is expected"});
  expect_error(": 1, 2", {"Section/Entry"});
  expect_error("Body/Length : linspce(0, 1, 2)", {"\"linspce\"", "the nearest is \"linspace\""});
  expect_error("Body/Length : max(1, x)", {"\"max\"", "\"linspace\" or \"logspace\"", "in double quotes"});
  expect_error("Body/Length : 1, linspace(0, 1, 2)", {"\"linspace(0, 1, 2)\"", "nothing beside it"});
  expect_error("Body/Length : 1, max(1, (x)", {"as many closing as opening parentheses"});
  expect_error("Body/Length : 1, \"2", {"a second double quote is expected"});
  expect_error("Body/Length : linspace(0, 1)", {"\"linspace(0, 1)\"", "three numbers"});
  expect_error("Body/Length : linspace(0, x, 3)", {"three numbers"});
  expect_error("Body/Length : linspace(0, 1, 3", {"three numbers"});
  expect_error("Body/Length : linspace(0, 1, 3) 4", {"three numbers"});
  expect_error("Body/Length : linspace(0, 1, 2.5)", {"\"2.5\"", "a whole number from 1 to 100000"});
  expect_error("Body/Length : linspace(0, 1, 0)", {"a whole number from 1"});
  expect_error("Body/Length : linspace(1, 1, 3)", {"the value 1 occurs twice"});
  expect_error("Body/Length : 1, 2, 1.0", {"occurs twice"});
  expect_error("Body/Length : 1,, 2", {"value 2 of the list", "empty"});
  expect_error("Body/Length : logspace(0, 400, 2)", {"400"});
  expect_error("Body/Length : 1, long", {"\"long\"", "a number is expected"});
}

TEST(Axis, AllValuesAreCheckedAgainstTheDeclarations)
{
  double length = 1.;
  Declarations declarations;
  declarations.enter("Body");
  declarations.number("Length", length, positive(), "length").means("Length.");
  declarations.leave();
  require_valid(parse_axis("Body/Length : 1, 3", name), name, declarations);
  EXPECT_EQ(length, 3.);
  for (const auto &[text, part] : {std::pair("Body/Length : 2, -1", "a positive number is expected"),
                                   std::pair("Body/Lenght : 2", "nearest name is \"Length\"")})
    try
    {
      require_valid(parse_axis(text, name), name, declarations);
      ADD_FAILURE() << text;
    }
    catch (const InputError &error)
    {
      EXPECT_EQ(error.entry, name);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}
