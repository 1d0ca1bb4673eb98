// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/adjoint/forces_at_points.h>
#include <crawler/adjoint/run_gradient.h>
#include <crawler/mesh/reference_element.h>
#include <crawler/run/gait.h>
#include <crawler/time/radau_loops.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace crawler
{
  namespace
  {
    /// Derivative f' of fourth order from f at the places of a variation, without f itself.
    double
    derivative_of(const std::array<double, 4> &f, const Variation &variation)
    {
      return (variation.is_one_sided ? 48. * f[0] - 36. * f[1] + 16. * f[2] - 3. * f[3]
                                     : 8. * (f[2] - f[1]) - (f[3] - f[0])) /
             (12. * variation.step);
    }

    /// Round-off of changes of a quantity that is 0, in natural units.
    constexpr double round_off = 1e-15;

    /// True if both sides have derivatives that differ by more than @p rough over the step.
    bool
    has_kink(const std::array<double, 4> &f, const Variation &variation, const double rough)
    {
      constexpr double same = 0.02;
      if (variation.is_one_sided)
        return false;
      const double left = 0.5 * f[0] - 2. * f[1], right = 2. * f[2] - 0.5 * f[3]; // times the step
      return std::abs(left - right) > same * (std::abs(left) + std::abs(right)) + rough;
    }

    /// Last stride, in units of the duration, if the active stress declares its length.
    std::optional<double>
    last_stride_of(const Scene &scene)
    {
      const auto stride = stride_of(*scene.active_stress, scene.end_time);
      return stride && *stride <= 1. + 1e-9 ? stride : std::nullopt;
    }

    /// Scene of a variation: its forces, and the changes of all quantities in it.
    struct OtherScene
    {
      /// Change of a quantity, in natural units.
      struct Change
      {
        double sum       = 0.;
        double at_breaks = 0.; ///< change by jumps at start and end, or that come together; infinity: unknown
      };
      ForcesOfScene forces;
      std::optional<double> stride; ///< the last one, if it is known
      std::vector<Change> changes;  ///< [slot of an Adjoint]

      OtherScene(const Scene &scene, const Scene &own, const std::vector<double> &points, const std::size_t n_slots)
        : forces(scene, own, points)
        , stride(last_stride_of(scene))
        , changes(n_slots)
      {
      }
    };

    /// Place of a stretch in the run: w = 1 + sum slopes[j] u[first + j], where u is on the polynomial of a step
    /// through its start and its stages.
    struct StretchInRun
    {
      StretchPlace place;
      std::size_t step;
      std::vector<double> weights; ///< weights of the stages; the start has the rest
      std::size_t cell           = 0;
      std::vector<double> slopes = {};
      double strain              = 0.;
    };

    /// Adjoint of a requested quantity in all steps, and its value.
    struct Adjoint
    {
      std::size_t slot;                      ///< index in all_quantities, followed by the stretches
      Quantity quantity;                     ///< the displacement if it is none of these
      std::optional<StretchInRun> stretch;   ///< if a stretch is requested
      std::vector<double> mu;                ///< [step][stage][unknown]
      std::vector<std::vector<double>> zeta; ///< [step], mostly empty
      double value = 0.;                     ///< value in natural units
    };

    /// Field at the points, and its derivative by s.
    struct Field
    {
      std::vector<double> values, slopes;
    };

    /// Sweeps: a backward one for each quantity, and one that assembles their results.
    class GradientSweep
    {
    public:
      GradientSweep(const RecordedRun &run,
                    const std::span<const Variation> variations,
                    const std::span<const Quantity> quantities,
                    const std::span<const StretchPlace> stretches)
        : run_(run)
        , adjoint_(run.natural, run.method)
        , setup_(adjoint_.tables().setup)
        , cells_(setup_)
        , own_(run.scene, run.scene, cells_.points)
        , local_{cells_.points, std::vector<double>(cells_.size()), std::vector<double>(cells_.size()), {}, {}}
        , at_(cells_.size())
        , at_ends_(2)
        , mu_{std::vector<double>(cells_.size()), std::vector<double>(cells_.size())}
        , zeta_(mu_)
      {
        for (const Variation &variation : variations)
          for (const Scene &scene : variation.scenes)
            others_.emplace_back(scene, run.scene, cells_.points, all_quantities.size() + stretches.size());
        find_stride();
        for (const Quantity quantity : quantities)
          if (quantity == Quantity::stride         ? stride_.has_value() // the speed is the same in other units
              : quantity == Quantity::paper_energy ? run.scene.active_stress->feedback() == nullptr
                                                   : quantity != Quantity::speed)
            add_adjoint(static_cast<std::size_t>(quantity), quantity, std::nullopt);
        for (std::size_t i = 0; i < stretches.size(); ++i)
          add_adjoint(all_quantities.size() + i, Quantity::displacement, in_step(stretches[i]));
      }

      RunGradient
      compute(const std::span<const Variation> variations)
      {
        for (Adjoint &adjoint : adjoints_)
          solve(adjoint);
        look_at_end();
        BackwardStages stages(run_.steps, setup_);
        for (std::size_t step = run_.steps.times.size(); step-- > 0;)
          look(step, stages);
        for (double &s : local_.s)
          s *= run_.units.length;
        std::ranges::reverse(local_.times);
        std::ranges::reverse(local_.stress);
        RunGradient result;
        for (std::size_t i = 0; i < variations.size(); ++i)
        {
          result.quantities.push_back(derivatives(i, variations[i]));
          result.stretches.push_back(of_stretches(i, variations[i]));
        }
        result.local = std::move(local_);
        return result;
      }

    private:
      /// Changes of a quantity in the scenes of a variation; in units that may differ from scene to scene, by this
      /// function of its natural units and stride.
      template <typename Unit>
      std::array<double, 4>
      changes_of(const Adjoint &adjoint, const std::size_t variation, const Unit &unit) const
      {
        const double own = unit(run_.units, stride_);
        std::array<double, 4> all;
        for (std::size_t k = 0; k < 4; ++k)
        {
          const OtherScene &other = others_[4 * variation + k];
          all[k]                  = own * other.changes[adjoint.slot].sum +
                   adjoint.value * (unit(other.forces.inside.units, other.stride) - own);
        }
        return all;
      }

      double
      change_at_breaks(const Adjoint &adjoint, const std::size_t variation) const
      {
        double largest = 0.;
        for (std::size_t k = 0; k < 4; ++k)
          largest = std::max(largest, others_[4 * variation + k].changes[adjoint.slot].at_breaks);
        return largest;
      }

      /// Derivatives of the quantities, as far as they are known.
      Derivatives
      derivatives(const std::size_t number, const Variation &variation) const
      {
        constexpr double nothing = 1e-7;
        const bool has_strides   = std::all_of(others_.begin() + static_cast<std::ptrdiff_t>(4 * number),
                                             others_.begin() + static_cast<std::ptrdiff_t>(4 * number + 4),
                                             [](const OtherScene &other) { return other.stride.has_value(); });
        Derivatives result;
        for (const Adjoint &adjoint : adjoints_)
        {
          if (adjoint.stretch)
            continue;
          const auto put = [&](const Quantity quantity, const auto &unit) {
            const std::array<double, 4> all = changes_of(adjoint, number, unit);
            const double own = unit(run_.units, stride_), value = derivative_of(all, variation);
            // Positive work has small kinks everywhere, from point to point.
            const double rough =
              own * std::max((quantity == Quantity::positive_work ? 1e-5 : 1e-7) * std::abs(adjoint.value), round_off);
            if (own * change_at_breaks(adjoint, number) <= nothing * std::abs(variation.step * value) &&
                !has_kink(all, variation, rough))
              result[static_cast<std::size_t>(quantity)] = value;
          };
          if (is_work(adjoint.quantity))
            put(adjoint.quantity, [](const Units &units, const auto &) { return units.energy(); });
          else if (adjoint.quantity == Quantity::displacement || has_strides)
            put(adjoint.quantity, [](const Units &units, const auto &) { return units.length; });
          if (adjoint.quantity == Quantity::stride && has_strides)
            put(Quantity::speed, [](const Units &units, const auto &stride) { return units.velocity() / *stride; });
        }
        return result;
      }

      /// Derivatives of the stretches.
      std::vector<std::optional<double>>
      of_stretches(const std::size_t number, const Variation &variation) const
      {
        constexpr double rough = 1e-7;
        std::vector<std::optional<double>> result;
        for (const Adjoint &adjoint : adjoints_)
          if (adjoint.stretch)
          {
            const auto all       = changes_of(adjoint, number, [](const Units &, const auto &) { return 1.; });
            const bool is_smooth = change_at_breaks(adjoint, number) == 0. && !has_kink(all, variation, rough);
            result.push_back(is_smooth ? std::optional(derivative_of(all, variation)) : std::nullopt);
          }
        return result;
      }

      void
      add_adjoint(const std::size_t slot, const Quantity quantity, std::optional<StretchInRun> stretch)
      {
        adjoints_.push_back(
          {slot, quantity, std::move(stretch), {}, std::vector<std::vector<double>>(run_.steps.times.size())});
      }

      StretchInRun
      in_step(const StretchPlace &place) const
      {
        std::size_t step = 0;
        while (step + 1 < run_.steps.times.size() && run_.steps.times[step] < place.t)
          ++step;
        const double part = 1. + (place.t - run_.steps.times[step]) / run_.steps.sizes[step];
        StretchInRun stretch{place, step, std::vector<double>(setup_.n_stages)};
        radau::collocation_weights(
          static_cast<int>(setup_.n_stages), setup_.method.c, std::clamp(part, 0., 1.), stretch.weights.data());
        return stretch;
      }

      /// Expresses the stretch as a sum over nodes, with the displacements @p u at its time. At an end of a cell the
      /// side counts whose stretch is nearer to the known value.
      void
      look_up(StretchInRun &stretch, const std::vector<double> &u) const
      {
        constexpr double round_off = 1e-12;
        double left = 0., nearest = HUGE_VAL;
        for (std::size_t c = 0; c < setup_.n_cells; left += setup_.sizes[c++])
        {
          const double x = (stretch.place.s - left) / setup_.sizes[c];
          if (x < -round_off || x > 1. + round_off)
            continue;
          std::vector<double> slopes =
            interpolation_matrix(reference_element(setup_.degree).nodes, {std::clamp(x, 0., 1.)}, /*derivative=*/true);
          double strain = 0.;
          for (std::size_t j = 0; j < slopes.size(); ++j)
          {
            slopes[j] /= setup_.sizes[c];
            strain += slopes[j] * u[c * setup_.degree + j];
          }
          if (const double distance = std::abs(1. + strain - stretch.place.value); distance < nearest)
          {
            nearest        = distance;
            stretch.cell   = c;
            stretch.slopes = std::move(slopes);
            stretch.strain = strain;
          }
        }
      }

      /// Adds the dependence of a stretch on the step where it is, and on the start of this, the end of the one before.
      void
      add_stretch(Adjoint &adjoint, const std::size_t step, BackwardStages &stages, const LaneSources &sources)
      {
        StretchInRun &stretch = *adjoint.stretch;
        const std::size_t n   = run_.steps.end.size();
        if (step + 1 == stretch.step)
        {
          const double rest = 1. - std::accumulate(stretch.weights.begin(), stretch.weights.end(), 0.);
          for (std::size_t j = 0; j < stretch.slopes.size(); ++j)
            sources.by_end[stretch.cell * setup_.degree + j] += rest * stretch.slopes[j];
        }
        if (step != stretch.step)
          return;
        stages.go_to_stage(setup_.n_stages - 1);
        std::vector<double> u = stages.u, more(n);
        const double *z       = run_.steps.z(step);
        radau::combine(static_cast<int>(setup_.n_stages), stretch.weights.data(), z, static_cast<int>(n), more.data());
        for (std::size_t d = 0; d < n; ++d)
          u[d] += more[d] - z[(setup_.n_stages - 1) * n + d];
        look_up(stretch, u);
        for (unsigned int i = 0; i < setup_.n_stages; ++i)
          for (std::size_t j = 0; j < stretch.slopes.size(); ++j)
            sources.by_u[i * n + stretch.cell * setup_.degree + j] += stretch.weights[i] * stretch.slopes[j];
        // Strains of the parts of a body that is longer there are smaller.
        for (OtherScene &other : others_)
          other.changes[adjoint.slot].sum +=
            stretch.strain / other.forces.inside.longer(stretch.cell * cells_.per_cell) - stretch.strain;
      }

      void
      go_to_stage(BackwardStages &stages, const unsigned int stage)
      {
        stages.go_to_stage(stage);
        cells_.evaluate(stages, at_);
        at_ends_.t = stages.time;
        at_ends_.u = {stages.u.front(), stages.u.back()};
        at_ends_.v = {stages.v.front(), stages.v.back()};
      }

      void
      solve(Adjoint &adjoint)
      {
        const std::vector<double> mean = adjoint_.gradient_of_displacement();
        std::vector<double> gradient   = mean;
        if (is_work(adjoint.quantity) || adjoint.stretch)
          std::ranges::fill(gradient, 0.);
        else
          adjoint.value = run_.displacement / run_.units.length;
        const std::size_t n = gradient.size(), n_mu = setup_.n_stages * n;
        adjoint.mu.resize(run_.steps.times.size() * n_mu);
        const LaneRecord steps = // steps after a stretch have no effect on it
          adjoint.stretch ? run_.steps.first_steps(adjoint.stretch->step + 1) : run_.steps;
        BackwardStages stages(steps, setup_);
        const auto see =
          [&](const std::size_t step, const std::span<const double> mu, const std::span<const double> zeta) {
            std::ranges::copy(mu, adjoint.mu.begin() + static_cast<std::ptrdiff_t>(step * n_mu));
            adjoint.zeta[step].assign(zeta.begin(), zeta.end());
          };
        LaneAdjoint::Source source = [&](const std::size_t step, const LaneSources &sources) {
          stages.go_back(step);
          if (adjoint.stretch)
          {
            add_stretch(adjoint, step, stages, sources);
            return;
          }
          if (!is_work(adjoint.quantity))
          {
            if (step != before_stride_)
              return;
            go_to_stage(stages, setup_.n_stages - 1);
            for (std::size_t d = 0; d < n; ++d)
            {
              sources.by_end[d] = -mean[d];
              adjoint.value -= mean[d] * stages.u[d];
            }
            return;
          }
          for (unsigned int i = 0; i < setup_.n_stages; ++i)
          {
            const double weight = run_.steps.sizes[step] * setup_.method.b[i];
            go_to_stage(stages, i);
            own_.evaluate(run_.steps.times[step], at_, at_ends_);
            adjoint.value += weight * work_rate(adjoint.quantity, cells_, own_, at_, at_ends_);
            add_slopes_of_work(
              adjoint.quantity, weight, cells_, own_, at_, n, sources.by_u + i * n, sources.by_velocity + i * n);
          }
        };
        if (adjoint.quantity == Quantity::displacement && !adjoint.stretch)
          source = {};
        if (!adjoint_.solve(steps, gradient, see, source))
          throw std::runtime_error("the adjoint of a step did not converge");
      }

      /// Adds the mean displacement of a body that is longer in some places, @p factor times.
      void
      add_lengths(const Quantity quantity, const double factor)
      {
        for (OtherScene &other : others_)
          for (std::size_t p = 0; p < cells_.size(); ++p)
            other.changes[static_cast<std::size_t>(quantity)].sum +=
              factor * cells_.weight(p) * (other.forces.inside.longer(p) - 1.) * at_.u[p];
      }

      void
      look_at_end()
      {
        cells_.evaluate(run_.steps.end.data(), at_.u, at_.e);
        for (const Quantity quantity : {Quantity::displacement, Quantity::stride})
          add_lengths(quantity, 1.);
      }

      /// Accounts for the last stride, which starts at the end of this step; in other scenes at another time.
      void
      look_at_start_of_stride()
      {
        double velocity = 0.;
        for (std::size_t p = 0; p < cells_.size(); ++p)
          velocity += cells_.weight(p) * at_.v[p];
        add_lengths(Quantity::stride, -1.);
        for (OtherScene &other : others_)
          other.changes[static_cast<std::size_t>(Quantity::stride)].sum -=
            velocity * (1. - other.stride.value_or(1.) - other.forces.inside.own_time(1. - *stride_));
      }

      /// Finds the last stride of the run; none unless a step ends where it starts.
      void
      find_stride()
      {
        const auto stride = last_stride_of(run_.scene);
        if (!stride)
          return;
        before_stride_ = run_.steps.times.size();
        for (std::size_t step = 0; step < run_.steps.times.size(); ++step)
          if (std::abs(run_.steps.times[step] - (1. - *stride)) <= 1e-9)
            before_stride_ = step;
        if (std::abs(*stride - 1.) <= 1e-9 || before_stride_ < run_.steps.times.size())
          stride_ = stride;
      }

      void
      look(const std::size_t step, BackwardStages &stages)
      {
        const double end = run_.steps.times[step], h = run_.steps.sizes[step];
        stages.go_back(step);
        for (unsigned int i = setup_.n_stages; i-- > 0;)
        {
          const double weight = h * setup_.method.b[i];
          const bool is_last  = i + 1 == setup_.n_stages;
          go_to_stage(stages, i);
          if (stride_ && step == before_stride_ && is_last)
            look_at_start_of_stride();
          own_.evaluate(end, at_, at_ends_);
          for (OtherScene &other : others_)
            other.forces.evaluate(end, at_, at_ends_);
          for (const Adjoint &adjoint : adjoints_)
          {
            if (adjoint.stretch && step > adjoint.stretch->step)
              continue;
            const std::size_t n = adjoint.mu.size() / (run_.steps.times.size() * setup_.n_stages);
            cells_.evaluate(adjoint.mu.data() + (step * setup_.n_stages + i) * n, mu_.values, mu_.slopes);
            if (is_last && !adjoint.zeta[step].empty())
              cells_.evaluate(adjoint.zeta[step].data(), zeta_.values, zeta_.slopes);
            if (adjoint.slot == static_cast<std::size_t>(Quantity::displacement))
              add_local(weight);
            for (OtherScene &other : others_)
            {
              OtherScene::Change &change = other.changes[adjoint.slot];
              add_forces(other.forces.inside, change.sum);
              if (is_work(adjoint.quantity))
                change.sum += weight * (work_rate(adjoint.quantity, cells_, other.forces, at_, at_ends_) -
                                        work_rate(adjoint.quantity, cells_, own_, at_, at_ends_));
              if (is_last)
                add_impulse(adjoint, change, other.forces.inside.between(end, false), zeta_.slopes, -1., end == 1.);
              if (step == 0 && i == 0)
                add_impulse(adjoint, change, other.forces.inside.between(0., true), mu_.slopes, 1. / weight, true);
            }
          }
        }
      }

      /// Adds the changes of the forces, weighted by mu; as differences, since the sums nearly cancel.
      void
      add_forces(const ForcesAtPoints &forces, double &sum) const
      {
        for (std::size_t p = 0; p < cells_.size(); ++p)
          sum += cells_.weight(p) * ((forces.body_force(p) - own_.inside.body_force(p)) * mu_.slopes[p] +
                                     (forces.friction(p) - own_.inside.friction(p)) * mu_.values[p]);
      }

      /// @p weight is that of the stage.
      void
      add_local(const double weight)
      {
        constexpr std::size_t max_samples = 4000000;
        for (std::size_t p = 0; p < cells_.size(); ++p)
        {
          local_.elastic_modulus[p] += own_.inside.elastic(p, at_.e[p]) * mu_.slopes[p];
          local_.friction[p] += own_.inside.friction(p) * mu_.values[p];
        }
        if (run_.steps.times.size() * setup_.n_stages * cells_.size() > max_samples)
          return;
        local_.times.push_back(at_.t * run_.units.time);
        for (std::size_t p = cells_.size(); p-- > 0;)
          local_.stress.push_back(mu_.slopes[p] / (weight * run_.units.force * run_.units.time));
      }

      /// Adds the effect of an @p impulse at the points, if there is one.
      void
      add_impulse(const Adjoint &adjoint,
                  OtherScene::Change &change,
                  const std::vector<double> &impulse,
                  const std::vector<double> &effect,
                  const double factor,
                  const bool is_edge) const
      {
        double sum = 0., size = 0.;
        for (std::size_t p = 0; p < impulse.size(); ++p)
        {
          sum += factor * cells_.weight(p) * impulse[p] * effect[p];
          size += cells_.weight(p) * std::abs(impulse[p]);
        }
        change.sum += sum;
        // Impulses have effects beyond their size where friction is not linear in the velocity; and works grow in them.
        if (is_work(adjoint.quantity) && size > 0.)
          change.at_breaks = std::numeric_limits<double>::infinity();
        else if (is_edge || (setup_.laws & LaneLaws::nonlinear_in_velocity) != 0)
          change.at_breaks = std::max(change.at_breaks, std::abs(sum));
      }

      const RecordedRun &run_;
      LaneAdjoint adjoint_;
      const LaneSetup &setup_;
      const CellPoints cells_;
      ForcesOfScene own_;
      std::deque<OtherScene> others_; ///< [variation][4]
      std::vector<Adjoint> adjoints_;
      LocalSensitivity local_;
      std::optional<double> stride_;  ///< stride of the run, if it is known
      std::size_t before_stride_ = 0; ///< the step that ends where the last stride starts
      StateAtPoints at_, at_ends_;
      Field mu_, zeta_; ///< adjoint at the points
    };
  } // namespace

  bool
  have_similar_breaks(const Scene &scene, const Scene &other)
  {
    return BreakMap(breaks_in_space_of(scene), breaks_in_space_of(other)).is_one_to_one() &&
           BreakMap(breaks_in_time_of(scene), breaks_in_time_of(other)).is_good;
  }

  RunGradient
  gradient_of(const RecordedRun &run,
              const std::span<const Variation> variations,
              const std::span<const Quantity> quantities,
              const std::span<const StretchPlace> stretches)
  {
    return GradientSweep(run, variations, quantities, stretches).compute(variations);
  }
} // namespace crawler
