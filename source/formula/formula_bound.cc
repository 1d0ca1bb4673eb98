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

  template <typename See>
  void
  FormulaBound::compute(const Interval &s, const Interval &t, const See &see)
  {
    values_[Formula::s_] = {s, 0.};
    if (formula_->used_.size() > Formula::t_) // not a formula of s alone
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
          arguments_.back().number      = argument;
          arguments_.back().jumps_known = leaves_out_jumps || formula_->dependence_[argument].on_s;
        }
        Enclosure &result = values_[operation.result];
        result            = operation.rules.bound(arguments_);
        for (Interval *const x : {&result.value, &result.rate})
          if (empty(*x))
            *x = Interval::whole();
        if (!formula_->dependence_[operation.result].on_t)
          result.rate = 0.;
        see(operation);
      }
  }

  Enclosure
  FormulaBound::operator()(const Interval &s, const Interval &t)
  {
    compute(s, t, [](const Formula::Operation &) {});
    return values_[formula_->result_];
  }

  std::vector<Interval>
  FormulaBound::sides(const Variable variable, const Interval &s, const Interval &t, const bool in_steps)
  {
    std::vector<Interval> sides;
    compute(s, t, [&](const Formula::Operation &operation) {
      if (operation.rules.side == nullptr)
        return;
      const Formula::Dependence &on = formula_->dependence_[operation.result];
      const bool counts             = variable == Variable::s ? on.on_s && (!on.on_t || (in_steps && on.on_t_in_steps))
                                                              : on.on_t && (!on.on_s || (in_steps && on.on_s_in_steps));
      if (counts)
        sides.push_back(operation.rules.side(arguments_).value);
    });
    return sides;
  }
} // namespace crawler
