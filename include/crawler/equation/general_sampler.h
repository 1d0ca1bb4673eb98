// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/assembler.h>

namespace crawler
{
  /// Evaluates the laws of a general scene at places of this rank's cells, for output and checks (collective).
  class GeneralSampler
  {
  public:
    /// @p places: in cells numbered among this rank's.
    GeneralSampler(const Assembler &assembler, const std::vector<CellPlace> &places);

    void
    sample(double t, std::span<const double> y, std::span<const double> v);

    // Of the latest sample.
    FrictionAtPoints friction;
    BodyForceAtPoints force;

  private:
    const Assembler &assembler_;
    const std::vector<CellPlace> places_;
    const std::vector<double> values_, derivatives_; ///< [point][node]
    StretchElsewhere elsewhere_;
    std::vector<double> u_local_, v_local_, u_, v_, e_, w_, rate_;
  };
} // namespace crawler
