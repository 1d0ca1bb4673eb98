// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/general_sampler.h>

#include <array>
#include <memory>

namespace crawler
{
  /// The power that leaves through the ends in the paper's energy: [m v] from s = 0 to L (theory.md section 6).
  class EndPower
  {
  public:
    explicit EndPower(const Assembler &assembler);

    /// @p v at the nodes, of the state @p y (collective).
    double
    operator()(double t, std::span<const double> y, std::span<const double> v);

    /// The same if what it depends on is known: stretch and its rate, which only a local feedback sees, and velocity at
    /// s = 0 and L.
    struct Ends
    {
      double t;
      std::array<double, 2> stretch, rate, velocity;
    };
    double
    of_ends(const Ends &ends);

  private:
    const Assembler &assembler_;
    const std::unique_ptr<ActiveStressAtPoints> stress_; ///< of a body without feedback, at both ends
    std::unique_ptr<GeneralSampler> sampler_;            ///< of the others
    std::unique_ptr<FeedbackAtPoints> feedback_;         ///< the same, at both ends
  };
} // namespace crawler
