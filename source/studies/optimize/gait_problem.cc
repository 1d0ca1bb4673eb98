// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/studies/optimize/gait_problem.h>
#include <crawler/studies/optimize/scene_family.h>

#include <fmt/format.h>

#include <cmath>

namespace crawler
{
  namespace
  {
    constexpr double refused = 1e10; ///< objective where there is a problem

    double
    sign_of_direction(const OptimizeParameters &parameters)
    {
      return parameters.direction == "forward" ? 1. : -1.;
    }
  } // namespace

  GaitWishes
  GaitProblem::wishes(const OptimizeParameters &p)
  {
    GaitWishes wishes;
    const auto want = [&](const GaitNumber::Index number, const bool is_wanted) {
      wishes.numbers[number] |= is_wanted;
    };
    want(GaitNumber::displacement, p.objective != "speed");
    want(GaitNumber::speed, p.objective == "speed");
    want(GaitNumber::work, p.objective == "merit" || p.objective == "cost of transport");
    want(GaitNumber::friction_time, p.objective.ends_with("merit"));
    want(GaitNumber::dissipation, p.objective == "periodic merit");
    for (const LimitEntry &limit : limit_entries)
      if (limit.number)
        want(*limit.number, (p.*limit.value).has_value());
    wishes.strain      = p.smallest_strain || p.largest_strain;
    wishes.stress      = p.largest_stress.has_value();
    wishes.stress_rate = p.largest_stress_rate.has_value();
    return wishes;
  }

  GaitProblem::GaitProblem(GaitModel &model,
                           const OptimizeParameters &parameters,
                           const std::vector<Variable> &variables,
                           const std::vector<double> &start,
                           std::function<bool()> stops,
                           const OptimizeParameters *const closer)
    : model_(model)
    , parameters_(parameters)
    , variables_(variables)
    , stops_(std::move(stops))
  {
    const OptimizeParameters &p = parameters;
    for (const LimitEntry &limit : limit_entries)
      if (limit.number && p.*limit.value)
        number_limits_.push_back({*limit.number, limit.name, *(p.*limit.value)});
    const OptimizeParameters &own = closer != nullptr ? *closer : p;
    if (p.smallest_strain || p.largest_strain)
    {
      const double lower = p.smallest_strain.value_or(-HUGE_VAL), upper = p.largest_strain.value_or(HUGE_VAL);
      block_limits_.push_back({&GaitValues::strain,
                               p.smallest_strain ? "Smallest strain" : "",
                               p.largest_strain ? "Largest strain" : "",
                               own.smallest_strain.value_or(lower),
                               own.largest_strain.value_or(upper),
                               std::max(p.smallest_strain ? -lower : 0., p.largest_strain ? upper : 0.),
                               lower,
                               upper});
    }
    const auto limit_size = [&](LimitedValues GaitValues::*values, const char *name, const auto limit) {
      if (const std::optional<double> wanted = p.*limit)
        block_limits_.push_back({values, name, name, -*(own.*limit), *(own.*limit), *wanted, -*wanted, *wanted});
    };
    limit_size(&GaitValues::stress, "Largest stress", &OptimizeParameters::largest_stress);
    limit_size(&GaitValues::stress_rate, "Largest stress rate", &OptimizeParameters::largest_stress_rate);
    lower_.assign(number_limits_.size(), -HUGE_VAL);
    upper_.assign(number_limits_.size(), 1.);
    const GaitValues values = model.evaluate(start, /*with_gradients=*/false);
    values.require_start();
    for (const BlockLimit &limit : block_limits_)
    {
      block_sizes_.push_back((values.*limit.values).values.size());
      lower_.insert(lower_.end(), block_sizes_.back(), limit.lower / limit.scale);
      upper_.insert(upper_.end(), block_sizes_.back(), limit.upper / limit.scale);
    }
    const double first = std::abs(objective(values, nullptr));
    if (!std::isfinite(first))
      throw InputError(
        fmt::format(
          "the start has no {}, since its work is {:g}; a start that takes work is expected",
          parameters.objective,
          values.numbers[parameters.objective == "periodic merit" ? GaitNumber::dissipation : GaitNumber::work]),
        "Optimize/Variables");
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

  std::vector<double>
  GaitProblem::to_x(const std::vector<double> &y) const
  {
    std::vector<double> x(y.size());
    for (std::size_t i = 0; i < y.size(); ++i)
      x[i] = std::clamp(
        variables_[i].from + y[i] * (variables_[i].to - variables_[i].from), variables_[i].from, variables_[i].to);
    return x;
  }

  std::vector<double>
  GaitProblem::to_y(const std::vector<double> &x) const
  {
    std::vector<double> y(x.size());
    for (std::size_t i = 0; i < x.size(); ++i)
      y[i] = (x[i] - variables_[i].from) / (variables_[i].to - variables_[i].from);
    return y;
  }

  /// Objective in the user's units, to be maximised; of the cost of transport its inverse.
  double
  GaitProblem::objective(const GaitValues &values, std::vector<double> *const gradient) const
  {
    const double sign = sign_of_direction(parameters_);
    // f = sign D^1 W^power T^power
    const GaitNumber::Index first = parameters_.objective == "speed" ? GaitNumber::speed : GaitNumber::displacement;
    const bool is_merit           = parameters_.objective.ends_with("merit");
    const GaitNumber::Index energy =
      parameters_.objective == "periodic merit" ? GaitNumber::dissipation : GaitNumber::work;
    const double power_of_W = is_merit                                       ? -0.5
                              : parameters_.objective == "cost of transport" ? -1.
                                                                             : 0.,
                 power_of_T = is_merit ? -0.5 : 0.;
    const double D = values.numbers[first], W = values.numbers[energy], T = values.numbers[GaitNumber::friction_time];
    if (power_of_W != 0. && !(W > 0.))
      return NAN;
    const double by_D =
      sign * (power_of_W != 0. ? std::pow(W, power_of_W) : 1.) * (power_of_T != 0. ? std::pow(T, power_of_T) : 1.);
    if (gradient != nullptr)
    {
      gradient->assign(variables_.size(), 0.);
      for (std::size_t i = 0; i < variables_.size(); ++i)
      {
        (*gradient)[i] = by_D * values.gradients[first][i];
        if (power_of_W != 0.)
          (*gradient)[i] += by_D * D * power_of_W / W * values.gradients[energy][i];
        if (power_of_T != 0.)
          (*gradient)[i] += by_D * D * power_of_T / T * values.gradients[GaitNumber::friction_time][i];
      }
    }
    return by_D * D;
  }

  std::vector<std::size_t>
  GaitProblem::pulling_places(const std::vector<double> &forces) const
  {
    std::vector<std::size_t> places;
    if (!forces.empty() && !block_limits_.empty() && block_limits_.front().values == &GaitValues::strain)
      for (std::size_t p = 0; p < block_sizes_.front(); ++p)
        if (forces[number_limits_.size() + p] != 0.)
          places.push_back(p);
    return places;
  }

  GaitProblem::Violation
  GaitProblem::set_constraints(const GaitValues &values, const bool with_gradients)
  {
    Violation worst;
    const auto see = [&worst](const double excess, const std::string &name) {
      if (excess > worst.size)
        worst = {excess, name};
    };
    std::size_t next = 0;
    for (const NumberLimit &limit : number_limits_)
    {
      latest_.constraints[next] = values.numbers[limit.number] / limit.value;
      see(latest_.constraints[next] - 1., limit.name);
      ++next;
      if (!with_gradients)
        continue;
      latest_.rows.push_back(values.gradients[limit.number]);
      for (std::size_t i = 0; i < latest_.rows.back().size(); ++i)
        latest_.rows.back()[i] *= (variables_[i].to - variables_[i].from) / limit.value;
    }
    for (const BlockLimit &limit : block_limits_)
    {
      const LimitedValues &own = values.*limit.values;
      for (const double value : own.values)
      {
        latest_.constraints[next++] = value / limit.scale;
        see((value - limit.wanted_upper) / limit.scale, limit.upper_name);
        see((limit.wanted_lower - value) / limit.scale, limit.lower_name);
      }
      latest_.blocks.push_back(own.jacobian);
    }
    return worst;
  }

  const GaitProblem::Point &
  GaitProblem::at(const std::vector<double> &y, const bool with_gradients, const std::vector<double> &forces)
  {
    if (stops_())
      throw GaitModel::Interrupted();
    const std::vector<std::size_t> places = pulling_places(forces);
    if (y == latest_y_ && ((latest_has_gradients_ && std::ranges::includes(latest_places_, places)) || !with_gradients))
      return latest_;
    const bool is_new           = y != latest_y_;
    const std::vector<double> x = to_x(y);
    const GaitValues values     = model_.evaluate(x, with_gradients, places);
    latest_y_                   = y;
    latest_has_gradients_       = with_gradients;
    latest_places_              = places;
    latest_                     = {};
    latest_.gradient.assign(y.size(), 0.);
    latest_.constraints.assign(lower_.size(), 0.);
    std::vector<double> gradient;
    const bool is_possible = values.problem.empty();
    const double f         = is_possible ? objective(values, with_gradients ? &gradient : nullptr) : NAN;
    Violation violation;
    latest_.problem = !is_possible ? values.problem : with_gradients ? values.problem_of_gradients : "";
    if (!std::isfinite(f))
      latest_.objective = refused;
    else
    {
      latest_.objective = -f / scale_;
      if (with_gradients)
        for (std::size_t i = 0; i < y.size(); ++i)
          latest_.gradient[i] = -gradient[i] * (variables_[i].to - variables_[i].from) / scale_;
      violation = set_constraints(values, with_gradients);
    }
    if (is_new)
    {
      const double shown = parameters_.objective == "cost of transport" ? 1. / f : sign_of_direction(parameters_) * f;
      records_.push_back({x, shown, values.numbers, violation.size, values.problem, violation.of});
    }
    return latest_;
  }

  void
  GaitProblem::apply_jacobian(const Point &point, const std::vector<double> &v, std::vector<double> &result) const
  {
    std::size_t next    = 0;
    const std::size_t n = v.size();
    result.assign(lower_.size(), 0.);
    for (const auto &row : point.rows)
    {
      for (std::size_t i = 0; i < n; ++i)
        result[next] += row[i] * v[i];
      ++next;
    }
    next = number_limits_.size();
    for (std::size_t b = 0; b < point.blocks.size(); ++b)
    {
      std::vector<double> scaled(n);
      for (std::size_t i = 0; i < n; ++i)
        scaled[i] = v[i] * (variables_[i].to - variables_[i].from) / block_limits_[b].scale;
      const std::vector<double> &rows = *point.blocks[b];
      for (std::size_t p = 0; p < block_sizes_[b]; ++p, ++next)
        for (std::size_t i = 0; i < n; ++i)
          result[next] += rows[p * n + i] * scaled[i];
    }
  }

  void
  GaitProblem::apply_transposed(const Point &point, const std::vector<double> &v, std::vector<double> &result) const
  {
    const std::size_t n = variables_.size();
    result.assign(n, 0.);
    for (std::size_t r = 0; r < point.rows.size(); ++r)
      for (std::size_t i = 0; i < n; ++i)
        result[i] += v[r] * point.rows[r][i];
    std::size_t next = number_limits_.size();
    for (std::size_t b = 0; b < point.blocks.size(); ++b)
    {
      std::vector<double> sum(n);
      const std::vector<double> &rows = *point.blocks[b];
      for (std::size_t p = 0; p < block_sizes_[b]; ++p, ++next)
        if (v[next] != 0.)
          for (std::size_t i = 0; i < n; ++i)
            sum[i] += v[next] * rows[p * n + i];
      for (std::size_t i = 0; i < n; ++i)
        result[i] += sum[i] * (variables_[i].to - variables_[i].from) / block_limits_[b].scale;
    }
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
                       const OptimizeParameters &parameters,
                       const double admissible)
  {
    const bool is_cost = parameters.objective == "cost of transport";
    const double sign  = sign_of_direction(parameters);
    const auto rank    = [&](const GaitRecord &record) {
      return is_cost ? 1. / record.objective : sign * record.objective;
    };
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
    for (const NumberLimit &limit : number_limits_)
      list.push_back({limit.name, limit.value, std::max(multipliers[next++], 0.) * scale_ / limit.value});
    for (std::size_t b = 0; b < block_limits_.size(); ++b)
    {
      const BlockLimit &limit = block_limits_[b];
      double of_lower = 0., of_upper = 0.;
      for (std::size_t p = 0; p < block_sizes_[b]; ++p, ++next)
        (multipliers[next] > 0. ? of_upper : of_lower) += std::abs(multipliers[next]) * scale_ / limit.scale;
      if (limit.lower_name == limit.upper_name)
        list.push_back({limit.upper_name, limit.upper, of_lower + of_upper});
      else
      {
        if (!limit.lower_name.empty())
          list.push_back({limit.lower_name, limit.lower, -of_lower});
        if (!limit.upper_name.empty())
          list.push_back({limit.upper_name, limit.upper, of_upper});
      }
    }
    return list;
  }
} // namespace crawler
