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
    /// Samples at the same places in all cells.
    GeneralSampler(const Assembler &assembler, const std::vector<double> &places);
    /// Samples at the left end of the first and the right end of the last of this rank's cells.
    static std::unique_ptr<GeneralSampler>
    at_ends(const Assembler &assembler);

    void
    sample(double t, std::span<const double> y, std::span<const double> v);

    /// Force N, m and k of the latest sample.
    const BodyForceAtPoints &
    force() const
    {
      return force_;
    }
    const std::vector<double> &
    strain() const
    {
      return e_;
    }
    /// Friction per reference length [force/length].
    const std::vector<double> &
    friction() const
    {
      return friction_;
    }

  private:
    GeneralSampler(const Assembler &assembler,
                   const std::vector<unsigned int> &cells,
                   const std::vector<double> &places,
                   const std::vector<double> &points);

    const Assembler &assembler_;
    const std::vector<unsigned int> cells_;
    const StretchSampler stretch_;
    const std::vector<double> values_, derivatives_; ///< [point][node]
    SlidingAtPoints sliding_;
    BodyForceAtPoints force_;
    StretchElsewhere elsewhere_;
    std::vector<double> u_local_, v_local_, u_, v_, e_, w_, rate_, friction_;
  };
} // namespace crawler
