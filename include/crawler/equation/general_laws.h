// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/strain_places.h>
#include <crawler/equation/stretch_history.h>
#include <crawler/scene/scene.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

/**
 * Equation of a general scene (doc/theory.md, "General bodies and grounds") at fixed points:
 *
 *   f = g(w) b(s) c(x) d(v) v,   x = s + u,   and   N = m(s, t, w, w_t, ...) + k(s) (w - 1).
 */
namespace crawler
{
  /// Law that was not positive where it must be: for the user, with the entry that gives it.
  struct BadLaw
  {
    std::string message, entry;
  };

  /// Friction f at fixed points, its factors and its derivatives.
  class FrictionAtPoints
  {
  public:
    /// @p scene must outlive it.
    FrictionAtPoints(const Scene &scene, std::vector<double> points);

    /// Evaluates for displacements @p u, velocities @p v and stretches @p w at the points. Returns the number of the
    /// first point where the profile of the ground is not positive, or -1.
    long
    evaluate(std::span<const double> u, std::span<const double> v, std::span<const double> w);

    std::vector<double> g, w_dg;            ///< friction law, and its derivative by log w
    std::vector<double> sliding;            ///< b c d v [velocity]
    std::vector<double> f, f_u, f_v, w_f_w; ///< friction per reference length, its derivatives by u, v and log w

    /// Description, in the given units, of the law as it is now at a point.
    std::function<BadLaw(const Units &)>
    describe(long point) const;

  private:
    const Scene &scene_;
    const std::vector<double> points_;
    std::vector<double> b_, x_, c_, slope_;
  };

  /// Force N at fixed points, its parts and its derivatives. Derivatives that the feedback does not use have size 0.
  class BodyForceAtPoints
  {
  public:
    BodyForceAtPoints(const Scene &scene, const std::vector<double> &points);

    /// @p e is the strain; @p seen the stretches that the feedback sees (without effect if there is none); @p known_m
    /// is m if it depends on time and place only and is known.
    void
    evaluate(double t, std::span<const double> e, const StretchSeen &seen, const double *known_m = nullptr);

    std::vector<double> k;       ///< [force]
    std::vector<double> N;       ///< [force]
    std::vector<double> m;       ///< [force]
    std::vector<double> by_w;    ///< k + dm/dw [force]
    std::vector<double> by_rate; ///< dm/dw_t [force time]
    std::vector<double> by_near; ///< dm/d(w near) [force]

  private:
    std::unique_ptr<ActiveStressAtPoints> stress_;
    std::unique_ptr<FeedbackAtPoints> feedback_;
  };

  /// End conditions at s = 0 and s = L, where no force acts: the stretch is 1 - m/k, or with feedback what balances.
  class EndStretches
  {
  public:
    explicit EndStretches(const Scene &scene);

    /// False with a feedback that needs the state of the body: by another stretch than that of the end, or its rate.
    bool
    are_known() const;

    /// Needs are_known(), like the others. With feedback, numbers that are positive only if some stretch w > 0
    /// balances: m(w) + k (w - 1) = 0.
    std::pair<double, double>
    at(double t);

    double
    smallest(const double t)
    {
      const auto [left, right] = at(t);
      return std::min(left, right);
    }

    /// The stretches at both ends that balance with feedback, the next ones to 1; not a number where none does.
    std::vector<double>
    balanced(double t);

    /// Largest (k + dm/dw)/k that balanced() has met; 1 without feedback.
    double
    stiffening() const
    {
      return stiffening_;
    }

    /// k at both ends [force].
    const std::vector<double> &
    moduli() const
    {
      return force_.k;
    }

  private:
    /// Evaluates the force at both ends for the same stretch @p w.
    void
    evaluate(double t, double w);

    const ActiveStress &stress_;
    BodyForceAtPoints force_;
    double stiffening_ = 1.;
  };

  /// Stretch at another place or time, at fixed points of this rank (collective).
  class StretchElsewhere
  {
  public:
    StretchElsewhere(const Scene &scene, const Discretization &discretization, const std::vector<double> &points);

    /// @p u is the displacement at the nodes that this rank owns.
    void
    evaluate(double t, std::span<const double> u, const StretchHistory *history);

    /// Near strain [points] of this displacement, or the change of it with a change of that.
    void
    near_strain(std::span<const double> u, std::span<double> strain) const;

    std::vector<double> near, delayed; ///< stretches; of size 0 if they are not used

  private:
    const Discretization &discretization_;
    const std::vector<double> points_;
    std::optional<StrainPlaces> near_places_;
    double delay_ = 0.;
    std::vector<double> at_start_; ///< w(s, 0)
    std::vector<double> then_;     ///< displacement at the time t - delay
    /// Points on the meshes of the history that were used last.
    std::vector<std::pair<std::shared_ptr<const std::vector<Cell>>, StrainPlaces>> places_;
  };
} // namespace crawler
