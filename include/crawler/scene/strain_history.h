// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// Evaluates a strain and its rate at fixed points.
  class StrainAtPoints
  {
  public:
    virtual ~StrainAtPoints() = default;

    /// Writes e(s_i, t) = zeta_s - 1 [1] at all points into @p e (as long as the list of points).
    virtual void
    strain(double t, std::span<double> e) = 0;

    /// Writes the derivative e_t(s_i, t) [1/time] likewise.
    virtual void
    rate(double t, std::span<double> e_t) = 0;
  };

  /// A part of the body in a time interval: s in [s_from, s_to] [length], t in [t_from, t_to] [time].
  struct SpaceTimeBox
  {
    double s_from, s_to, t_from, t_to;
  };

  /// Bounds of the size of a field and of its derivative in time, in a box.
  struct FieldBounds
  {
    double value, rate;
  };

  /// A strain e(s,t) = zeta_s - 1 known in advance, for 0 <= s <= L and 0 <= t <= T.
  class StrainHistory
  {
  public:
    virtual ~StrainHistory() = default;

    /// Makes an evaluator at @p points [length], which may keep whatever does not depend on time.
    virtual std::unique_ptr<StrainAtPoints>
    at(const std::vector<double> &points) const = 0;

    /// Bounds of e [1] and e_t [1/time] in @p box. They may be too large, but the less so the smaller the box. Nothing
    /// if they are not known (the default).
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
    double s, from, to; ///< place, and times before and after
    double change;      ///< of the strain
    double integral;    ///< of its rate
  };

  /**
   * Finds a jump of the strain in time, of more than 1e-6 of its largest value: results from the rate of such a strain
   * are wrong. Changes at some points over some intervals are compared with the integrals of the rate; two jumps that
   * cancel within an interval (1/37 of the duration) are not seen.
   */
  std::optional<StrainJump>
  find_jump(const StrainHistory &history, double length, double end_time);

  /// Makes an evaluator of a field at some points [length], a function that writes the values at a time.
  using FieldHistory =
    std::function<std::function<void(double t, std::span<double> values)>(const std::vector<double> &)>;

  /// Finds extremes on a grid of @p n_s times @p n_t points over the whole body and 0 <= t <= @p end_time, ends
  /// included, and from its eight highest peaks by a search with shrinking steps (to 1e-4 of those of the grid). A
  /// strain that is not a finite number somewhere is the smallest and the largest.
  StrainExtremes
  find_extremes(const FieldHistory &history, double length, double end_time, unsigned int n_s, unsigned int n_t);
  StrainExtremes
  find_extremes(const StrainHistory &history, double length, double end_time, unsigned int n_s, unsigned int n_t);
} // namespace crawler
