// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/general_position_form.h>
#include <crawler/equation/newton_velocity.h>

#include <algorithm>

namespace crawler
{
  GeneralPositionForm::GeneralPositionForm(const Scene &scene, const Discretization &discretization)
    : PositionForm(scene, discretization)
    , friction_laws_(scene, discretization.points(discretization.element.points))
    , force_(scene, discretization.points(discretization.element.points))
    , elsewhere_(scene, discretization, discretization.points(discretization.element.points))
  {
    const std::size_t n = static_cast<std::size_t>(discretization.n_local_cells()) * discretization.element.n;
    for (auto *field : {&e_, &w_, &u_, &v_, &rate_})
      field->resize(n);
  }

  long
  GeneralPositionForm::evaluate_laws(const double t, const ConstVector u, CellInput &in)
  {
    kernels_.states(in, u_.data(), v_.data(), e_.data(), rate_.data());
    long bad = -1;
    for (std::size_t i = 0; i < e_.size(); ++i)
    {
      w_[i] = 1. + e_[i];
      if (bad < 0 && !(w_[i] > 0.))
        bad = static_cast<long>(i);
    }
    elsewhere_.evaluate(t, u, history);
    if (bad >= 0)
      return bad;
    force_.evaluate(t, e_, {w_, rate_, elsewhere_.near, elsewhere_.delayed}, in.m);
    bad = friction_laws_.evaluate(u_, v_, w_);
    if (bad >= 0)
      describe_bad_law_ = friction_laws_.describe(bad);
    else
      bad = look_at_friction(w_, friction_laws_.g);
    laws_   = {force_.N.data(),
               friction_laws_.f.data(),
             scene.ground.profile ? friction_laws_.f_u.data() : nullptr,
               friction_laws_.f_v.data(),
               friction_laws_.w_f_w.data(),
               force_.by_w.data(),
             force_.by_rate.empty() ? nullptr : force_.by_rate.data(),
               force_.k.data(),
               force_.m.data()};
    in.laws = &laws_;
    return bad;
  }

  void
  GeneralPositionForm::add_far(const std::vector<double> &by_near, const ConstVector x, const Vector result) const
  {
    if (solves_exactly())
      return;
    const ReferenceElement &element = discretization.element;
    const unsigned int n = element.n, q = element.degree;
    std::vector<double> change(by_near.size()), local(discretization.n_local(), 0.), owned(result.size());
    elsewhere_.near_strain(x, change);
    for (std::size_t c = 0; c < discretization.n_local_cells(); ++c)
      for (unsigned int p = 0; p < n; ++p)
        for (unsigned int i = 0; i < n; ++i)
          local[c * q + i] +=
            element.weights[p] * by_near[c * n + p] * change[c * n + p] * element.derivatives[p * n + i];
    discretization.add_to_owned(local, owned);
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] += owned[i];
  }

  bool
  GeneralPositionForm::setup_jacobian(const double t, const ConstVector u, const ConstVector v, const double sigma)
  {
    const bool ok     = PositionForm::setup_jacobian(t, u, v, sigma);
    jacobian_by_near_ = force_.by_near;
    return ok;
  }

  bool
  GeneralPositionForm::solves_exactly() const
  {
    return !scene.feels_elsewhere();
  }

  void
  GeneralPositionForm::jacobian_vmult(const ConstVector x, const Vector y)
  {
    PositionForm::jacobian_vmult(x, y);
    add_far(jacobian_by_near_, x, y);
  }

  void
  GeneralPositionForm::setup_stage(const unsigned int stage, const double t, const ConstVector u, const ConstVector v)
  {
    PositionForm::setup_stage(stage, t, u, v);
    if (stage_by_near_.size() <= stage)
      stage_by_near_.resize(stage + 1);
    stage_by_near_[stage] = force_.by_near;
  }

  void
  GeneralPositionForm::stage_vmult(const unsigned int stage,
                                   const ConstVector x,
                                   const ConstVector x_dot,
                                   const Vector result)
  {
    PositionForm::stage_vmult(stage, x, x_dot, result);
    add_far(stage_by_near_[stage], x, result);
  }

  bool
  GeneralPositionForm::velocity(const double t, const ConstVector u, const Vector v)
  {
    std::fill(v.begin(), v.end(), 0.);
    return newton_velocity(
      discretization,
      v,
      [&](const ConstVector at, const Vector F) { return residual(t, u, at, F); },
      [&](const ConstVector at, const Vector change) { return solve_with_mass(t, u, at, change); });
  }

  std::unique_ptr<PositionForm>
  create_position_form(const Scene &scene, const Discretization &discretization)
  {
    if (scene.is_plain())
      return std::make_unique<PositionForm>(scene, discretization);
    return std::make_unique<GeneralPositionForm>(scene, discretization);
  }
} // namespace crawler
