// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/sweep/cross_check.h>

#include <fmt/format.h>

#include <optional>

namespace crawler
{
  namespace
  {
    bool
    finished(const Claim &claim)
    {
      return claim.status == "finished";
    }

    bool
    is_answer(const Claim &claim)
    {
      return finished(claim) || claim.status == "inverted";
    }

    /// Time until which the body is certainly not inverted.
    double
    uninverted_until(const Claim &claim, const InversionFacts &facts)
    {
      return finished(claim) ? facts.end_time : claim.inversion_time;
    }

    std::string
    in_words(const Claim &claim)
    {
      return finished(claim) ? fmt::format("{} finished", claim.run)
                             : fmt::format("{} inverted at t = {:.6g}", claim.run, claim.inversion_time);
    }

    /// Reason why one claim cannot be right; empty if it can.
    std::string
    against_theory(const Claim &claim, const InversionFacts &facts)
    {
      const double tolerance = inversion_time_tolerance * facts.end_time;
      const double until     = uninverted_until(claim, facts);
      if (!(until <= facts.latest_at_end + tolerance))
        return fmt::format("{}, but an end inverts at t = {:.6g}", in_words(claim), facts.latest_at_end);
      if (!finished(claim) && !facts.possible_inside && until < facts.earliest_at_end - tolerance)
        return in_words(claim) + ", but the body cannot invert inside (a <= -1) and its ends do not";
      return "";
    }

    /// Reason why two answers cannot both be right, empty if they can; nothing if they cannot be compared.
    std::optional<std::string>
    compare(const Claim &a, const Claim &b, const InversionFacts &facts)
    {
      if (!is_answer(a) || !is_answer(b))
        return std::nullopt;
      if (finished(a) && finished(b))
      {
        const double promised = a.promised_error + b.promised_error;
        if (std::isnan(promised))
          return std::nullopt;
        const double difference = std::abs(a.displacement - b.displacement);
        if (difference <= promised)
          return "";
        return fmt::format(
          "the displacements of {} and {}, {:.8g} and {:.8g}, differ by {:.3g}, but {:.3g} is promised",
          a.run,
          b.run,
          a.displacement,
          b.displacement,
          difference,
          promised);
      }
      const double difference = std::abs(uninverted_until(a, facts) - uninverted_until(b, facts));
      if (difference <= inversion_time_tolerance * facts.end_time)
        return "";
      return fmt::format("{}, but {}", in_words(a), in_words(b));
    }
  } // namespace

  Verdict
  cross_check(const std::vector<Claim> &runs, const Claim &refined, const InversionFacts &facts)
  {
    std::vector<Claim> all = runs;
    all.push_back(refined);
    for (const Claim &claim : all)
      if (is_answer(claim))
        if (const std::string why = against_theory(claim, facts); !why.empty())
          return {Verdict::silent_wrong_answer, why};

    bool compared           = false;
    const auto look_at_pair = [&](const Claim &a, const Claim &b) {
      const auto contradiction = compare(a, b, facts);
      compared                 = compared || contradiction;
      return contradiction.value_or("");
    };
    for (std::size_t i = 0; i < runs.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j)
        if (!is_answer(refined) || j == runs.size())
          if (const std::string why = look_at_pair(runs[i], all[j]); !why.empty())
            return {Verdict::silent_wrong_answer, why};
    return {compared ? Verdict::agree : Verdict::unchecked, ""};
  }
} // namespace crawler
