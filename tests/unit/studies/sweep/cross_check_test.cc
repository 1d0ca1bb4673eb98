// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../../support/test.h"

#include <crawler/studies/sweep/cross_check.h>

using namespace crawler;

namespace
{
  Claim
  finished(const double displacement, const double promised_error = 1e-4)
  {
    return {.run = "finisher", .status = "finished", .displacement = displacement, .promised_error = promised_error};
  }

  Claim
  inverted(const double time)
  {
    return {.run = "inverter", .status = "inverted", .inversion_time = time};
  }

  const Claim failed{.run = "failed one", .status = "failed"}, not_run{.run = "nobody", .status = ""};
  const double no_number = std::numeric_limits<double>::quiet_NaN();

  Verdict::Kind
  kind(const std::vector<Claim> &runs, const Claim &refined, const InversionFacts &facts = {})
  {
    const Verdict verdict = cross_check(runs, refined, facts);
    EXPECT_EQ(verdict.explanation.empty(), verdict.kind != Verdict::silent_wrong_answer);
    return verdict.kind;
  }
} // namespace

TEST(CrossCheck, DisplacementsMayDifferByTheSumOfThePromises)
{
  EXPECT_EQ(kind({finished(1.)}, finished(1.000105, 1e-5)), Verdict::agree);
  EXPECT_EQ(kind({finished(1.)}, finished(1.000115, 1e-5)), Verdict::silent_wrong_answer);
  EXPECT_EQ(kind({finished(1.), finished(2.)}, finished(1.)), Verdict::silent_wrong_answer);
  EXPECT_EQ(kind({finished(no_number)}, finished(1.)),
            Verdict::silent_wrong_answer); // a finished run has a displacement
}

TEST(CrossCheck, WithoutAPromiseThereIsNothingToCheck)
{
  EXPECT_EQ(kind({finished(1., no_number)}, finished(2.)), Verdict::unchecked);
  EXPECT_EQ(kind({finished(1., no_number), finished(2.)}, finished(2.)), Verdict::agree);
}

TEST(CrossCheck, FinishedAndInvertedContradictEachOther)
{
  EXPECT_EQ(kind({finished(1.)}, inverted(0.5)), Verdict::silent_wrong_answer);
  EXPECT_EQ(kind({inverted(0.5)}, finished(1.)), Verdict::silent_wrong_answer);
  EXPECT_EQ(kind({finished(1.)}, inverted(0.9995)), Verdict::agree); // within the tolerance of the time
}

TEST(CrossCheck, TimesOfInversionMustAgree)
{
  EXPECT_EQ(kind({inverted(0.5)}, inverted(0.5009)), Verdict::agree);
  EXPECT_EQ(kind({inverted(0.5)}, inverted(0.5011)), Verdict::silent_wrong_answer);
  EXPECT_EQ(kind({inverted(5.)}, inverted(5.009), {.end_time = 10.}), Verdict::agree);
}

TEST(CrossCheck, AFailureWithANameIsNeverWrong)
{
  EXPECT_EQ(kind({failed, failed, failed}, finished(1.)), Verdict::unchecked);
  EXPECT_EQ(kind({failed, finished(1.)}, finished(1.)), Verdict::agree);
  EXPECT_EQ(kind({finished(1.), not_run, not_run}, failed), Verdict::unchecked);
  EXPECT_EQ(kind({}, failed), Verdict::unchecked);
}

TEST(CrossCheck, WithoutARefinedAnswerTheOthersAreComparedWithEachOther)
{
  EXPECT_EQ(kind({finished(1.), failed, finished(1.0001)}, failed), Verdict::agree);
  EXPECT_EQ(kind({finished(1.), failed, finished(1.0003)}, failed), Verdict::silent_wrong_answer);
  // Each is near enough to the refined one; that they are farther from each other does not matter.
  EXPECT_EQ(kind({finished(1.), finished(1.0003)}, finished(1.00015)), Verdict::agree);
}

TEST(CrossCheck, InsideABodyWithALowExponentNothingInverts)
{
  const InversionFacts never{.possible_inside = false};
  EXPECT_EQ(kind({inverted(0.5)}, failed, never), Verdict::silent_wrong_answer);
  EXPECT_EQ(kind({inverted(0.5)}, inverted(0.5), never), Verdict::silent_wrong_answer);
  EXPECT_EQ(kind({finished(1.)}, finished(1.), never), Verdict::agree);
  const InversionFacts at_end{.possible_inside = false, .earliest_at_end = 0.499, .latest_at_end = 0.501};
  EXPECT_EQ(kind({inverted(0.5)}, inverted(0.5), at_end), Verdict::agree);
  EXPECT_EQ(kind({inverted(0.4)}, inverted(0.4), at_end), Verdict::silent_wrong_answer);
}

TEST(CrossCheck, AnInvertedEndCannotBeMissed)
{
  const InversionFacts at_end{.earliest_at_end = 0.499, .latest_at_end = 0.501};
  EXPECT_EQ(kind({finished(1.)}, failed, at_end), Verdict::silent_wrong_answer);
  EXPECT_EQ(kind({inverted(0.6)}, failed, at_end), Verdict::silent_wrong_answer);
  EXPECT_EQ(kind({inverted(0.3)}, inverted(0.3), at_end), Verdict::agree); // earlier, inside
}
