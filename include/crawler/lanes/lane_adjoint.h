// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/adjoint_host.h>
#include <crawler/lanes/host_laws.h>
#include <crawler/lanes/lane_tables.h>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// Record of the steps of a run by the fused engine, for its adjoint. In natural units.
  class LaneRecord
  {
  public:
    /// Adds the next accepted step, with a state of @p n_unknowns unknowns; it may replace steps that were accepted
    /// before. @p starts: the body starts anew with it.
    void
    add(const LaneStep &step, unsigned int n_stages, std::size_t n_unknowns, bool starts);

    /// Displacements [stages][unknowns] in the stages relative to the start of the step.
    const double *
    z(const std::size_t step) const
    {
      return z_.data() + step * n_per_step_;
    }

    /// Returns the first @p n of the steps.
    LaneRecord
    first_steps(std::size_t n) const;

    LanePast
    past(const double *gradient, bool has_sources) const;

    /// Returns the steps with the states of their polynomials at other places than the stages @p c; the last is 1.
    LaneRecord
    at_places(const std::vector<double> &c, const std::vector<double> &places) const;

    std::vector<double> times, sizes; ///< ends and lengths of the steps
    std::vector<double> end;          ///< last state

  private:
    std::size_t n_per_step_ = 0;
    std::vector<double> z_;
    std::vector<unsigned char> starts_;
  };

  /// Adjoint of one run in the position form.
  class LaneAdjoint : private LaneAdjointHost
  {
  public:
    /// @p scene is in natural units and must outlive it.
    LaneAdjoint(const Scene &scene, const LaneMethod &method);

    const LaneTables &
    tables() const
    {
      return *tables_;
    }

    /// Gradient [unknowns] of the mean displacement by the last state.
    std::vector<double>
    gradient_of_displacement() const;

    /// Observer of the adjoint mu, [stages][unknowns], of a step, from the last one to the first, and of zeta, which is
    /// mostly empty (LaneAdjointHost).
    using Seer = std::function<void(std::size_t step, std::span<const double> mu, std::span<const double> zeta)>;

    /// Source that gives the dependence of the quantity on a step itself, before the step is traversed.
    using Source = std::function<void(std::size_t step, const LaneSources &sources)>;

    /// Computes the adjoint of a quantity that has this @p gradient by the last state, and a @p source if there is one.
    /// Returns false if the iteration for the stages did not converge.
    bool
    solve(const LaneRecord &record, const std::vector<double> &gradient, const Seer &see, const Source &source = {});

  private:
    void
    step(unsigned int step, const double *mu, const double *zeta) override;
    void
    sources(unsigned int step, const LaneSources &sources) override;

    const Scene &scene_;
    const std::shared_ptr<const LaneTables> tables_;
    std::optional<HostLaws> laws_;
    LaneStorage memory_;
    const Seer *see_      = nullptr; ///< of the present solve, as the source
    const Source *source_ = nullptr;
  };
} // namespace crawler
