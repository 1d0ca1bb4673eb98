// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// Evaluates a strain and its rate at points that do not change.
  class StrainAtPoints
  {
  public:
    virtual ~StrainAtPoints() = default;

    /// Writes e(s_i, t) = zeta_s - 1 [1] at all points into @p e (as long as the list of points).
    virtual void
    strain(double t, std::span<double> e) = 0;

    /// The same for the derivative e_t(s_i, t) [1/time].
    virtual void
    rate(double t, std::span<double> e_t) = 0;
  };

  /// A part of the body for some time: s in [s_from, s_to] [length], t in [t_from, t_to] [time].
  struct SpaceTimeBox
  {
    double s_from, s_to, t_from, t_to;
  };

  /// A field and its derivative in time are, in a box, at most these in size.
  struct FieldBounds
  {
    double value, rate;
  };

  /// A strain e(s,t) = zeta_s - 1 that is known in advance, for 0 <= s <= L and 0 <= t <= T.
  class StrainHistory
  {
  public:
    virtual ~StrainHistory() = default;

    /// An evaluator at @p points [length] that may keep whatever does not depend on time.
    virtual std::unique_ptr<StrainAtPoints>
    at(const std::vector<double> &points) const = 0;

    /// Those of e [1] and e_t [1/time] in @p box. They may be too large, but the less so the smaller the box. Nothing
    /// if that is not known (the default).
    virtual std::optional<FieldBounds>
    bounds([[maybe_unused]] const SpaceTimeBox &box) const
    {
      return std::nullopt;
    }
  };

  /// A value of the strain with its place.
  struct StrainExtreme
  {
    double strain, s, t;
  };

  struct StrainExtremes
  {
    StrainExtreme smallest, largest;
  };

  /// A change of the strain in time that its rate does not explain.
  struct StrainJump
  {
    double s, from, to; ///< where, and between which times
    double change;      ///< of the strain
    double integral;    ///< of its rate
  };

  /**
   * A jump of the strain in time, of more than 1e-6 of its largest value: nothing that follows from the rate of such a
   * strain is right. Changes at some points over some intervals are compared with the integrals of the rate; two jumps
   * that cancel within an interval (1/37 of the duration) are not seen.
   */
  std::optional<StrainJump>
  find_jump(const StrainHistory &history, double length, double end_time);

  /// Evaluates a field at some points [length]: what it gives writes the values at a time.
  using FieldHistory =
    std::function<std::function<void(double t, std::span<double> values)>(const std::vector<double> &)>;

  /// Looked for on a grid of @p n_s times @p n_t points over the whole body and 0 <= t <= @p end_time, its ends
  /// included, and from its eight highest peaks by a search with steps that become smaller (to 1e-4 of those of the
  /// grid). A strain that is not a finite number somewhere is the smallest and the largest.
  StrainExtremes
  find_extremes(const FieldHistory &history, double length, double end_time, unsigned int n_s, unsigned int n_t);
  StrainExtremes
  find_extremes(const StrainHistory &history, double length, double end_time, unsigned int n_s, unsigned int n_t);
} // namespace crawler
