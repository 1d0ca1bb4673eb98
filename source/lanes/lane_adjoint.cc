// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/lanes/lane_adjoint.h>
#include <crawler/time/radau_loops.h>

namespace crawler
{
  void
  LaneRecord::add(const LaneStep &step, const unsigned int n_stages, const std::size_t n_unknowns, const bool starts)
  {
    n_per_step_ = n_stages * n_unknowns;
    while (!times_.empty() && times_.back() > step.time - 0.5 * step.size)
    {
      times_.pop_back();
      sizes_.pop_back();
      starts_.pop_back();
      z_.resize(z_.size() - n_per_step_);
    }
    times_.push_back(step.time);
    sizes_.push_back(step.size);
    starts_.push_back(starts ? 1 : 0);
    for (std::size_t i = 0; i < n_per_step_; ++i)
      z_.push_back(step.z[i * step.stride]);
    end_.resize(n_unknowns);
    for (std::size_t i = 0; i < n_unknowns; ++i)
      end_[i] = step.y[i * step.stride];
  }

  LaneRecord
  LaneRecord::first_steps(const std::size_t n) const
  {
    LaneRecord first = *this;
    for (std::size_t step = n; step < n_steps(); ++step)
      for (std::size_t d = 0; d < end_.size(); ++d)
        first.end_[d] -= z_[(step + 1) * n_per_step_ - end_.size() + d];
    first.times_.resize(n);
    first.sizes_.resize(n);
    first.starts_.resize(n);
    first.z_.resize(n * n_per_step_);
    return first;
  }

  LanePast
  LaneRecord::past(const double *gradient, const bool has_sources) const
  {
    return {static_cast<unsigned int>(times_.size()),
            times_.data(),
            sizes_.data(),
            z_.data(),
            end_.data(),
            starts_.data(),
            gradient,
            has_sources};
  }

  LaneRecord
  LaneRecord::at_places(const std::vector<double> &c, const std::vector<double> &places) const
  {
    const std::size_t n = end_.size();
    LaneRecord other    = *this;
    other.n_per_step_   = places.size() * n;
    other.z_.assign(times_.size() * other.n_per_step_, 0.);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      double weights[radau::max_stages] = {};
      radau::collocation_weights(static_cast<int>(c.size()), c.data(), places[i], weights);
      for (std::size_t step = 0; step < times_.size(); ++step)
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
    , tables_owner_(lane_tables(method))
    , tables_(*tables_owner_)
    , memory_(lane_storage(single_engine().adjoint_memory(tables_.setup)))
  {
    if (!scene.is_plain())
      laws_.emplace(scene, tables_.points);
  }

  std::vector<double>
  LaneAdjoint::gradient_of_displacement() const
  {
    const LaneSetup &setup = tables_.setup;
    const std::size_t n    = setup.degree + 1;
    std::vector<double> gradient(setup.n_cells * setup.degree + 1, 0.);
    for (std::size_t c = 0; c < setup.n_cells; ++c)
      for (std::size_t p = 0; p < n; ++p)
        for (std::size_t i = 0; i < n; ++i)
          gradient[c * setup.degree + i] += setup.sizes[c] * setup.weights[p] * setup.values[p * n + i];
    return gradient;
  }

  std::optional<std::vector<double>>
  LaneAdjoint::solve(const LaneRecord &record,
                     const std::vector<double> &gradient,
                     const Seer &see,
                     const Source &source)
  {
    past_    = record.past(gradient.data(), static_cast<bool>(source));
    started_ = false;
    see_     = &see;
    source_  = &source;
    mu_.resize(tables_.setup.n_stages * gradient.size());
    by_start_.resize(gradient.size());
    const LaneAdjointHost host = {this, next, step, done, laws, sources};
    single_engine().adjoint(tables_.setup, host, memory_.get());
    return finished_ ? std::optional(by_start_) : std::nullopt;
  }

  bool
  LaneAdjoint::next(void *context, unsigned int, LaneJob &job, LanePast &past)
  {
    auto &self = *static_cast<LaneAdjoint *>(context);
    if (self.started_)
      return false;
    self.started_ = true;
    job.k         = self.scene_.body.elastic_modulus;
    job.a         = self.scene_.body.friction_exponent();
    if (self.laws_)
      self.laws_->set(job);
    past = self.past_;
    return true;
  }

  void
  LaneAdjoint::step(void *context, unsigned int, const LaneAdjointStep &step)
  {
    auto &self = *static_cast<LaneAdjoint *>(context);
    for (std::size_t i = 0; i < self.mu_.size(); ++i)
      self.mu_[i] = step.mu[i * step.stride];
    self.zeta_.clear();
    for (std::size_t i = 0; i < self.by_start_.size() && step.zeta != nullptr; ++i)
      self.zeta_.push_back(step.zeta[i * step.stride]);
    (*self.see_)(step.number, self.mu_, self.zeta_);
  }

  void
  LaneAdjoint::sources(void *context, unsigned int, const unsigned int step, const LaneSources &sources)
  {
    (*static_cast<LaneAdjoint *>(context)->source_)(step, sources);
  }

  void
  LaneAdjoint::done(void *context, unsigned int, const bool finished, const std::size_t stride, const double *by_start)
  {
    auto &self     = *static_cast<LaneAdjoint *>(context);
    self.finished_ = finished;
    for (std::size_t i = 0; i < self.by_start_.size(); ++i)
      self.by_start_[i] = by_start[i * stride];
  }

  bool
  LaneAdjoint::laws(void *context, unsigned int, const LanePoints &points)
  {
    return static_cast<LaneAdjoint *>(context)->laws_->evaluate(points);
  }
} // namespace crawler
