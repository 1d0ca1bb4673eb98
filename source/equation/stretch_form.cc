// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/parabola.h>
#include <crawler/equation/crawler_equation.h>
#include <crawler/equation/newton_velocity.h>
#include <crawler/equation/stretch_form.h>
#include <crawler/mesh/block_tridiagonal_matrix.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Steep friction on a soft body makes fronts that the mean of two cells does not follow.
    constexpr double steep_exponent = -4., soft = 1e-3;
    /// Stretch below which extremes are those of the cells: parabolas are useless there.
    constexpr double nearly_empty = 0.1;
  } // namespace

  StretchMethod
  stretch_method(const Scene &scene, const bool other)
  {
    const double a            = scene.friction_exponent();
    const bool may_invert     = a > -1. && a < 0.;
    const NodeRule rule       = a >= 0. ? NodeRule::friction
                                : may_invert || (a <= steep_exponent && scene.body.elastic_modulus <= soft)
                                  ? NodeRule::upwind
                                  : NodeRule::fronts;
    const NodeRule other_rule = rule == NodeRule::fronts ? NodeRule::upwind : NodeRule::fronts;
    return {other ? other_rule : rule, may_invert && scene.is_plain()};
  }

  std::string
  reason_against_stretch_form(const Scene &scene)
  {
    if (scene.ground.profile)
      return "the friction of the ground depends on the place of each cell, and thus on the stretches of all others";
    const StretchFeedback *feedback = scene.active_stress->feedback();
    if (feedback != nullptr && feedback->facts.uses_rate && scene.ground.direction.is_uneven())
      return "the active stress depends on the rate of the stretch, and friction on the direction: the method for the "
             "equations of a step does not converge";
    if (feedback != nullptr && (feedback->facts.sees_near() || feedback->facts.delay > 0.))
      return "the active stress depends on the stretch at other places or times";
    return "";
  }

  StretchLaws::StretchLaws(const Scene &scene, const std::vector<double> &middles)
    : friction(middles.size())
    , force(scene, middles)
    , scene_(scene)
    , profile_(profile_at(scene.profiles.friction, middles))
    , w_(middles.size())
    , w_dg_(middles.size())
    , strain_(middles.size())
    , mobility_(middles.size())
    , mobility_slope_(middles.size())
  {
  }

  long
  StretchLaws::evaluate(const double t,
                        const std::span<const double> w,
                        const std::span<const double> rate,
                        const double *known_m)
  {
    constexpr double empty = 1e-30; // its mobility is 0 if friction grows without bound
    for (std::size_t j = 0; j < w.size(); ++j)
      w_[j] = std::max(w[j], empty);
    scene_.friction->values(w_, friction, w_dg_);
    long bad = -1;
    for (std::size_t j = 0; j < w.size(); ++j)
    {
      if (bad < 0 && !(friction[j] > 0.))
        bad = static_cast<long>(j);
      mobility_[j]       = 1. / (friction[j] * profile_[j]);
      mobility_slope_[j] = mobility_[j] > 0. ? -w_dg_[j] / friction[j] * mobility_[j] / w_[j] : 0.;
    }
    evaluate_force(t, w, rate, known_m);
    return bad;
  }

  void
  StretchLaws::evaluate_force(const double t,
                              const std::span<const double> w,
                              const std::span<const double> rate,
                              const double *known_m)
  {
    for (std::size_t j = 0; j < w.size(); ++j)
      strain_[j] = w[j] - 1.;
    force.evaluate(t, strain_, {w, rate, {}, {}}, known_m);
  }

  CellLaws<double>
  StretchLaws::at_cells() const
  {
    return {mobility_.data(),
            mobility_slope_.data(),
            force.N.data(),
            force.by_w.data(),
            force.by_rate.empty() ? nullptr : force.by_rate.data()};
  }

  StretchForm::StretchForm(const Scene &scene, const Discretization &discretization, const bool other)
    : Assembler(scene, discretization)
    , method_(stretch_method(scene, other))
    , power_(1. + scene.friction_exponent())
    , may_be_empty_(scene.friction_exponent() < 0.)
    , laws_(scene, discretization.points({0.5}))
    , nodes_{method_.node_rule,
             static_cast<int>(discretization.n_cells()),
             discretization.cell_size.data(),
             scene.ground.direction}
    , w_(discretization.n_cells())
    , u_(discretization.n_unknowns())
    , rate_(discretization.n_cells(), 0.)
    , node_velocities_(discretization.n_unknowns())
  {
  }

  Assembler::ConstVector
  StretchForm::stretch(const ConstVector y) const
  {
    for (std::size_t j = 0; j < w_.size(); ++j)
    {
      const double positive = std::max(y[j], 0.); // not a number stays so
      w_[j] = method_.is_power ? std::pow(power_ * positive, 1. / power_) : may_be_empty_ ? positive : y[j];
    }
    return w_;
  }

  Assembler::ConstVector
  StretchForm::displacement(const ConstVector y) const
  {
    const auto w = stretch(y);
    u_[0]        = y[w.size()];
    for (std::size_t j = 0; j < w.size(); ++j)
    {
      const double own = method_.is_power ? w[j] : y[j]; // the length of a cell may be negative within the tolerance
      u_[j + 1]        = u_[j] + discretization.cell_size[j] * (own - 1.);
    }
    return u_;
  }

  std::vector<double>
  StretchForm::stretch_slopes(const ConstVector y) const
  {
    const auto w        = stretch(y);
    const auto &h       = discretization.cell_size;
    const std::size_t n = w.size();
    std::vector<double> slopes(n, 0.);
    if (n == 1)
      return slopes;
    for (std::size_t j = 0; j < n; ++j)
    {
      const auto to     = [&](const std::size_t other) { return (w[other] - w[j]) / (0.5 * (h[j] + h[other])); };
      const double left = j > 0 ? -to(j - 1) : to(j + 1), right = j + 1 < n ? to(j + 1) : left;
      slopes[j] = left * right > 0. ? std::copysign(std::min(std::abs(left), std::abs(right)), left) * h[j] : 0.;
      if (j == 0 || j + 1 == n) // keeps it above 0 at the end of the body
        slopes[j] = std::clamp(slopes[j], -2. * w[j], 2. * w[j]);
    }
    return slopes;
  }

  void
  StretchForm::find_rate(const ConstVector v) const
  {
    for (std::size_t j = 0; j < rate_.size(); ++j)
      rate_[j] = (v[j + 1] - v[j]) / discretization.cell_size[j];
  }

  long
  StretchForm::evaluate(const double t, const ConstVector w, const ConstVector v) const
  {
    find_rate(v);
    const long bad = laws_.evaluate(t, w, rate_);
    nodes_.laws    = laws_.at_cells();
    return bad;
  }

  std::vector<double>
  StretchForm::node_friction(const double t, const ConstVector y, const ConstVector v) const
  {
    evaluate(t, stretch(y), v);
    std::vector<double> friction;
    for (int i = 0; i <= nodes_.n; ++i)
      friction.push_back(nodes_.force(i).slope);
    return friction;
  }

  StretchRange
  StretchForm::stretch_range(const ConstVector y)
  {
    const auto w        = stretch(y);
    const std::size_t n = w.size();
    const auto &left = discretization.cell_left, &size = discretization.cell_size;
    const auto middle = [&](const std::size_t j) { return left[j] + 0.5 * size[j]; };
    if (n == 1)
      return {{w[0], middle(0)}, {w[0], middle(0)}};
    std::size_t least = 0, most = 0;
    for (std::size_t j = 0; j < n; ++j)
    {
      if (w[j] < w[least] || std::isnan(w[j]))
        least = j;
      if (w[j] > w[most])
        most = j;
    }
    // Straight lines and parabolas beside jumps may fall far below the values of the cells, even below 0.
    const auto is_credible = [](const double value, const double of_cell) {
      return of_cell > nearly_empty && value > 0.5 * of_cell;
    };
    const auto sharpened = [&](const std::size_t j) -> StretchAt {
      if (j == 0 || j + 1 == n) // the end of the body, from the two cells there
      {
        const std::size_t next = j == 0 ? 1 : n - 2, end = j == 0 ? 0 : n - 1;
        const double value = w[end] + (w[end] - w[next]) * 0.5 * size[end] / std::abs(middle(next) - middle(end));
        return is_credible(value, w[end]) ? StretchAt{value, j == 0 ? 0. : discretization.length}
                                          : StretchAt{w[j], middle(j)};
      }
      const auto [s, value] = parabola_vertex(middle(j - 1), w[j - 1], middle(j), w[j], middle(j + 1), w[j + 1]);
      const bool inside = s > middle(j - 1) && s < middle(j + 1) && std::isfinite(value) && is_credible(value, w[j]);
      return inside ? StretchAt{value, s} : StretchAt{w[j], middle(j)};
    };
    return {sharpened(least), sharpened(most)};
  }

  void
  StretchForm::set_initial_state(const Vector y)
  {
    const std::size_t n = w_.size();
    std::vector<double> w(n, 1.);
    if (scene.profiles.initial_stretch)
    {
      const auto &formula = reference_element(ReferenceElement::highest_degree);
      const auto places   = discretization.points(formula.points);
      std::vector<double> values(places.size());
      scene.profiles.initial_stretch->values(places, values);
      for (std::size_t j = 0; j < n; ++j)
      {
        w[j] = 0.;
        for (unsigned int p = 0; p < formula.n; ++p)
          w[j] += formula.weights[p] * values[j * formula.n + p];
      }
    }
    for (std::size_t j = 0; j < n; ++j)
      y[j] = method_.is_power ? std::pow(w[j], power_) / power_ : w[j];
    y[n]         = 0.;
    const auto u = displacement(y);
    double mean  = 0.;
    for (std::size_t j = 0; j < n; ++j)
      mean += 0.5 * discretization.cell_size[j] * (u[j] + u[j + 1]);
    y[n] = -mean / discretization.length;
  }

  bool
  StretchForm::velocity(const double t, const ConstVector y, const Vector v)
  {
    const auto w        = stretch(y);
    const auto residual = [&](const ConstVector at, const Vector F) {
      if (evaluate(t, w, at) >= 0)
      {
        look_at_friction(w, laws_.friction);
        return false;
      }
      nodes_.velocities(node_velocities_.data());
      for (int i = 0; i <= nodes_.n; ++i)
        F[i] = at[i] - node_velocities_[i];
      return true;
    };
    std::fill(v.begin(), v.end(), 0.);
    const StretchFeedback *feedback = scene.active_stress->feedback();
    if (feedback == nullptr || !feedback->facts.uses_rate) // the residual of rest is minus the velocity
    {
      if (!residual(v, v))
        return false;
      for (double &value : v)
        value = 0. - value;
      return std::ranges::all_of(v, [](const double value) { return std::isfinite(value); });
    }
    BlockTridiagonalMatrix<double> matrix(discretization);
    const auto solve = [&](const ConstVector at, const Vector F) {
      evaluate(t, w, at);
      auto left = nodes_.with_derivatives(0);
      for (int j = 0; j < nodes_.n; ++j)
      {
        const auto right     = nodes_.with_derivatives(j + 1);
        const double by_left = left.by_right_rate / nodes_.h[j], by_right = right.by_left_rate / nodes_.h[j];
        double *const block = matrix.blocks.data() + 4 * j;
        block[0]            = 1. + by_left;
        block[1]            = -by_left;
        block[2]            = by_right;
        block[3]            = (j + 1 < nodes_.n ? 0. : 1.) - by_right;
        left                = right;
      }
      if (!matrix.factorize())
        return false;
      matrix.solve(F, F);
      return true;
    };
    return newton_velocity(discretization, v, residual, solve);
  }

  CellIntegrals
  StretchForm::integrals(const double t, const ConstVector y, const ConstVector v)
  {
    const auto u = displacement(y);
    const auto w = ConstVector(w_);
    find_rate(v);
    laws_.evaluate_force(t, w, rate_);
    const auto &h                  = discretization.cell_size;
    const BodyForceAtPoints &force = laws_.force;
    CellIntegrals sum;
    for (std::size_t j = 0; j < w.size(); ++j)
    {
      const double strain = (u[j + 1] - u[j]) / h[j], power = equation::stress_power(force.m[j], rate_[j]);
      sum.displacement += 0.5 * h[j] * (u[j] + u[j + 1]);
      sum.velocity += 0.5 * h[j] * (v[j] + v[j + 1]);
      sum.elastic_energy += h[j] * equation::elastic_energy(strain, force.k[j]);
      sum.stress_power += h[j] * power;
      sum.positive_power += h[j] * std::max(power, 0.);
      sum.absolute_power += h[j] * std::abs(power);
    }
    // Friction balances the forces in the body.
    for (std::size_t i = 0; i <= w.size(); ++i)
    {
      const double f = (i < w.size() ? force.N[i] : 0.) - (i > 0 ? force.N[i - 1] : 0.);
      sum.dissipation += f * v[i];
      sum.net_friction += f;
      sum.abs_friction += std::abs(f);
    }
    return sum;
  }

  std::pair<double, double>
  StretchForm::lost_places(const double t, const ConstVector y, const double reach)
  {
    std::vector<double> v(discretization.n_unknowns());
    if (!velocity(t, y, v))
      return {0., 0.};
    const auto w  = stretch(y);
    const auto &h = discretization.cell_size;
    std::pair<double, double> places{discretization.length, 0.};
    for (std::size_t j = 0; j < w.size(); ++j)
    {
      // Power w^(1+a) goes linearly to 0.
      const double rate = power_ * (v[j + 1] - v[j]) / h[j];
      if (w[j] <= 0. || (rate < 0. && w[j] <= -rate * reach))
      {
        const double s = discretization.cell_left[j] + 0.5 * h[j];
        places         = {std::min(places.first, s), std::max(places.second, s)};
      }
    }
    return places;
  }
} // namespace crawler
