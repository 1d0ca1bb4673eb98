// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/complaint.h"
#include "../../support/run_text.h"
#include "../../support/test.h"

#include <crawler/base/exceptions.h>
#include <crawler/scene/unit_names.h>

using namespace crawler;

namespace
{
  const UnitNames own = {"mm", "s", "mN"};
}

TEST(UnitNames, TakeThePlaceOfTheWords)
{
  EXPECT_EQ(own.of("force time/length^2"), "mN s/mm^2");
  EXPECT_EQ(own.of("time^2/(force length)"), "s^2/(mN mm)");
  EXPECT_EQ(own.of("energy"), "mN mm");
  EXPECT_EQ(own.of("1"), "1");
  EXPECT_EQ(own.of("times"), "times");
}

TEST(UnitNames, InATextOnlyInBrackets)
{
  EXPECT_EQ(own.in_brackets("time [time],force by length [force/length],n [1]"),
            "time [s],force by length [mN/mm],n [1]");
  EXPECT_EQ(own.in_brackets("length"), "length");
}

TEST(UnitNames, StandBehindNumbersOnlyIfTheUserGaveSome)
{
  EXPECT_EQ(own.behind("length/time"), " mm/s");
  EXPECT_EQ(own.behind("1"), "");
  EXPECT_EQ(UnitNames().behind("length/time"), "");
  EXPECT_EQ(UnitNames().behind("energy"), "");
  EXPECT_EQ(UnitNames().of("energy"), "energy");
}

TEST(UnitNames, FitIntoHeaders)
{
  EXPECT_NO_THROW(own.require_plain());
  for (const auto &[name, entry] : {std::pair("Units/Length", "m,m"), {"Units/Time", ""}, {"Units/Force", "[N]"}})
  {
    const auto require = [&, name = name, entry = entry]() {
      test::parameters_with({{name, entry}}).units.require_plain();
    };
    test::expect_words(test::complaint_of(require), {std::string(name) + ": "});
  }
}
