// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>

#include <cstddef>
#include <limits>
#include <string>
#include <utility>

namespace crawler
{
  struct Interval
  {
    double lower, upper;

    /// Of the absolute values.
    double
    largest() const
    {
      return -lower > upper ? -lower : upper;
    }
  };

  /// What a value of a formula is within in a box of places and times, and its derivative by t.
  struct Enclosure
  {
    static constexpr unsigned int no_number = std::numeric_limits<unsigned int>::max();

    Interval value, rate;
    unsigned int number = no_number; ///< of the value in its formula
    bool on_s           = false;     ///< it depends on s
  };

  /**
   * A formula of some variables, s and t unless others are named, read by muParser and then evaluated for many points
   * at a time: each operation is one loop over a block of points instead of one step of muParser's interpreter per
   * point. What depends on t only is computed once per time, what depends on s only once per mesh. Every operation is
   * muParser's, so the values are the same to the last bit. (muParser's own bulk mode reads the text again at every
   * call, and Debian's starts threads.)
   */
  class Formula
  {
  public:
    using Constants = std::vector<std::pair<std::string, double>>;

    /// Throws mu::ParserError if @p text is not a formula of the @p variables and the @p constants. FormulaAtPoints and
    /// FormulaRateAtPoints are for the variables s and t; FormulaGradient is for any.
    Formula(const std::string &text,
            const Constants &constants,
            const std::vector<std::string> &variables = {"s", "t"});

    /// Does the value depend on the variable with this number?
    bool
    uses(unsigned int variable) const;

    /// An argument of an operation: one number for all points, or one for each.
    struct Operand
    {
      const double *values;
      bool is_scalar;

      double
      operator[](const std::size_t i) const
      {
        return is_scalar ? *values : values[i];
      }
    };

    /// One operation. A skip (without a loop) goes on at `target` if no point of the block needs what stands between.
    struct Operation
    {
      using Function = void (*)();
      using Loop     = void (*)(Function, std::span<const Operand> arguments, double *result, std::size_t n);
      /// The derivative of the result, from the arguments, their derivatives and the result (one number a point each).
      using Tangent = void (*)(std::span<const double *const> arguments,
                               std::span<const double *const> rates,
                               const double *result,
                               double *rate,
                               std::size_t n);

      /// Encloses the result (formula_bound.h).
      using Bound = Enclosure (*)(std::span<const Enclosure> arguments);

      Loop loop                           = nullptr;
      Tangent tangent                     = nullptr; ///< null: the result does not change, except by jumps
      Bound bound                         = nullptr;
      Function function                   = nullptr; ///< For loops that call a function, of any type.
      std::vector<unsigned int> arguments = {};      ///< Values; for a skip the condition.
      unsigned int result                 = 0;       ///< Value.
      bool branch                         = false;   ///< Of a skip: the points where the condition is this need it.
      std::size_t target                  = 0;       ///< Of a skip.
    };

  private:
    friend class FormulaAtPoints;
    friend class FormulaRateAtPoints;
    friend class FormulaGradient;
    friend class FormulaBound;
    friend class FormulaReader;

    /// What a value depends on.
    struct Dependence
    {
      bool on_s, on_t;
    };

    static constexpr unsigned int s_ = 0, t_ = 1; ///< The values that are the variables, if these are s and t.

    std::vector<bool> used_;
    std::vector<Dependence> dependence_;
    std::vector<double> scalars_; ///< At the constants among the values what they are.
    std::vector<Operation> of_time_, of_place_, of_both_;
    std::vector<bool> kept_; ///< Values of s alone that operations of both, or the result, use.
    unsigned int result_ = 0;
  };

  /// A formula at the points of one mesh.
  class FormulaAtPoints : public ActiveStressAtPoints
  {
  public:
    FormulaAtPoints(std::shared_ptr<const Formula> formula, const std::vector<double> &points);

    void
    values(double t, std::span<double> m) override;

  private:
    static constexpr std::size_t block_size = 64; ///< The blocks of all values stay in the cache.

    void
    compute(const std::vector<Formula::Operation> &operations, std::size_t first, std::size_t n);

    /// Where @p value is for the points from @p first on.
    double *
    place(unsigned int value, std::size_t first);

    Formula::Operand
    operand(unsigned int value, std::size_t first);

    const std::shared_ptr<const Formula> formula_;
    const std::size_t n_points_;
    std::vector<double> scalars_;               ///< Values that do not depend on s.
    std::vector<std::vector<double>> of_place_; ///< Kept values that depend on s only, at all points; others are empty.
    std::vector<double> blocks_;                ///< All other values, for one block of points.
    std::vector<Formula::Operand> arguments_;   ///< Of one operation.
  };
} // namespace crawler
