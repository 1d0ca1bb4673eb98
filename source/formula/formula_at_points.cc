// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Evaluation of a compiled formula (formula.cc, by muParser) at the points of a mesh.
#include <crawler/formula/formula.h>

#include <algorithm>

namespace crawler
{
  bool
  Formula::uses(const unsigned int variable) const
  {
    return used_[variable];
  }

  FormulaAtPoints::FormulaAtPoints(std::shared_ptr<const Formula> formula, const std::vector<double> &points)
    : formula_(std::move(formula))
    , n_points_(points.size())
    , scalars_(formula_->scalars_)
    , of_place_(scalars_.size())
    , blocks_(scalars_.size() * std::min(block_size, n_points_))
  {
    for (std::size_t value = 0; value < scalars_.size(); ++value)
      if (formula_->kept_[value])
        of_place_[value].resize(n_points_);
    of_place_[Formula::s_] = points;
    compute(formula_->of_time_, 0, 1); // operations that are constant
    for (std::size_t first = 0; first < n_points_; first += block_size)
      compute(formula_->of_place_, first, std::min(block_size, n_points_ - first));
  }

  void
  FormulaAtPoints::values(const double t, const std::span<double> m)
  {
    scalars_[Formula::t_] = t;
    compute(formula_->of_time_, 0, 1);
    for (std::size_t first = 0; first < n_points_; first += block_size)
    {
      const std::size_t n = std::min(block_size, n_points_ - first);
      compute(formula_->of_both_, first, n);
      const Formula::Operand result = operand(formula_->result_, first);
      for (std::size_t i = 0; i < n; ++i)
        m[first + i] = result[i];
    }
  }

  void
  FormulaAtPoints::compute(const std::vector<Formula::Operation> &operations,
                           const std::size_t first,
                           const std::size_t n)
  {
    for (std::size_t position = 0; position < operations.size(); ++position)
    {
      const Formula::Operation &operation = operations[position];
      arguments_.clear();
      for (const unsigned int argument : operation.arguments)
        arguments_.push_back(operand(argument, first));
      if (operation.loop != nullptr)
      {
        operation.loop(operation.function, arguments_, place(operation.result, first), n);
        continue;
      }
      bool needed = operation.target == position + 1; // no operations to skip
      for (std::size_t i = 0; i < n && !needed; ++i)
        needed = (arguments_[0][i] != 0.) == operation.branch;
      if (!needed)
        position = operation.target - 1;
    }
  }

  double *
  FormulaAtPoints::place(const unsigned int value, const std::size_t first)
  {
    if (!formula_->dependence_[value].on_s)
      return &scalars_[value];
    if (!of_place_[value].empty())
      return of_place_[value].data() + first;
    return blocks_.data() + value * std::min(block_size, n_points_);
  }

  Formula::Operand
  FormulaAtPoints::operand(const unsigned int value, const std::size_t first)
  {
    return {place(value, first), !formula_->dependence_[value].on_s};
  }
} // namespace crawler
