// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/studies/optimize/scene_family.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  /// Limit with its multiplier.
  struct GaitLimit
  {
    std::string name;  ///< its entry in section Optimize
    double value;      ///< in the user's units
    double multiplier; ///< gain of the objective for one unit more

    void
    exchange(Archive &archive)
    {
      archive(name, value, multiplier);
    }
  };

  /// Record of an evaluation: a row of the table.
  struct GaitRecord
  {
    std::vector<double> x;
    double objective; ///< in the user's units; not a number if there is a problem
    ByGaitNumber<double> numbers;
    double violation; ///< largest violation of a limit, relative to it
    std::string problem;
    std::string worst_limit{}; ///< name of the limit violated most; empty: all are kept

    void
    exchange(Archive &archive)
    {
      archive(x, objective, numbers, violation, problem, worst_limit);
    }
  };

  /**
   * Optimisation as seen by the optimiser: minimise f(y) subject to lower <= c(y) <= upper and 0 <= y <= 1, all of
   * order 1. y are the variables in their ranges; f is the objective over its magnitude at the start, with the sign
   * that is to be minimised; c are the limited numbers, each over its limit.
   */
  class GaitProblem
  {
  public:
    /// @p closer has tighter limits for the optimiser, while records tell by how much the wanted ones are violated.
    /// Throws InputError if the start has a problem; GaitModel::Interrupted as soon as @p stops returns true.
    GaitProblem(GaitModel &model,
                const OptimizeParameters &parameters,
                const std::vector<double> &start,
                std::function<bool(const GaitProblem &)> stops = {},
                const OptimizeParameters *closer               = nullptr);

    struct Point
    {
      double objective;
      std::vector<double> gradient, constraints;
      std::vector<std::vector<double>> jacobian; ///< derivatives of the constraints: [variable][constraint]
      std::string problem;                       ///< problem of gait or derivatives, in words: this point is no optimum
    };
    /// Returns the problem at y. Derivatives of strains are computed for active constraints only: those with @p forces,
    /// one for each constraint, other than 0.
    const Point &
    at(const std::vector<double> &y, bool with_gradients, const std::vector<double> &forces = {});

    /// Number of limited numbers of the gait, which are the first constraints.
    std::size_t
    n_numbers() const
    {
      return n_numbers_;
    }
    const std::vector<double> &
    lower() const
    {
      return lower_;
    }
    const std::vector<double> &
    upper() const
    {
      return upper_;
    }

    /// Scale of the objective.
    double
    scale() const
    {
      return scale_;
    }

    std::vector<double>
    to_x(const std::vector<double> &y) const;
    std::vector<double>
    to_y(const std::vector<double> &x) const;

    /// Returns the best of some evaluations: of those that keep to all limits, or else the one with the least
    /// violation.
    static const GaitRecord &
    best_of(std::span<const GaitRecord> records, const GaitObjective &objective, double admissible);

    /// Returns the latest evaluation at @p y, or a new one.
    const GaitRecord &
    record(const std::vector<double> &y);
    /// Returns the latest evaluation elsewhere than at @p y; at y if there is none.
    const GaitRecord &
    latest_beside(const std::vector<double> &y) const;
    const std::vector<GaitRecord> &
    records() const
    {
      return records_;
    }

    /// Estimates the relative gain of the objective if the slack of the limits were worth their multipliers: 0 at an
    /// optimum.
    double
    unused_limits(const std::vector<double> &y, const std::vector<double> &multipliers);

    /// Wanted limits with their multipliers, by the multipliers of c.
    std::vector<GaitLimit>
    limits(const std::vector<double> &multipliers) const;

    /// Admissible violation of a limit, relative to it.
    double
    admissible() const
    {
      return std::max(1e-5, parameters_.tolerance);
    }

  private:
    /// Limit of a number of the gait or of values at many places.
    struct Limit
    {
      std::optional<GaitNumber::Index> number;
      LimitedValues GaitValues::*values;
      std::string lower_name = "", upper_name = ""; ///< empty: no such limit
      double lower = -HUGE_VAL, upper = HUGE_VAL, wanted_lower = -HUGE_VAL, wanted_upper = HUGE_VAL, scale = 0.;
      std::size_t size = 1;

      LimitedValues
      of(const GaitValues &gait) const;
    };
    void
    add_limit(const LimitEntry &entry, double wanted, double own);
    /// Sets the constraints of latest_ and their derivatives. @p record gets the largest violation.
    void
    set_constraints(const GaitValues &values, GaitRecord &record);

    double
    objective(const GaitValues &values, std::vector<double> &gradient) const;
    /// Places of the strains with forces.
    std::vector<std::size_t>
    pulling_places(const std::vector<double> &forces) const;
    double
    range(const std::size_t i) const
    {
      return variables_[i].to - variables_[i].from;
    }

    GaitModel &model_;
    const OptimizeParameters parameters_;
    const std::vector<Variable> &variables_;
    const std::function<bool(const GaitProblem &)> stops_;
    const GaitObjective objective_;
    std::vector<Limit> limits_; ///< those of numbers first
    std::size_t n_numbers_ = 0;
    std::vector<double> lower_, upper_;
    double scale_ = 1.; ///< scale of the objective
    std::vector<double> latest_y_;
    bool latest_has_gradients_ = false;
    std::vector<std::size_t> latest_places_; ///< places of strains with derivatives
    Point latest_;
    std::vector<GaitRecord> records_;
  };
} // namespace crawler
