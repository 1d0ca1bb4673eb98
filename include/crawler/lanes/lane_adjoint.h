// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

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

    std::size_t
    n_steps() const
    {
      return times_.size();
    }
    double
    time(const std::size_t step) const
    {
      return times_[step];
    }
    double
    size(const std::size_t step) const
    {
      return sizes_[step];
    }
    /// Displacements [stages][unknowns] in the stages relative to the start of the step.
    const double *
    z(const std::size_t step) const
    {
      return z_.data() + step * n_per_step_;
    }
    /// Last state.
    const std::vector<double> &
    end() const
    {
      return end_;
    }

    /// Returns the first @p n of the steps.
    LaneRecord
    first_steps(std::size_t n) const;

    LanePast
    past(const double *gradient, bool has_sources) const;

    /// Returns the steps with the states of their polynomials at other places than the stages @p c; the last is 1.
    LaneRecord
    at_places(const std::vector<double> &c, const std::vector<double> &places) const;

  private:
    std::size_t n_per_step_ = 0;
    std::vector<double> times_, sizes_, z_, end_;
    std::vector<unsigned char> starts_;
  };

  /// Adjoint of one run in the position form.
  class LaneAdjoint
  {
  public:
    /// @p scene is in natural units and must outlive it.
    LaneAdjoint(const Scene &scene, const LaneMethod &method);

    const LaneTables &
    tables() const
    {
      return tables_;
    }

    /// Gradient [unknowns] of the mean displacement by the last state.
    std::vector<double>
    gradient_of_displacement() const;

    /// Observer of the adjoint mu, [stages][unknowns], of a step, from the last one to the first, and of zeta, which is
    /// mostly empty (LaneAdjointStep).
    using Seer = std::function<void(std::size_t step, std::span<const double> mu, std::span<const double> zeta)>;

    /// Source that gives the dependence of the quantity on a step itself, before the step is traversed.
    using Source = std::function<void(std::size_t step, const LaneSources &sources)>;

    /// Computes the adjoint of a quantity that has this @p gradient by the last state, and a @p source if there is one.
    /// Returns its derivative by the first state; nothing if the iteration for the stages did not converge.
    std::optional<std::vector<double>>
    solve(const LaneRecord &record, const std::vector<double> &gradient, const Seer &see, const Source &source = {});

  private:
    static bool
    next(void *context, unsigned int lane, LaneJob &job, LanePast &past);
    static void
    step(void *context, unsigned int lane, const LaneAdjointStep &step);
    static void
    sources(void *context, unsigned int lane, unsigned int step, const LaneSources &sources);
    static void
    done(void *context, unsigned int lane, bool finished, std::size_t stride, const double *by_start);
    static bool
    laws(void *context, unsigned int lane, const LanePoints &points);

    const Scene &scene_;
    const std::shared_ptr<const LaneTables> tables_owner_;
    const LaneTables &tables_;
    std::optional<HostLaws> laws_;
    LaneStorage memory_;
    // State of the present solve.
    LanePast past_;
    bool started_         = false;
    const Seer *see_      = nullptr;
    const Source *source_ = nullptr;
    std::vector<double> mu_, zeta_, by_start_;
    bool finished_ = false;
  };
} // namespace crawler
