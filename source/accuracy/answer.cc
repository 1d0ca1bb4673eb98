// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/answer.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  void
  end_before_inversion(SimulationResult &result)
  {
    const double later  = std::max(result.time.time - result.inversion->t, 0.);
    result.inversion->t = std::max(result.inversion->t, result.time.time);
    if (result.inversion->error)
      *result.inversion->error += later;
    result.time.message = fmt::format("the body inverted: its stretch reached 0 at s = {:.6g}, t = {:.9g}; the model "
                                      "ends there",
                                      result.inversion->s,
                                      result.inversion->t);
  }

  bool
  fails_accuracy(SimulationResult &result, const double wanted, const std::string &unknown)
  {
    const double total = result.error->total;
    if (total <= wanted)
      return false;
    result.time.status = Status::failed;
    result.time.reason = accuracy_not_met;
    result.time.message =
      std::isnan(total)
        ? "the error of the displacement is not known: " + unknown
        : fmt::format("the error of the displacement is about {:.2g}, but Accuracy asks for {:.2g}", total, wanted);
    return true;
  }
} // namespace crawler
