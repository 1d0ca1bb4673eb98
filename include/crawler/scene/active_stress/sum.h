// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/envelope.h>
#include <crawler/scene/known_stress.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// Entries of a term of a sum besides those of its generator.
  struct SumTermParameters
  {
    std::string combine = "add"; ///< | multiply
    double factor       = 1.;
    WindowEntries in_s, in_t; ///< [length], [time]

    void
    add_parameters(Declarations &declarations);
  };

  /// A term: a generator g and its factors.
  struct SumTerm
  {
    std::string name; ///< of the generator
    std::shared_ptr<const ActiveStress> stress;
    bool multiplies;
    double factor;
    Window in_s, in_t;
  };

  /**
   * Generators combined. Each term is f_i(s,t) = factor_i W_i(s) V_i(t) g_i(s,t), windows W and V (envelope.h), and
   *
   *   m = ( sum of the terms that add ) * ( product of the terms that multiply ).
   *
   * A term that multiplies is a number without unit, and like all others 0 outside of its windows. A generator is not
   * evaluated where a window is closed. Rates and derivatives with respect to the stretch follow from the sum and
   * product rules.
   */
  class Sum : public KnownStress
  {
  public:
    /// Throws InputError if no term adds, or if terms use the stretch at different distances or with different delays.
    Sum(std::vector<SumTerm> terms, double length, double end_time);

    /// Bounds; terms that have none are sampled in the box, with a margin of 2. Nothing if no term has any.
    std::optional<Bounds>
    bounds(const Box &box) const override;

    std::unique_ptr<const ActiveStress>
    with_fronts(double part) const override;

    void
    report(std::ostream &out) const override;
    const StressFailures *
    failures() const override;

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;

    /// Finds a common period of all terms (period.h), or a whole part of it after which the sum repeats, from the time
    /// on at which no window in time changes any more; if a term's is unknown, searches that of the sum.
    std::optional<Repetition>
    search_repetition() const;

    const std::vector<SumTerm> terms_;
    const double length_, end_time_;
    mutable StressFailures failures_; ///< of all terms
  };
} // namespace crawler
