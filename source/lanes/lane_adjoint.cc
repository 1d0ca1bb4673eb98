// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/lanes/lane_adjoint.h>
#include <crawler/time/radau_loops.h>

namespace crawler
{
  void
  LaneRecord::add(const LaneStep &step, const unsigned int n_stages, const std::size_t n_unknowns, const bool starts)
  {
    n_per_step_ = n_stages * n_unknowns;
    while (!times.empty() && times.back() > step.time - 0.5 * step.size)
    {
      times.pop_back();
      sizes.pop_back();
      starts_.pop_back();
      z_.resize(z_.size() - n_per_step_);
    }
    times.push_back(step.time);
    sizes.push_back(step.size);
    starts_.push_back(starts ? 1 : 0);
    for (std::size_t i = 0; i < n_per_step_; ++i)
      z_.push_back(step.z[i * step.stride]);
    end.resize(n_unknowns);
    for (std::size_t i = 0; i < n_unknowns; ++i)
      end[i] = step.y[i * step.stride];
  }

  LaneRecord
  LaneRecord::first_steps(const std::size_t n) const
  {
    LaneRecord first = *this;
    for (std::size_t step = n; step < times.size(); ++step)
      for (std::size_t d = 0; d < end.size(); ++d)
        first.end[d] -= z_[(step + 1) * n_per_step_ - end.size() + d];
    first.times.resize(n);
    first.sizes.resize(n);
    first.starts_.resize(n);
    first.z_.resize(n * n_per_step_);
    return first;
  }

  LanePast
  LaneRecord::past(const double *gradient, const bool has_sources) const
  {
    return {static_cast<unsigned int>(times.size()),
            times.data(),
            sizes.data(),
            z_.data(),
            end.data(),
            starts_.data(),
            gradient,
            has_sources};
  }

  LaneRecord
  LaneRecord::at_places(const std::vector<double> &c, const std::vector<double> &places) const
  {
    const std::size_t n = end.size();
    LaneRecord other    = *this;
    other.n_per_step_   = places.size() * n;
    other.z_.assign(times.size() * other.n_per_step_, 0.);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      double weights[radau::max_stages] = {};
      radau::collocation_weights(static_cast<int>(c.size()), c.data(), places[i], weights);
      for (std::size_t step = 0; step < times.size(); ++step)
        radau::combine(static_cast<int>(c.size()),
                       weights,
                       z(step),
                       static_cast<int>(n),
                       other.z_.data() + step * other.n_per_step_ + i * n);
    }
    return other;
  }

  LaneAdjoint::LaneAdjoint(const Scene &scene, const LaneMethod &method)
    : scene_(scene)
    , tables_(lane_tables(method))
    , memory_(single_engine().adjoint_memory(tables_->setup))
  {
    if (!scene.is_plain())
      laws_.emplace(scene, tables_->points);
  }

  std::vector<double>
  LaneAdjoint::gradient_of_displacement() const
  {
    const LaneSetup &setup = tables_->setup;
    const std::size_t n    = setup.degree + 1;
    std::vector<double> gradient(setup.n_cells * setup.degree + 1, 0.);
    for (std::size_t c = 0; c < setup.n_cells; ++c)
      for (std::size_t p = 0; p < n; ++p)
        for (std::size_t i = 0; i < n; ++i)
          gradient[c * setup.degree + i] += setup.sizes[c] * setup.element.weights[p] * setup.element.values[p * n + i];
    return gradient;
  }

  bool
  LaneAdjoint::solve(const LaneRecord &record,
                     const std::vector<double> &gradient,
                     const Seer &see,
                     const Source &source)
  {
    see_                = &see;
    source_             = &source;
    const LaneBody body = lane_body(scene_, laws_ ? &*laws_ : nullptr);
    const LanePast past = record.past(gradient.data(), static_cast<bool>(source));
    return single_engine().adjoint(tables_->setup, *this, body, past, memory_.data());
  }

  void
  LaneAdjoint::step(const unsigned int step, const double *mu, const double *zeta)
  {
    const std::size_t n = tables_->setup.n_cells * tables_->setup.degree + 1;
    (*see_)(step, {mu, tables_->setup.n_stages * n}, {zeta, zeta != nullptr ? n : 0});
  }

  void
  LaneAdjoint::sources(const unsigned int step, const LaneSources &sources)
  {
    (*source_)(step, sources);
  }
} // namespace crawler
