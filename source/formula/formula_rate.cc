// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/formula/formula_rate.h>

#include <algorithm>

namespace crawler
{
  FormulaRateAtPoints::FormulaRateAtPoints(std::shared_ptr<const Formula> formula, const std::vector<double> &points)
    : formula_(std::move(formula))
    , points_(points)
    , values_(formula_->scalars_.size() * block_size)
    , rates_(values_.size(), 0.)
  {
    for (std::size_t value = 0; value < formula_->scalars_.size(); ++value)
      std::fill_n(values_.data() + value * block_size, block_size, formula_->scalars_[value]);
    std::fill_n(rates_.data() + Formula::t_ * block_size, block_size, 1.);
  }

  void
  FormulaRateAtPoints::values(const double t, const std::span<double> rate)
  {
    std::fill_n(values_.data() + Formula::t_ * block_size, block_size, t);
    for (std::size_t first = 0; first < points_.size(); first += block_size)
    {
      const std::size_t n = std::min(block_size, points_.size() - first);
      std::copy_n(points_.data() + first, n, values_.data() + Formula::s_ * block_size);
      compute(formula_->of_time_, n);
      compute(formula_->of_place_, n);
      compute(formula_->of_both_, n);
      std::copy_n(rates_.data() + formula_->result_ * block_size, n, rate.data() + first);
    }
  }

  /// Both sides of a choice are computed; the wrong one is not taken, whatever it is.
  void
  FormulaRateAtPoints::compute(const std::vector<Formula::Operation> &operations, const std::size_t n)
  {
    for (const Formula::Operation &operation : operations)
    {
      if (operation.loop == nullptr)
        continue;
      arguments_.clear();
      argument_values_.clear();
      argument_rates_.clear();
      for (const unsigned int argument : operation.arguments)
      {
        argument_values_.push_back(values_.data() + argument * block_size);
        argument_rates_.push_back(rates_.data() + argument * block_size);
        arguments_.push_back({argument_values_.back(), false});
      }
      double *const result = values_.data() + operation.result * block_size;
      operation.loop(operation.function, arguments_, result, n);
      if (operation.tangent != nullptr)
        operation.tangent(argument_values_, argument_rates_, result, rates_.data() + operation.result * block_size, n);
    }
  }
} // namespace crawler
