// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/discretization/general_log_form.h>
#include <crawler/discretization/newton_velocity.h>
#include <crawler/model/crawler_equation.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  GeneralLogForm::GeneralLogForm(const Scene &scene, const Discretization &discretization)
    : LogStretchForm(scene, discretization)
    , sliding_(scene, discretization.points(discretization.element().nodes))
    , force_(scene, discretization.points(discretization.element().stretch_points))
    , elsewhere_(scene, discretization, discretization.points(discretization.element().stretch_points))
    , mass_(discretization)
  {
    const std::size_t n_cells = discretization.n_local_cells(), n = discretization.element().n;
    for (auto *field : {&u_, &v_, &g_, &w_dg_, &at_node_, &laws_.f, &laws_.by_v, &laws_.by_log_w, &laws_.by_u})
      field->resize(n_cells * n);
    for (auto *field : {&e_, &w_, &rate_, &laws_.by_log})
      field->resize(n_cells * q_);
  }

  long
  GeneralLogForm::evaluate(const double t, const ConstVector y, const LogCellInput &in)
  {
    const ReferenceElement &element = *in.cells.element;
    const unsigned int n            = element.n;
    for (std::size_t c = 0; c < in.cells.n_cells; ++c)
    {
      for (unsigned int i = 0; i < n; ++i)
      {
        u_[c * n + i] = in.cells.u[c * q_ + i];
        v_[c * n + i] = in.cells.v[c * q_ + i];
      }
      for (unsigned int p = 0; p < q_; ++p)
      {
        const std::size_t at = c * q_ + p;
        e_[at]               = std::expm1(in.log_w[at]);
        w_[at]               = std::exp(in.log_w[at]);
        rate_[at]            = 0.;
        for (unsigned int i = 0; i < n; ++i)
          rate_[at] += element.stretch_derivatives[p * n + i] / in.cells.cell_size[c] * in.cells.v[c * q_ + i];
      }
    }
    kernels_.friction(in, g_.data(), w_dg_.data());
    elsewhere_.evaluate(t, log_stretch(y), /*is_log=*/true, history_);
    force_.evaluate(t, e_, {w_, rate_, elsewhere_.near, elsewhere_.delayed}, in.cells.m);
    const long bad = sliding_.evaluate(u_, v_);
    for (std::size_t i = 0; i < g_.size(); ++i)
    {
      laws_.f[i]        = g_[i] * sliding_.force[i];
      laws_.by_v[i]     = g_[i] * sliding_.by_v[i];
      laws_.by_u[i]     = g_[i] * sliding_.by_u[i];
      laws_.by_log_w[i] = w_dg_[i] * sliding_.force[i];
    }
    for (std::size_t i = 0; i < e_.size(); ++i)
      laws_.by_log[i] = force_.by_w[i] * w_[i];
    laws_.by_rate    = force_.by_rate;
    laws_.by_near    = force_.by_near;
    laws_.near_slope = elsewhere_.near_slope;
    if (bad >= 0)
    {
      describe_bad_law_ = [this, bad](const Units &units)
      {
        return sliding_.describe(bad, units);
      };
      return bad;
    }
    if (dynamic_cast<const PowerFriction *>(scene_.friction.get()) != nullptr)
      return -1;
    for (std::size_t c = 0; c < in.cells.n_cells; ++c)
      for (unsigned int i = 0; i < n; ++i)
      {
        double log_w = 0.;
        for (unsigned int p = 0; p < q_; ++p)
          log_w += element.stretch_to_nodes[i * q_ + p] * in.log_w[c * q_ + p];
        at_node_[c * n + i] = std::exp(log_w);
      }
    return look_at_friction(at_node_, g_);
  }

  const LogLaws *
  GeneralLogForm::laws_at(const double t, const ConstVector y, const LogCellInput &in)
  {
    evaluate(t, y, in);
    return &laws_;
  }

  bool
  GeneralLogForm::balance(const double t, const ConstVector y, const ConstVector v, const Vector F)
  {
    const LogCellInput in = log_input(t, y, v);
    int bad               = evaluate(t, y, in) >= 0;
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &bad, 1, MPI_INT, MPI_MAX, discretization_.communicator());
    if (bad != 0)
      return false;
    const ReferenceElement &element = *in.cells.element;
    const unsigned int n            = element.n;
    node_local_.assign(discretization_.n_local(), 0.);
    for (std::size_t c = 0; c < in.cells.n_cells; ++c)
    {
      for (unsigned int i = 0; i < n; ++i)
        node_local_[c * q_ + i] += in.cells.cell_size[c] * element.node_weights[i] * laws_.f[c * n + i];
      for (unsigned int p = 0; p < q_; ++p)
        for (unsigned int i = 0; i < n; ++i)
          node_local_[c * q_ + i] +=
            element.stretch_weights[p] * force_.N[c * q_ + p] * element.stretch_derivatives[p * n + i];
    }
    discretization_.add_to_owned<double>(node_local_, F);
    return true;
  }

  bool
  GeneralLogForm::residual(const double t, const ConstVector y, const ConstVector y_dot, const Vector F)
  {
    const std::size_t n = discretization_.n_owned();
    const auto v        = velocities(y);
    if (!balance(t, y, v, velocities(F)))
      return false;
    const auto log_w_dot = log_stretch(y_dot);
    for (std::size_t i = 0; i < log_w_dot.size(); ++i)
      F[n + i] = log_w_dot[i] - rate_[i] * std::exp(-log_stretch(y)[i]);
    for (std::size_t i = 0; i < n; ++i)
      F[i] = y_dot[i] - v[i];
    return true;
  }

  void
  GeneralLogForm::change_of_near(const LogLaws &laws, const ConstVector x, const Vector change) const
  {
    const StretchFeedback *feedback = scene_.active_stress->feedback();
    if (feedback != nullptr && feedback->sees_near())
      elsewhere_.change_of_near(log_stretch(x), laws.near_slope, change);
  }

  /// By Newton's method: the friction may depend on the velocity, and the active stress on its derivative.
  bool
  GeneralLogForm::velocity(const double t, const ConstVector y, const Vector v)
  {
    std::fill(v.begin(), v.end(), 0.);
    return newton_velocity(
      discretization_,
      v,
      [&](const ConstVector at, const Vector F)
      {
        return balance(t, y, at, F);
      },
      [&](const ConstVector at, const Vector change)
      {
        evaluate(t, y, log_input(t, y, at));
        const ReferenceElement &element = discretization_.element();
        const unsigned int n            = element.n;
        auto &blocks                    = mass_.blocks();
        std::fill(blocks.begin(), blocks.end(), 0.);
        for (std::size_t c = 0; c < discretization_.n_local_cells(); ++c)
        {
          const double h = discretization_.cell_size()[c];
          for (unsigned int i = 0; i < n; ++i)
            blocks[(c * n + i) * n + i] += h * element.node_weights[i] * laws_.by_v[c * n + i];
          for (unsigned int p = 0; p < q_ && !laws_.by_rate.empty(); ++p)
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int j = 0; j < n; ++j)
                blocks[(c * n + i) * n + j] += element.stretch_weights[p] / h * laws_.by_rate[c * q_ + p] *
                                               element.stretch_derivatives[p * n + i] *
                                               element.stretch_derivatives[p * n + j];
        }
        if (!mass_.factorize())
          return false;
        mass_.solve(change, change);
        return true;
      });
  }

  CellIntegrals
  GeneralLogForm::integrals(const double t, const ConstVector y, const ConstVector v)
  {
    const LogCellInput in = log_input(t, y, v);
    evaluate(t, y, in);
    const ReferenceElement &element = *in.cells.element;
    CellIntegrals sum;
    for (std::size_t c = 0; c < in.cells.n_cells; ++c)
    {
      const double h = in.cells.cell_size[c];
      for (unsigned int i = 0; i < element.n; ++i)
      {
        const std::size_t at = c * element.n + i;
        const double ds      = h * element.node_weights[i];
        sum.displacement += ds * u_[at];
        sum.velocity += ds * v_[at];
        sum.dissipation += ds * laws_.f[at] * v_[at];
        sum.net_friction += ds * laws_.f[at];
        sum.abs_friction += ds * std::abs(laws_.f[at]);
      }
      for (unsigned int p = 0; p < q_; ++p)
      {
        const std::size_t at = c * q_ + p;
        const double ds      = h * element.stretch_weights[p];
        const double power   = equation::stress_power(force_.m[at], rate_[at]);
        sum.elastic_energy += ds * equation::elastic_energy(e_[at], force_.k[at]);
        sum.stress_power += ds * power;
        sum.positive_power += ds * std::max(power, 0.);
        sum.absolute_power += ds * std::abs(power);
      }
    }
    sum_over_ranks(sum);
    return sum;
  }

  void
  GeneralLogForm::friction(const double t, const ConstVector y, const ConstVector v, std::vector<double> &g_v)
  {
    evaluate(t, y, log_input(t, y, v));
    g_v = laws_.f;
  }
} // namespace crawler
