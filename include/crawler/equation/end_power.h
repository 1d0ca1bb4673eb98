// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/general_sampler.h>

#include <array>
#include <memory>

namespace crawler
{
  /// Power that leaves through the ends in the paper's energy: [m v] from s = 0 to L (theory.md section 6).
  class EndPower
  {
  public:
    explicit EndPower(const Assembler &assembler);

    /// Power for the velocity @p v at the nodes, of the state @p y (collective).
    double
    operator()(double t, std::span<const double> y, std::span<const double> v);

    /// Power from known velocities at s = 0 and L, and the stretches and rates there, used by local feedback only.
    struct Ends
    {
      double t;
      std::array<double, 2> stretch, rate, velocity;
    };
    double
    of_ends(const Ends &ends);

  private:
    const Assembler &assembler_;
    const std::unique_ptr<ActiveStressAtPoints> stress_; ///< at both ends of a body without feedback
    std::unique_ptr<GeneralSampler> sampler_;            ///< for bodies with feedback
    std::unique_ptr<FeedbackAtPoints> feedback_;         ///< feedback at both ends
  };
} // namespace crawler
