// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/studies/optimize/gait_problem.h>

#include <cmath>

namespace crawler
{
  GaitProblem::GaitProblem(GaitModel &model,
                           const OptimizeParameters &parameters,
                           const std::vector<double> &start,
                           std::function<bool(const GaitProblem &)> stops,
                           const OptimizeParameters *const closer)
    : model_(model)
    , parameters_(parameters)
    , variables_(model.family.variables)
    , stops_(std::move(stops))
    , objective_(objective_of(parameters))
  {
    for (const LimitEntry &limit : limit_entries)
      if (const std::optional<double> wanted = parameters.*limit.value)
        add_limit(limit, *wanted, closer != nullptr ? *(closer->*limit.value) : *wanted);
    const GaitValues values = model.evaluate(start, /*with_gradients=*/false);
    values.require_start();
    for (Limit &limit : limits_)
    {
      if (limit.scale == 0.) // the strain must not be negative
        limit.scale = 1.;
      limit.size = limit.of(values).values.size();
      lower_.insert(lower_.end(), limit.size, limit.lower / limit.scale);
      upper_.insert(upper_.end(), limit.size, limit.upper / limit.scale);
    }
    std::vector<double> none;
    const double first = std::abs(objective(values, none));
    if (!std::isfinite(first))
      refuse("Optimize/Variables",
             "the start has no {}, since its work is {:g}; a start that takes work is expected",
             objective_.name,
             values.numbers[objective_.energy]);
    if (first > 0.)
      scale_ = first;
    // Starts with hardly any motion say little about the attainable magnitude.
    const Point &point = at(to_y(start), true);
    double slope       = 0.;
    for (const double one : point.gradient)
      slope = std::max(slope, std::abs(one));
    if (slope > 10.)
      scale_ *= 0.1 * slope;
    latest_y_.clear();
    records_.clear();
  }

  void
  GaitProblem::add_limit(const LimitEntry &entry, const double wanted, const double own)
  {
    const auto known =
      std::ranges::find_if(limits_, [&](const Limit &limit) { return !entry.number && limit.values == entry.values; });
    Limit &limit = known != limits_.end() ? *known : limits_.emplace_back(Limit{entry.number, entry.values});
    n_numbers_ += entry.number ? 1 : 0;
    limit.scale = std::max(limit.scale, std::abs(wanted));
    if (entry.is_upper)
    {
      limit.upper_name   = entry.name;
      limit.upper        = own;
      limit.wanted_upper = wanted;
    }
    if (entry.is_lower)
    {
      limit.lower_name   = entry.name;
      limit.lower        = entry.is_upper ? -own : own;
      limit.wanted_lower = entry.is_upper ? -wanted : wanted;
    }
  }

  LimitedValues
  GaitProblem::Limit::of(const GaitValues &gait) const
  {
    if (!number)
      return gait.*values;
    LimitedValues one{{gait.numbers[*number]}, {}};
    for (const double derivative : gait.gradients[*number])
      one.gradients.push_back({derivative});
    return one;
  }

  std::vector<double>
  GaitProblem::to_x(const std::vector<double> &y) const
  {
    std::vector<double> x(y.size());
    for (std::size_t i = 0; i < y.size(); ++i)
      x[i] = std::clamp(variables_[i].from + y[i] * range(i), variables_[i].from, variables_[i].to);
    return x;
  }

  std::vector<double>
  GaitProblem::to_y(const std::vector<double> &x) const
  {
    std::vector<double> y(x.size());
    for (std::size_t i = 0; i < x.size(); ++i)
      y[i] = (x[i] - variables_[i].from) / range(i);
    return y;
  }

  /// Objective in the user's units, to be maximised, and its gradient if the gait has those of its numbers.
  double
  GaitProblem::objective(const GaitValues &values, std::vector<double> &gradient) const
  {
    const GaitObjective &f = objective_;
    const double D = values.numbers[f.motion], E = values.numbers[f.energy];
    if (f.power_of_energy != 0. && !(E > 0.))
      return NAN;
    const double by_D =
      f.sign * std::pow(E, f.power_of_energy) * std::pow(values.numbers[GaitNumber::friction_time], f.power_of_time);
    gradient = values.gradients[f.motion];
    for (std::size_t i = 0; i < gradient.size(); ++i)
    {
      gradient[i] *= by_D;
      for (const auto &[number, power] :
           {std::pair(f.energy, f.power_of_energy), std::pair(GaitNumber::friction_time, f.power_of_time)})
        if (power != 0.)
          gradient[i] += by_D * D * power / values.numbers[number] * values.gradients[number][i];
    }
    return by_D * D;
  }

  std::vector<std::size_t>
  GaitProblem::pulling_places(const std::vector<double> &forces) const
  {
    std::vector<std::size_t> places;
    if (!forces.empty() && limits_.size() > n_numbers_ && limits_[n_numbers_].values == &GaitValues::strain)
      for (std::size_t p = 0; p < limits_[n_numbers_].size; ++p)
        if (forces[n_numbers_ + p] != 0.)
          places.push_back(p);
    return places;
  }

  void
  GaitProblem::set_constraints(const GaitValues &values, GaitRecord &record)
  {
    const auto see = [&](const double excess, const std::string &name) {
      if (excess > record.violation)
      {
        record.violation   = excess;
        record.worst_limit = name;
      }
    };
    std::size_t next = 0;
    for (const Limit &limit : limits_)
    {
      const LimitedValues own = limit.of(values);
      for (std::size_t i = 0; i < own.gradients.size(); ++i)
        for (std::size_t p = 0; p < limit.size; ++p)
          latest_.jacobian[i][next + p] = own.gradients[i][p] * (range(i) / limit.scale);
      for (const double value : own.values)
      {
        latest_.constraints[next++] = value / limit.scale;
        see((value - limit.wanted_upper) / limit.scale, limit.upper_name);
        see((limit.wanted_lower - value) / limit.scale, limit.lower_name);
      }
    }
  }

  const GaitProblem::Point &
  GaitProblem::at(const std::vector<double> &y, const bool with_gradients, const std::vector<double> &forces)
  {
    if (stops_ && stops_(*this))
      throw GaitModel::Interrupted();
    const std::vector<std::size_t> places = pulling_places(forces);
    if (y == latest_y_ && ((latest_has_gradients_ && std::ranges::includes(latest_places_, places)) || !with_gradients))
      return latest_;
    const bool is_new        = y != latest_y_;
    const GaitValues values  = model_.evaluate(to_x(y), with_gradients, places);
    latest_y_                = y;
    latest_has_gradients_    = with_gradients;
    latest_places_           = places;
    constexpr double refused = 1e10;
    latest_                  = {refused, {}, std::vector<double>(lower_.size()), {}, values.problem};
    if (with_gradients)
      latest_.jacobian.assign(y.size(), latest_.constraints);
    if (with_gradients && values.problem.empty())
      latest_.problem = values.problem_of_gradients;
    const double f = values.problem.empty() ? objective(values, latest_.gradient) : NAN;
    GaitRecord record{to_x(y), objective_.turned(f), values.numbers, 0., values.problem};
    if (std::isfinite(f))
    {
      latest_.objective = -f / scale_;
      for (std::size_t i = 0; i < latest_.gradient.size(); ++i)
        latest_.gradient[i] = -latest_.gradient[i] * range(i) / scale_;
      set_constraints(values, record);
    }
    else
      latest_.gradient.clear();
    latest_.gradient.resize(y.size());
    if (is_new)
      records_.push_back(std::move(record));
    return latest_;
  }

  const GaitRecord &
  GaitProblem::record(const std::vector<double> &y)
  {
    const std::vector<double> x = to_x(y);
    const auto latest =
      std::find_if(records_.rbegin(), records_.rend(), [&x](const GaitRecord &record) { return record.x == x; });
    if (latest != records_.rend())
      return *latest;
    at(y, false);
    return records_.back();
  }

  const GaitRecord &
  GaitProblem::latest_beside(const std::vector<double> &y) const
  {
    const std::vector<double> x = to_x(y);
    const auto latest =
      std::find_if(records_.rbegin(), records_.rend(), [&](const auto &record) { return record.x != x; });
    return latest != records_.rend() ? *latest : records_.back();
  }

  const GaitRecord &
  GaitProblem::best_of(const std::span<const GaitRecord> records,
                       const GaitObjective &objective,
                       const double admissible)
  {
    const auto rank        = [&](const GaitRecord &record) { return objective.turned(record.objective); };
    const GaitRecord *best = &records.front();
    for (const GaitRecord &record : records)
    {
      if (!record.problem.empty() || !std::isfinite(record.objective))
        continue;
      const bool is_good = record.violation <= admissible, best_is_good = best->violation <= admissible;
      const bool is_first = !best->problem.empty() || !std::isfinite(best->objective);
      if (is_first || (is_good && !best_is_good) || (is_good && rank(record) > rank(*best)) ||
          (!is_good && !best_is_good && record.violation < best->violation))
        best = &record;
    }
    return *best;
  }

  double
  GaitProblem::unused_limits(const std::vector<double> &y, const std::vector<double> &multipliers)
  {
    const std::vector<double> c = at(y, /*with_gradients=*/false).constraints;
    double sum                  = 0.;
    for (std::size_t i = 0; i < c.size(); ++i)
      if (multipliers[i] != 0.)
        sum += std::abs(multipliers[i]) * std::max(multipliers[i] > 0. ? upper_[i] - c[i] : c[i] - lower_[i], 0.);
    return sum;
  }

  std::vector<GaitLimit>
  GaitProblem::limits(const std::vector<double> &multipliers) const
  {
    std::vector<GaitLimit> list;
    std::size_t next = 0;
    for (const Limit &limit : limits_)
    {
      double of_lower = 0., of_upper = 0.;
      for (std::size_t p = 0; p < limit.size; ++p, ++next)
        (multipliers[next] > 0. ? of_upper : of_lower) += std::abs(multipliers[next]) * scale_ / limit.scale;
      if (limit.lower_name == limit.upper_name)
        list.push_back({limit.upper_name, limit.wanted_upper, of_lower + of_upper});
      else
      {
        if (!limit.lower_name.empty())
          list.push_back({limit.lower_name, limit.wanted_lower, -of_lower});
        if (!limit.upper_name.empty())
          list.push_back({limit.upper_name, limit.wanted_upper, of_upper});
      }
    }
    return list;
  }
} // namespace crawler
