// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/operation_rules.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /**
   * A formula of some variables, s and t unless others are named, read by muParser and then evaluated for many points
   * at a time: each operation is one loop over a block of points instead of one step of muParser's interpreter per
   * point. Values of t only are computed once per time, values of s only once per mesh. Every operation is muParser's,
   * so the values agree to the last bit. (muParser's own bulk mode parses the text at every call, and Debian's starts
   * threads.)
   */
  class Formula
  {
  public:
    using Constants = std::vector<std::pair<std::string, double>>;

    /// Compiles a formula. Throws mu::ParserError if @p text is not a formula of the @p variables and the @p constants.
    /// FormulaAtPoints needs the variables s and t; FormulaGradient takes any.
    Formula(const std::string &text,
            const Constants &constants,
            const std::vector<std::string> &variables = {"s", "t"});

    /// True if the value depends on the variable with this number.
    bool
    uses(unsigned int variable) const;

    using Operand   = FormulaOperand;
    using Operation = FormulaOperation;

  private:
    friend class FormulaAtPoints;
    friend class FormulaGradient;
    friend class FormulaBound;
    friend class FormulaReader;

    /// Dependence of a value on the variables; in steps: only by operations on this variable alone that are constant
    /// but for jumps.
    struct Dependence
    {
      bool on_s, on_t;
      bool on_s_in_steps = false, on_t_in_steps = false;
    };

    static constexpr unsigned int s_ = 0, t_ = 1; ///< Numbers of the values s and t, if these are the variables.

    std::vector<bool> used_;
    std::vector<Dependence> dependence_;
    std::vector<double> scalars_; ///< Constants among the values; other places are unused.
    std::vector<Operation> of_time_, of_place_, of_both_;
    std::vector<bool> kept_; ///< Values of s alone that are used by operations of both, or by the result.
    unsigned int result_ = 0;
  };

  /// A formula at the points of one mesh.
  class FormulaAtPoints
  {
  public:
    FormulaAtPoints(std::shared_ptr<const Formula> formula, const std::vector<double> &points);

    /// Writes the value at all points into @p m.
    void
    values(double t, std::span<double> m);

  private:
    static constexpr std::size_t block_size = 64; ///< The blocks of all values stay in the cache.

    void
    compute(const std::vector<Formula::Operation> &operations, std::size_t first, std::size_t n);

    /// Address of @p value for the points from @p first on.
    double *
    place(unsigned int value, std::size_t first);

    Formula::Operand
    operand(unsigned int value, std::size_t first);

    const std::shared_ptr<const Formula> formula_;
    const std::size_t n_points_;
    std::vector<double> scalars_;               ///< Values that do not depend on s.
    std::vector<std::vector<double>> of_place_; ///< Kept values of s only, at all points; others are empty.
    std::vector<double> blocks_;                ///< Other values, for one block of points.
    std::vector<Formula::Operand> arguments_;   ///< Arguments of one operation.
  };
} // namespace crawler
