// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/complaint.h"
#include "../../support/run_text.h"
#include "../../support/test.h"

#include <crawler/base/exceptions.h>
#include <crawler/scene/unit_names.h>

using namespace crawler;

TEST(UnitNames, TakeThePlaceOfTheWords)
{
  const UnitNames own = {"mm", "s", "mN"};
  EXPECT_EQ(own.of("force time/length^2"), "mN s/mm^2");
  EXPECT_EQ(own.of("energy"), "mN mm");
  EXPECT_EQ(own.of("times"), "times");
  EXPECT_EQ(own.behind("1"), "");
}

TEST(UnitNames, FitIntoHeaders)
{
  for (const auto &[name, entry] : {std::pair("Units/Length", "m,m"), {"Units/Time", ""}, {"Units/Force", "[N]"}})
  {
    const auto require = [&, name = name, entry = entry]() {
      test::parameters_with({{name, entry}}).units.require_plain();
    };
    test::expect_words(test::complaint_of(require), {std::string(name) + ": "});
  }
}
