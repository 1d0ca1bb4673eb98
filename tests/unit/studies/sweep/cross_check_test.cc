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

  const InversionFacts never{.possible_inside = false}, at_end{.earliest_at_end = 0.499, .latest_at_end = 0.501},
    only_at_end{.possible_inside = false, .earliest_at_end = 0.499, .latest_at_end = 0.501};
} // namespace

TEST(CrossCheck, Verdicts)
{
  constexpr auto agree = Verdict::agree, wrong = Verdict::silent_wrong_answer, unchecked = Verdict::unchecked;
  struct
  {
    const char *why;
    std::vector<Claim> runs;
    Claim refined;
    Verdict::Kind verdict;
    InversionFacts facts = {};
  } const rows[] = {
    {"displacements may differ by the sum of the promises", {finished(1.)}, finished(1.000105, 1e-5), agree},
    {"and no more", {finished(1.)}, finished(1.000115, 1e-5), wrong},
    {"one of two", {finished(1.), finished(2.)}, finished(1.), wrong},
    {"a finished run has a displacement", {finished(no_number)}, finished(1.), wrong},
    {"without a promise there is nothing to check", {finished(1., no_number)}, finished(2.), unchecked},
    {"but what others promise", {finished(1., no_number), finished(2.)}, finished(2.), agree},
    {"finished and inverted contradict each other", {finished(1.)}, inverted(0.5), wrong},
    {"inverted and finished, too", {inverted(0.5)}, finished(1.), wrong},
    {"but for the tolerance of the time", {finished(1.)}, inverted(0.9995), agree},
    {"times of inversion agree", {inverted(0.5)}, inverted(0.5009), agree},
    {"times of inversion differ", {inverted(0.5)}, inverted(0.5011), wrong},
    {"relative to the end time", {inverted(5.)}, inverted(5.009), agree, {.end_time = 10.}},
    {"a failure with a name is never wrong", {failed, failed, failed}, finished(1.), unchecked},
    {"failures beside an answer", {failed, finished(1.)}, finished(1.), agree},
    {"a refined run that fails", {finished(1.), not_run, not_run}, failed, unchecked},
    {"no run at all", {}, failed, unchecked},
    {"without a refined answer the others are compared", {finished(1.), failed, finished(1.0001)}, failed, agree},
    {"with each other", {finished(1.), failed, finished(1.0003)}, failed, wrong},
    {"near enough to the refined one, farther from each other",
     {finished(1.), finished(1.0003)},
     finished(1.00015),
     agree},
    {"inside a body with a low exponent nothing inverts", {inverted(0.5)}, failed, wrong, never},
    {"whoever says so", {inverted(0.5)}, inverted(0.5), wrong, never},
    {"it may finish", {finished(1.)}, finished(1.), agree, never},
    {"its end may invert", {inverted(0.5)}, inverted(0.5), agree, only_at_end},
    {"then and not earlier", {inverted(0.4)}, inverted(0.4), wrong, only_at_end},
    {"an inverted end cannot be missed", {finished(1.)}, failed, wrong, at_end},
    {"nor be late", {inverted(0.6)}, failed, wrong, at_end},
    {"the inside may invert earlier", {inverted(0.3)}, inverted(0.3), agree, at_end}};
  for (const auto &[why, runs, refined, expected, facts] : rows)
  {
    const Verdict verdict = cross_check(runs, refined, facts);
    EXPECT_EQ(verdict.kind, expected) << why;
    EXPECT_EQ(verdict.explanation.empty(), expected != wrong) << why;
  }
}
