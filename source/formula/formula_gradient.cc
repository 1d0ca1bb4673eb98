// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/formula/formula_gradient.h>

#include <algorithm>

namespace crawler
{
  FormulaGradient::FormulaGradient(std::shared_ptr<const Formula> formula)
    : formula_(std::move(formula))
    , values_(formula_->scalars_.size() * block_size)
    , rates_(values_.size(), 0.)
  {
    for (std::size_t value = 0; value < formula_->scalars_.size(); ++value)
      std::fill_n(values_.data() + value * block_size, block_size, formula_->scalars_[value]);
  }

  /// Computes both branches of a choice; the unused one has no effect, whatever its value.
  template <typename Use>
  void
  FormulaGradient::for_operations(const std::size_t n, const Use &use)
  {
    for (const auto *list : {&formula_->of_time_, &formula_->of_place_, &formula_->of_both_})
      for (const Formula::Operation &operation : *list)
        if (operation.loop != nullptr)
          use(operation, values_.data() + operation.result * block_size, n);
  }

  void
  FormulaGradient::evaluate(const std::span<const std::span<const double>> arguments,
                            const std::span<double> f,
                            const std::span<const std::span<double>> derivatives)
  {
    for (std::size_t first = 0; first < f.size(); first += block_size)
    {
      const std::size_t n = std::min(block_size, f.size() - first);
      for (std::size_t i = 0; i < arguments.size(); ++i)
      {
        double *const block = values_.data() + i * block_size;
        if (arguments[i].size() == 1)
          std::fill_n(block, n, arguments[i][0]);
        else if (!arguments[i].empty())
          std::copy_n(arguments[i].data() + first, n, block);
      }
      for_operations(n, [&](const Formula::Operation &operation, double *result, const std::size_t size) {
        arguments_.clear();
        for (const unsigned int argument : operation.arguments)
          arguments_.push_back({values_.data() + argument * block_size, false});
        operation.loop(operation.function, arguments_, result, size);
      });
      std::copy_n(values_.data() + formula_->result_ * block_size, n, f.data() + first);

      for (std::size_t i = 0; i < derivatives.size(); ++i)
      {
        if (derivatives[i].empty())
          continue;
        std::fill_n(rates_.data() + i * block_size, block_size, 1.);
        for_operations(n, [&](const Formula::Operation &operation, const double *result, const std::size_t size) {
          if (operation.rules.tangent == nullptr)
            return;
          argument_values_.clear();
          argument_rates_.clear();
          for (const unsigned int argument : operation.arguments)
          {
            argument_values_.push_back(values_.data() + argument * block_size);
            argument_rates_.push_back(rates_.data() + argument * block_size);
          }
          operation.rules.tangent(
            argument_values_, argument_rates_, result, rates_.data() + operation.result * block_size, size);
        });
        std::copy_n(rates_.data() + formula_->result_ * block_size, n, derivatives[i].data() + first);
        std::fill_n(rates_.data() + i * block_size, block_size, 0.);
      }
    }
  }
} // namespace crawler
