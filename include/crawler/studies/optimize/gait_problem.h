// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/studies/core/parameters.h>
#include <crawler/studies/core/scene_numbers.h>
#include <crawler/studies/optimize/gait_model.h>

#include <algorithm>
#include <functional>
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
                const std::vector<Variable> &variables,
                const std::vector<double> &start,
                std::function<bool()> stops,
                const OptimizeParameters *closer = nullptr);

    /// Selection of the numbers in objective and limits.
    static GaitWishes
    wishes(const OptimizeParameters &parameters);

    struct Point
    {
      double objective;
      std::vector<double> gradient, constraints;
      std::vector<std::vector<double>> rows;                          ///< rows of the Jacobian of the limited works
      std::vector<std::shared_ptr<const std::vector<double>>> blocks; ///< other rows, unscaled
      std::string problem; ///< problem of gait or derivatives, in words: this point is no optimum
    };
    /// Returns the problem at y. Derivatives of strains are computed for active constraints only: those with @p forces,
    /// one for each constraint, other than 0.
    const Point &
    at(const std::vector<double> &y, bool with_gradients, const std::vector<double> &forces = {});

    std::size_t
    n_rows() const
    {
      return number_limits_.size();
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

    /// Products of the Jacobian of c at the point, and of its transpose, with a vector.
    void
    apply_jacobian(const Point &point, const std::vector<double> &v, std::vector<double> &result) const;
    void
    apply_transposed(const Point &point, const std::vector<double> &v, std::vector<double> &result) const;

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
    best_of(std::span<const GaitRecord> records, const OptimizeParameters &parameters, double admissible);

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

    /// Limits with their multipliers, by the multipliers of c.
    std::vector<GaitLimit>
    limits(const std::vector<double> &multipliers) const;

    /// Admissible violation of a limit, relative to it.
    double
    admissible() const
    {
      return std::max(1e-5, parameters_.tolerance);
    }

  private:
    /// Largest violation of a limit, relative to it, and the name of that.
    struct Violation
    {
      double size = 0.;
      std::string of;
    };
    /// Sets the constraints of latest_, and with @p with_gradients their derivatives.
    Violation
    set_constraints(const GaitValues &values, bool with_gradients);

    struct NumberLimit
    {
      GaitNumber::Index number;
      std::string name;
      double value;
    };
    struct BlockLimit
    {
      LimitedValues GaitValues::*values;
      std::string lower_name, upper_name; ///< empty: no such limit
      double lower, upper, scale;
      double wanted_lower, wanted_upper;
    };

    double
    objective(const GaitValues &values, std::vector<double> *gradient) const;
    /// Places of the strains with forces.
    std::vector<std::size_t>
    pulling_places(const std::vector<double> &forces) const;

    GaitModel &model_;
    const OptimizeParameters parameters_;
    const std::vector<Variable> variables_;
    const std::function<bool()> stops_;
    std::vector<NumberLimit> number_limits_;
    std::vector<BlockLimit> block_limits_;
    std::vector<std::size_t> block_sizes_;
    std::vector<double> lower_, upper_;
    double scale_ = 1.; ///< scale of the objective
    std::vector<double> latest_y_;
    bool latest_has_gradients_ = false;
    std::vector<std::size_t> latest_places_; ///< places of strains with derivatives
    Point latest_;
    std::vector<GaitRecord> records_;
  };
} // namespace crawler
