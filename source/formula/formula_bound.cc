// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/formula/formula_bound.h>

namespace crawler
{
  FormulaBound::FormulaBound(std::shared_ptr<const Formula> formula)
    : formula_(std::move(formula))
    , values_(formula_->scalars_.size())
  {
    for (unsigned int i = 0; i < values_.size(); ++i)
      values_[i] = {formula_->scalars_[i], 0.};
  }

  Enclosure
  FormulaBound::operator()(const Interval &s, const Interval &t)
  {
    values_[Formula::s_] = {s, 0.};
    values_[Formula::t_] = {t, 1.};
    for (const auto *list : {&formula_->of_time_, &formula_->of_place_, &formula_->of_both_})
      for (const Formula::Operation &operation : *list)
      {
        if (operation.loop == nullptr)
          continue;
        arguments_.clear();
        for (const unsigned int argument : operation.arguments)
        {
          arguments_.push_back(values_[argument]);
          arguments_.back().number = argument;
          arguments_.back().on_s   = formula_->dependence_[argument].on_s;
        }
        Enclosure &result = values_[operation.result];
        result            = operation.bound(arguments_);
        for (Interval *const x : {&result.value, &result.rate})
          if (empty(*x))
            *x = Interval::whole();
        if (!formula_->dependence_[operation.result].on_t)
          result.rate = 0.;
      }
    return values_[formula_->result_];
  }
} // namespace crawler
