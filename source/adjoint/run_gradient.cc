// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/adjoint/forces_at_points.h>
#include <crawler/adjoint/run_gradient.h>
#include <crawler/mesh/reference_element.h>
#include <crawler/run/gait.h>
#include <crawler/time/radau_loops.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
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

    /// Direction of variation of one number: the forces in the four scenes, and their changes.
    struct Direction
    {
      /// Change of a quantity, in natural units.
      struct Change
      {
        std::array<double, 4> sums = {};
        double at_breaks           = 0.; ///< change by jumps at start and end, or that come together; infinity: unknown
      };
      std::array<std::unique_ptr<ForcesOfScene>, 4> forces;
      std::array<double, 4> strides = {}; ///< the last ones, if they are known
      bool has_strides              = true;
      std::vector<Change> changes; ///< [slot of an Adjoint]
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
      StretchInRun *stretch;                 ///< null unless a stretch is requested
      std::vector<double> mu;                ///< [step][stage][unknown]
      std::vector<std::vector<double>> zeta; ///< [step], mostly empty
      double value = 0.;                     ///< value in natural units
    };

    /// Last stride, in units of the duration, if the active stress declares its length.
    std::optional<double>
    last_stride_of(const Scene &scene)
    {
      const auto stride = stride_of(*scene.active_stress, scene.end_time);
      return stride && *stride <= 1. + 1e-9 ? stride : std::nullopt;
    }

    /// Sweeps: a backward one for each quantity, and one that assembles their results.
    class GradientSweep
    {
    public:
      GradientSweep(const RecordedRun &run,
                    const std::span<const Variation> variations,
                    const std::span<const Quantity> quantities,
                    const std::span<const StretchPlace> stretches,
                    LocalSensitivity &local)
        : run_(run)
        , local_(local)
        , adjoint_(run.natural, run.method)
        , setup_(adjoint_.tables().setup)
        , tableau_(radau_tableau(setup_.n_stages))
        , cells_(setup_)
        , own_(run.scene, run.scene, cells_.points())
        , works_(cells_)
        , at_(cells_.size())
        , at_ends_(2)
        , mu_(cells_.size())
        , mu_s_(cells_.size())
        , zeta_(cells_.size())
        , zeta_s_(cells_.size())
      {
        for (const Variation &variation : variations)
        {
          Direction &direction = directions_.emplace_back();
          direction.changes.resize(all_quantities.size() + stretches.size());
          for (std::size_t k = 0; k < 4; ++k)
            direction.forces[k] = std::make_unique<ForcesOfScene>(variation.scenes[k], run.scene, cells_.points());
        }
        find_stride(variations);
        for (const Quantity quantity : quantities)
          if (quantity == Quantity::stride         ? stride_.has_value() // the speed is the same in other units
              : quantity == Quantity::paper_energy ? run.scene.active_stress->feedback() == nullptr
                                                   : quantity != Quantity::speed)
            add_adjoint(static_cast<std::size_t>(quantity), quantity);
        for (const StretchPlace &place : stretches)
          stretches_.push_back(in_step(place));
        for (std::size_t i = 0; i < stretches_.size(); ++i)
          add_adjoint(all_quantities.size() + i, Quantity::displacement, &stretches_[i]);
        constexpr std::size_t max_samples = 4000000;
        keeps_stress_                     = run.steps.n_steps() * tableau_.n * cells_.size() <= max_samples;
        local_ = {cells_.points(), std::vector<double>(cells_.size()), std::vector<double>(cells_.size()), {}, {}};
      }

      void
      make()
      {
        for (Adjoint &adjoint : adjoints_)
          solve(adjoint);
        look_at_end();
        BackwardStages stages(run_.steps, tableau_);
        for (std::size_t step = run_.steps.n_steps(); step-- > 0;)
          look(step, stages);
        for (double &s : local_.s)
          s *= run_.units.length;
        std::ranges::reverse(local_.times);
        std::ranges::reverse(local_.stress);
      }

      /// Derivatives of the quantities, as far as they are known.
      Derivatives
      derivatives(const std::size_t number, const Variation &variation) const
      {
        constexpr double nothing   = 1e-7;
        const Direction &direction = directions_[number];
        Derivatives result;
        for (const Adjoint &adjoint : adjoints_)
        {
          if (adjoint.stretch != nullptr)
            continue;
          const auto put = [&](const Quantity quantity, const double own, const std::array<double, 4> &units) {
            const Direction::Change &change = direction.changes[adjoint.slot];
            std::array<double, 4> all;
            for (std::size_t k = 0; k < 4; ++k)
              all[k] = own * change.sums[k] + adjoint.value * (units[k] - own);
            const double value = derivative_of(all, variation);
            // Positive work has small kinks everywhere, from point to point.
            const double rough =
              own * std::max((quantity == Quantity::positive_work ? 1e-5 : 1e-7) * std::abs(adjoint.value), round_off);
            if (own * change.at_breaks <= nothing * std::abs(variation.step * value) &&
                !has_kink(all, variation, rough))
              result[static_cast<std::size_t>(quantity)] = value;
          };
          std::array<double, 4> energies, lengths, speeds;
          for (std::size_t k = 0; k < 4; ++k)
          {
            const Units &units = direction.forces[k]->inside.units();
            energies[k]        = units.energy();
            lengths[k]         = units.length;
            speeds[k]          = stride_ ? units.velocity() / direction.strides[k] : 0.;
          }
          if (is_work(adjoint.quantity))
            put(adjoint.quantity, run_.units.energy(), energies);
          else if (adjoint.quantity == Quantity::displacement || direction.has_strides)
            put(adjoint.quantity, run_.units.length, lengths);
          if (adjoint.quantity == Quantity::stride && direction.has_strides)
            put(Quantity::speed, run_.units.velocity() / *stride_, speeds);
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
          if (adjoint.stretch != nullptr)
          {
            const Direction::Change &change = directions_[number].changes[adjoint.slot];
            const bool is_smooth            = change.at_breaks == 0. && !has_kink(change.sums, variation, rough);
            result.push_back(is_smooth ? std::optional(derivative_of(change.sums, variation)) : std::nullopt);
          }
        return result;
      }

    private:
      void
      add_adjoint(const std::size_t slot, const Quantity quantity, StretchInRun *const stretch = nullptr)
      {
        adjoints_.push_back({slot, quantity, stretch, {}, std::vector<std::vector<double>>(run_.steps.n_steps())});
      }

      StretchInRun
      in_step(const StretchPlace &place) const
      {
        std::size_t step = 0;
        while (step + 1 < run_.steps.n_steps() && run_.steps.time(step) < place.t)
          ++step;
        const double part = 1. + (place.t - run_.steps.time(step)) / run_.steps.size(step);
        StretchInRun stretch{place, step, std::vector<double>(tableau_.n)};
        radau::collocation_weights(
          static_cast<int>(tableau_.n), tableau_.c.data(), std::clamp(part, 0., 1.), stretch.weights.data());
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
      add_stretch(const Adjoint &adjoint, const std::size_t step, BackwardStages &stages, const LaneSources &sources)
      {
        StretchInRun &stretch = *adjoint.stretch;
        const std::size_t n   = run_.steps.end().size();
        if (step + 1 == stretch.step)
        {
          const double rest = 1. - std::accumulate(stretch.weights.begin(), stretch.weights.end(), 0.);
          for (std::size_t j = 0; j < stretch.slopes.size(); ++j)
            sources.by_end[stretch.cell * setup_.degree + j] += rest * stretch.slopes[j];
        }
        if (step != stretch.step)
          return;
        stages.go_to_stage(tableau_.n - 1);
        std::vector<double> u = stages.u(), more(n);
        const double *z       = run_.steps.z(step);
        radau::combine(static_cast<int>(tableau_.n), stretch.weights.data(), z, static_cast<int>(n), more.data());
        for (std::size_t d = 0; d < n; ++d)
          u[d] += more[d] - z[(tableau_.n - 1) * n + d];
        look_up(stretch, u);
        for (unsigned int i = 0; i < tableau_.n; ++i)
          for (std::size_t j = 0; j < stretch.slopes.size(); ++j)
            sources.by_u[i * n + stretch.cell * setup_.degree + j] += stretch.weights[i] * stretch.slopes[j];
        // Strains of the parts of a body that is longer there are smaller.
        for (Direction &direction : directions_)
          for (std::size_t k = 0; k < 4; ++k)
            direction.changes[adjoint.slot].sums[k] +=
              stretch.strain / direction.forces[k]->inside.longer(stretch.cell * cells_.per_cell()) - stretch.strain;
      }

      void
      go_to_stage(BackwardStages &stages, const unsigned int stage)
      {
        stages.go_to_stage(stage);
        cells_.evaluate(stages.u(), stages.v(), at_);
        at_ends_.u = {stages.u().front(), stages.u().back()};
        at_ends_.v = {stages.v().front(), stages.v().back()};
      }

      void
      solve(Adjoint &adjoint)
      {
        const std::vector<double> mean = adjoint_.gradient_of_displacement();
        std::vector<double> gradient   = mean;
        if (is_work(adjoint.quantity) || adjoint.stretch != nullptr)
          std::ranges::fill(gradient, 0.);
        else
          adjoint.value = run_.displacement / run_.units.length;
        const std::size_t n = gradient.size(), n_mu = tableau_.n * n;
        adjoint.mu.resize(run_.steps.n_steps() * n_mu);
        const LaneRecord steps = // steps after a stretch have no effect on it
          adjoint.stretch != nullptr ? run_.steps.first_steps(adjoint.stretch->step + 1) : run_.steps;
        BackwardStages stages(steps, tableau_);
        std::vector<ForcesAtPoints::Slopes> slopes;
        const auto see =
          [&](const std::size_t step, const std::span<const double> mu, const std::span<const double> zeta) {
            std::ranges::copy(mu, adjoint.mu.begin() + static_cast<std::ptrdiff_t>(step * n_mu));
            adjoint.zeta[step].assign(zeta.begin(), zeta.end());
          };
        LaneAdjoint::Source source = [&](const std::size_t step, const LaneSources &sources) {
          stages.go_back(step);
          if (adjoint.stretch != nullptr)
          {
            add_stretch(adjoint, step, stages, sources);
            return;
          }
          if (!is_work(adjoint.quantity))
          {
            if (step != before_stride_)
              return;
            go_to_stage(stages, tableau_.n - 1);
            for (std::size_t d = 0; d < n; ++d)
            {
              sources.by_end[d] = -mean[d];
              adjoint.value -= mean[d] * stages.u()[d];
            }
            return;
          }
          for (unsigned int i = 0; i < tableau_.n; ++i)
          {
            const double weight = run_.steps.size(step) * tableau_.b[i];
            go_to_stage(stages, i);
            own_.evaluate(stages.time(), run_.steps.time(step), at_, at_ends_);
            adjoint.value += weight * works_.rate(adjoint.quantity, own_, at_, at_ends_);
            own_.inside.slopes(slopes);
            works_.add_slopes(
              adjoint.quantity, weight, own_, slopes, at_, n, sources.by_u + i * n, sources.by_velocity + i * n);
          }
        };
        if (adjoint.quantity == Quantity::displacement && adjoint.stretch == nullptr)
          source = {};
        if (!adjoint_.solve(steps, gradient, see, source))
          throw std::runtime_error("the adjoint of a step did not converge");
      }

      static Direction::Change &
      change_of(Direction &direction, const Quantity quantity)
      {
        return direction.changes[static_cast<std::size_t>(quantity)];
      }

      /// Adds the mean displacement of a body that is longer in some places, @p factor times.
      void
      add_lengths(const Quantity quantity, const double factor)
      {
        for (Direction &direction : directions_)
          for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t p = 0; p < cells_.size(); ++p)
              change_of(direction, quantity).sums[k] +=
                factor * cells_.weight(p) * (direction.forces[k]->inside.longer(p) - 1.) * at_.u[p];
      }

      void
      look_at_end()
      {
        cells_.evaluate(run_.steps.end().data(), at_.u, at_.e);
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
        for (Direction &direction : directions_)
          for (std::size_t k = 0; k < 4; ++k)
            change_of(direction, Quantity::stride).sums[k] -=
              velocity * (1. - direction.strides[k] - direction.forces[k]->inside.own_time(1. - *stride_));
      }

      /// Finds the last stride of the run and of the scenes that differ; none unless a step ends where it starts.
      void
      find_stride(const std::span<const Variation> variations)
      {
        const auto stride = last_stride_of(run_.scene);
        if (!stride)
          return;
        before_stride_ = run_.steps.n_steps();
        for (std::size_t step = 0; step < run_.steps.n_steps(); ++step)
          if (std::abs(run_.steps.time(step) - (1. - *stride)) <= 1e-9)
            before_stride_ = step;
        if (std::abs(*stride - 1.) > 1e-9 && before_stride_ == run_.steps.n_steps())
          return;
        for (std::size_t i = 0; i < variations.size(); ++i)
          for (std::size_t k = 0; k < 4; ++k)
          {
            const auto other           = last_stride_of(variations[i].scenes[k]);
            directions_[i].strides[k]  = other.value_or(1.);
            directions_[i].has_strides = directions_[i].has_strides && other;
          }
        stride_ = stride;
      }

      void
      look(const std::size_t step, BackwardStages &stages)
      {
        const double end = run_.steps.time(step), h = run_.steps.size(step);
        stages.go_back(step);
        for (unsigned int i = tableau_.n; i-- > 0;)
        {
          const double weight = h * tableau_.b[i];
          go_to_stage(stages, i);
          if (stride_ && step == before_stride_ && i + 1 == tableau_.n)
            look_at_start_of_stride();
          own_.evaluate(stages.time(), end, at_, at_ends_);
          for (Direction &direction : directions_)
            for (std::size_t k = 0; k < 4; ++k)
              direction.forces[k]->evaluate(stages.time(), end, at_, at_ends_);
          for (const Adjoint &adjoint : adjoints_)
          {
            if (adjoint.stretch != nullptr && step > adjoint.stretch->step)
              continue;
            const std::size_t n = adjoint.mu.size() / (run_.steps.n_steps() * tableau_.n);
            cells_.evaluate(adjoint.mu.data() + (step * tableau_.n + i) * n, mu_, mu_s_);
            if (i + 1 == tableau_.n && !adjoint.zeta[step].empty())
              cells_.evaluate(adjoint.zeta[step].data(), zeta_, zeta_s_);
            if (adjoint.slot == static_cast<std::size_t>(Quantity::displacement))
              add_local(stages.time(), weight);
            for (Direction &direction : directions_)
              for (std::size_t k = 0; k < 4; ++k)
              {
                ForcesAtPoints &forces    = direction.forces[k]->inside;
                Direction::Change &change = direction.changes[adjoint.slot];
                add_forces(forces, change.sums[k]);
                if (is_work(adjoint.quantity))
                  change.sums[k] += weight * (works_.rate(adjoint.quantity, *direction.forces[k], at_, at_ends_) -
                                              works_.rate(adjoint.quantity, own_, at_, at_ends_));
                if (i + 1 == tableau_.n && forces.has_between(end, false))
                  add_impulse(adjoint, change, k, forces.between(end, false), zeta_s_, -1., end == 1.);
                if (step == 0 && i == 0 && forces.has_between(0., true))
                  add_impulse(adjoint, change, k, forces.between(0., true), mu_s_, 1. / weight, true);
              }
          }
        }
      }

      /// Adds the changes of the forces, weighted by mu; as differences, since the sums nearly cancel.
      void
      add_forces(const ForcesAtPoints &forces, double &sum) const
      {
        for (std::size_t p = 0; p < cells_.size(); ++p)
          sum += cells_.weight(p) * ((forces.body_force(p) - own_.inside.body_force(p)) * mu_s_[p] +
                                     (forces.friction(p) - own_.inside.friction(p)) * mu_[p]);
      }

      /// @p weight is that of the stage.
      void
      add_local(const double time, const double weight)
      {
        for (std::size_t p = 0; p < cells_.size(); ++p)
        {
          local_.elastic_modulus[p] += own_.inside.elastic(p, at_.e[p]) * mu_s_[p];
          local_.friction[p] += own_.inside.friction(p) * mu_[p];
        }
        if (!keeps_stress_)
          return;
        local_.times.push_back(time * run_.units.time);
        for (std::size_t p = cells_.size(); p-- > 0;)
          local_.stress.push_back(mu_s_[p] / (weight * run_.units.force * run_.units.time));
      }

      void
      add_impulse(const Adjoint &adjoint,
                  Direction::Change &change,
                  const std::size_t k,
                  const std::vector<double> &impulse,
                  const std::vector<double> &effect,
                  const double factor,
                  const bool is_edge) const
      {
        double sum = 0., size = 0.;
        for (std::size_t p = 0; p < cells_.size(); ++p)
        {
          sum += factor * cells_.weight(p) * impulse[p] * effect[p];
          size += cells_.weight(p) * std::abs(impulse[p]);
        }
        change.sums[k] += sum;
        // Impulses have effects beyond their size where friction is not linear in the velocity; and works grow in them.
        if (is_work(adjoint.quantity) && size > 0.)
          change.at_breaks = std::numeric_limits<double>::infinity();
        else if (is_edge || (setup_.laws & LaneLaws::nonlinear_in_velocity) != 0)
          change.at_breaks = std::max(change.at_breaks, std::abs(sum));
      }

      const RecordedRun &run_;
      LocalSensitivity &local_;
      LaneAdjoint adjoint_;
      const LaneSetup &setup_;
      const RadauTableau &tableau_;
      const CellPoints cells_;
      ForcesOfScene own_;
      WorkRates works_;
      std::vector<Direction> directions_;
      std::vector<StretchInRun> stretches_;
      std::vector<Adjoint> adjoints_;
      bool keeps_stress_ = true;
      std::optional<double> stride_;  ///< stride of the run, if it is known
      std::size_t before_stride_ = 0; ///< the step that ends where the last stride starts
      StateAtPoints at_, at_ends_;
      std::vector<double> mu_, mu_s_, zeta_, zeta_s_; ///< adjoint at the points, and its derivatives by s
    };
  } // namespace

  bool
  have_similar_breaks(const Scene &scene, const Scene &other)
  {
    return BreakMap(breaks_in_space_of(scene), breaks_in_space_of(other)).is_one_to_one() &&
           BreakMap(breaks_in_time_of(scene), breaks_in_time_of(other)).is_good();
  }

  RunGradient
  gradient_of(const RecordedRun &run,
              const std::span<const Variation> variations,
              const std::span<const Quantity> quantities,
              const std::span<const StretchPlace> stretches)
  {
    RunGradient result;
    GradientSweep sweep(run, variations, quantities, stretches, result.local);
    sweep.make();
    for (std::size_t i = 0; i < variations.size(); ++i)
    {
      result.quantities.push_back(sweep.derivatives(i, variations[i]));
      result.stretches.push_back(sweep.of_stretches(i, variations[i]));
    }
    return result;
  }
} // namespace crawler
