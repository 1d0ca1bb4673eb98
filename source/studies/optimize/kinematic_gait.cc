// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/grid_samples.h>
#include <crawler/reduced_models/kinematic.h>
#include <crawler/reduced_models/reduced_scene.h>
#include <crawler/reduced_models/strain_functional.h>
#include <crawler/studies/optimize/scene_family.h>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <set>

namespace crawler
{
  namespace
  {
    constexpr double accurate_enough = 1e-6; ///< accuracy of the quadrature, relative to displacement and works

    double
    dot(const std::vector<double> &a, const std::vector<double> &b)
    {
      return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
    }

    /**
     * Gaits of the kinematic level, where the strain is given: quadrature on a grid, and derivatives in closed form
     * (reduced_models/strain_functional.h) times those of the strain, which are differences. Where the strain is linear
     * in all variables, as tested at the beginning, its derivatives are computed once, and no more scenes are built.
     */
    class KinematicGait : public GaitModel
    {
    public:
      KinematicGait(SceneFamily &its_family, const std::vector<double> &start)
        : GaitModel(its_family)
        , start_(start)
      {
        constexpr unsigned int most = 128;
        const State state(family.parameters(start));
        const ActiveStress &stress = *state.reduced.scene.active_stress;
        n_space_                   = GaussPanels::number_ending_at(state.reduced.scene.breaks_in_space(), most);
        n_time_                    = GaussPanels::number_ending_at(stress.breaks_in_time(), most);
        grid_.emplace(n_space_, n_time_);
        while (refine(start))
          ;
        look_for_linearity(start);
      }

      bool
      refine(const std::vector<double> &x) override
      {
        constexpr std::size_t most = 400000;
        const bool is_large        = grid_->points.size() * grid_->times.size() > most;
        const auto refine_in       = [&](const bool space, const bool time, const std::vector<double> &somewhere) {
          n_space_ *= space ? 2 : 1;
          n_time_ *= time ? 2 : 1;
          grid_.emplace(n_space_, n_time_);
          if (linear_)
            look_for_linearity(somewhere);
          else
            choose_limited_places(/*many=*/false);
          return true;
        };
        std::optional<State> possible;
        try
        {
          possible.emplace(family.parameters(x));
        }
        catch (const InputError &) // inversion between the points of the grid
        {
          if (is_large || x == start_)
            throw;
          return refine_in(true, true, start_);
        }
        const State &state = *possible;
        const auto with    = [&](const unsigned int n_space, const unsigned int n_time) {
          const StrainFunctional grid(n_space, n_time);
          return grid.values(grid.sample(*state.reduced.strain), state.body(grid));
        };
        const auto own = with(n_space_, n_time_);
        if (!own)
          return false;
        const auto differs = [&](const std::optional<StrainFunctional::Values> &other) {
          const auto differs_in = [&](const auto number) {
            return std::abs((*other)[number] - (*own)[number]) > accurate_enough * std::abs((*other)[number]) + 1e-13;
          };
          return other && (differs_in(StrainFunctional::displacement) || differs_in(StrainFunctional::stress_work));
        };
        const bool in_space = differs(with(2 * n_space_, n_time_)), in_time = differs(with(n_space_, 2 * n_time_));
        return (in_space || in_time) && !is_large && refine_in(in_space, in_time, x);
      }

      std::pair<double, double>
      extreme_strains(const std::vector<double> &x) override
      {
        const State state(family.parameters(x));
        const StrainExtremes extremes =
          find_extremes(*state.reduced.strain, 1., 1., 16 * n_space_ + 1, 16 * n_time_ + 1);
        return {extremes.smallest.strain, extremes.largest.strain};
      }

      std::string
      description() const override
      {
        return fmt::format("kinematic level, {} x {} points of quadrature in s and t{}",
                           grid_->points.size(),
                           grid_->times.size(),
                           linear_ ? ", the strain is linear in the variables" : "");
      }

    private:
      void
      compute(const std::vector<double> &x,
              const bool with_gradients,
              const std::vector<std::size_t> &,
              GaitValues &result) override
      {
        const auto state      = linear_ ? linear_->state : std::make_shared<const State>(family.parameters(x));
        const Samples samples = linear_ ? linear_->at(x) : sample(*state);
        const auto values     = grid_->values(samples.on_grid, state->body(*grid_));
        if (!values)
          throw InputError("the body inverts: the strain reaches -1");
        result.numbers = numbers(*state, samples, *values);
        if (const double efficiency = result.numbers[GaitNumber::efficiency]; efficiency > 1. + accurate_enough)
          throw InputError(
            fmt::format("gait_efficiency: the gait efficiency is {:.8g}, but no gait can exceed 1", efficiency));
        if (wishes.strain)
          result.strain.values = samples.limited;
        if (with_gradients)
          add_gradients(x, *state, samples, result);
      }

      /// Scene of the family, with its reduced form.
      struct State
      {
        explicit State(const Parameters &parameters)
          : physical(parameters.create_scene())
          , reduced(physical)
        {
          if (reduced.strain == nullptr)
            throw InputError(
              "the kinematic level needs a prescribed strain, or an active stress whose rate is known and "
              "that does not jump",
              "Model");
        }

        BodyAtPoints
        body(const StrainFunctional &grid) const
        {
          return {reduced.scene, grid.points};
        }

        /// True if body, ground, units and time are those of another state, so that only the strain may differ.
        bool
        is_like(const State &other) const
        {
          std::array<double, 3> w = {{0.5, 1., 1.7}}, own{}, others{};
          reduced.scene.friction->values(w, own);
          other.reduced.scene.friction->values(w, others);
          const Units &a = reduced.units, &b = other.reduced.units;
          return own == others && reduced.scene.body.elastic_modulus == other.reduced.scene.body.elastic_modulus &&
                 a.length == b.length && a.time == b.time && a.force == b.force;
        }

        const Scene physical;
        const ReducedScene reduced;
      };

      /// Strain on the grid of the quadrature, and at the places where it is limited, which are denser along the body.
      struct Samples
      {
        StrainSamples on_grid;
        std::vector<double> limited;

        void
        add(const double factor, const Samples &others)
        {
          const auto put = [factor](std::vector<double> &sum, const std::vector<double> &what) {
            sum.resize(what.size());
            for (std::size_t i = 0; i < sum.size(); ++i)
              sum[i] += factor * what[i];
          };
          put(on_grid.strain, others.on_grid.strain);
          put(on_grid.rate, others.on_grid.rate);
          put(limited, others.limited);
        }
      };
      Samples
      sample(const State &state) const
      {
        Samples samples{grid_->sample(*state.reduced.strain), {}};
        if (!wishes.strain)
          return samples;
        std::vector<double> strain(n_limited_s_ + 1);
        const auto at = state.reduced.strain->at(equal_parts(0., 1., n_limited_s_));
        for (const double t : equal_parts(0., 1., n_limited_t_))
        {
          at->values(t, strain);
          samples.limited.insert(samples.limited.end(), strain.begin(), strain.end());
        }
        return samples;
      }

      /// Chooses the places where the strain is limited: equally spaced, so that a wave of constant shape is the same
      /// at many of them.
      void
      choose_limited_places(const bool many)
      {
        // Nonlinear strains are computed anew at all of them, for each variable.
        const unsigned int max_times = many ? 128 : 32, most = many ? 65536 : 4096, closer = many ? 64 : 8;
        n_limited_t_ = std::min(std::bit_ceil(GaussPanels::n_points * n_time_), max_times);
        n_limited_s_ = std::min(closer * GaussPanels::n_points * n_space_, most / n_limited_t_);
      }

      /// Strain that is linear in the variables: its values at some x, and its derivatives [variable].
      struct Linear
      {
        std::vector<double> x;
        std::shared_ptr<const State> state; ///< everything but the strain
        Samples samples;
        std::vector<Samples> slopes = {};

        Samples
        at(const std::vector<double> &other) const
        {
          Samples sum = samples;
          for (std::size_t i = 0; i < x.size(); ++i)
            if (other[i] != x[i])
              sum.add(other[i] - x[i], slopes[i]);
          return sum;
        }

        /// True if these samples of the strain elsewhere are those of at(), but for round-off.
        bool
        gives(const Samples &others, const std::vector<double> &other) const
        {
          constexpr double round_off = 1e-11;
          const Samples guess        = at(other);
          for (const auto member : {&StrainSamples::strain, &StrainSamples::rate})
          {
            const std::vector<double> &own = others.on_grid.*member, &first = samples.on_grid.*member,
                                      &guessed = guess.on_grid.*member;
            double size = 1e-3, largest = 0.;
            for (std::size_t i = 0; i < own.size(); ++i)
            {
              size    = std::max({size, std::abs(own[i]), std::abs(first[i])});
              largest = std::max(largest, std::abs(guessed[i] - own[i]));
            }
            if (largest > round_off * size)
              return false;
          }
          return true;
        }
      };

      /// Measures the derivatives of the strain at the start, and tests whether they hold for another strain, with all
      /// variables changed; nothing if they do not. Where the body @p nearly_inverts only small changes are admissible,
      /// and those to tamer gaits. Throws InputError if a changed strain is not admissible.
      std::optional<Linear>
      linear_about(const std::vector<double> &start, const bool nearly_inverts) const
      {
        const double step     = nearly_inverts ? 1e-4 : 1e-2;
        const auto &variables = family.variables;
        const auto n          = static_cast<double>(start.size());
        const auto base       = std::make_shared<const State>(family.parameters(start));
        Linear linear{start, base, sample(*base)};
        // Small changes: at large values the strain may not be admissible.
        const auto away = [&](const std::size_t i, const double part) {
          const double range = variables[i].to - variables[i].from;
          return part * range * (start[i] + part * range > variables[i].to ? -1. : 1.);
        };
        for (std::size_t i = 0; i < start.size(); ++i)
        {
          std::vector<double> x = start;
          const double d        = away(i, step);
          x[i] += d;
          const State state(family.parameters(x));
          if (!state.is_like(*base))
            return std::nullopt;
          Samples samples = sample(state);
          samples.add(-1., linear.samples);
          linear.slopes.emplace_back().add(1. / d, samples);
        }
        for (const double part : {0.31, 0.77})
        {
          std::vector<double> x = start;
          for (std::size_t i = 0; i < x.size(); ++i)
            x[i] = nearly_inverts ? std::clamp((1. - part) * x[i], variables[i].from, variables[i].to) // tamer
                                  : x[i] + away(i, part / (3. * n) * (1. + 0.3 * std::sin(static_cast<double>(i))));
          if (!linear.gives(sample(State(family.parameters(x))), x))
            return std::nullopt;
        }
        return linear;
      }

      /// Removes all but one of the places where a linear strain is the same for all values of the variables, and thins
      /// out the rest to a number that suits the optimiser.
      void
      leave_out_places()
      {
        constexpr double digits    = 1e9;
        constexpr std::size_t most = 4096;
        std::set<std::vector<long>> seen;
        std::vector<std::size_t> kept;
        std::vector<long> key(linear_->slopes.size() + 1);
        for (std::size_t p = 0; p < linear_->samples.limited.size(); ++p)
        {
          key[0] = std::lround(digits * linear_->samples.limited[p]);
          for (std::size_t i = 0; i < linear_->slopes.size(); ++i)
            key[i + 1] = std::lround(digits * linear_->slopes[i].limited[p]);
          if (seen.insert(key).second)
            kept.push_back(p);
        }
        const std::size_t stride = 1 + kept.size() / most;
        const auto take          = [&](std::vector<double> &list) {
          std::vector<double> rest;
          for (std::size_t j = 0; j < kept.size(); j += stride)
            rest.push_back(list[kept[j]]);
          list = std::move(rest);
        };
        take(linear_->samples.limited);
        for (Samples &slope : linear_->slopes)
          take(slope.limited);
      }

      /// Sets linear_ if the strain is linear, and chooses the places where it is limited.
      void
      look_for_linearity(const std::vector<double> &start)
      {
        linear_.reset();
        choose_limited_places(/*many=*/true);
        for (const bool nearly_inverts : {false, true})
          try
          {
            linear_ = linear_about(start, nearly_inverts);
            break;
          }
          catch (const InputError &) // a strain that is not admissible
          {
          }
        if (!linear_)
          choose_limited_places(/*many=*/false);
        else if (wishes.strain)
          leave_out_places();
      }

      ByGaitNumber<double>
      numbers(const State &state, const Samples &samples, const StrainFunctional::Values &values) const
      {
        const Units &units  = state.reduced.units;
        const Scene &scene  = state.physical;
        const double energy = units.energy(), D = units.length * values[StrainFunctional::displacement];
        // The bound holds for the sums of the quadrature, too, with the strains at its points.
        const auto [least, most] = std::ranges::minmax(samples.on_grid.strain);
        const double bound       = largest_merit(*state.reduced.scene.friction, 1. + least, 1. + most) *
                             std::sqrt(values[StrainFunctional::dissipation]),
                     part = std::abs(values[StrainFunctional::displacement]) / bound;
        return {{D,
                 energy * values[StrainFunctional::stress_work],
                 energy * values[StrainFunctional::positive_work],
                 values[StrainFunctional::mean_square],
                 D / scene.end_time,
                 scene.end_time / (scene.body.friction_coefficient * scene.body.length),
                 energy * values[StrainFunctional::dissipation],
                 bound > 0. && !scene.profiles.friction ? part : NAN}};
      }

      void
      add_gradients(const std::vector<double> &x, const State &state, const Samples &samples, GaitValues &values)
      {
        constexpr double step = 1e-3;
        std::vector<bool> only_strain(x.size(), true);
        std::vector<Samples> own_slopes; // unless the strain is linear
        if (!linear_)
        {
          own_slopes.assign(x.size(), {});
          for (std::size_t i = 0; i < x.size(); ++i)
          {
            ByGaitNumber<double> derivatives{};
            for (const auto &point : family.stencil(x, i, step))
            {
              const State there(family.parameters(point.x));
              const Samples its = sample(there);
              own_slopes[i].add(point.weight, its);
              only_strain[i] = only_strain[i] && there.is_like(state);
              if (const auto its_values = grid_->values(its.on_grid, there.body(*grid_)))
              {
                const auto its_numbers = numbers(there, its, *its_values);
                for (std::size_t j = 0; j < gait_numbers.size(); ++j)
                  derivatives[j] += point.weight * its_numbers[j];
              }
            }
            if (!only_strain[i]) // variables of body, ground or time
              for (std::size_t j = 0; j < gait_numbers.size(); ++j)
                values.gradients[j][i] = derivatives[j];
          }
        }
        const std::vector<Samples> &slopes = linear_ ? linear_->slopes : own_slopes;
        const Units &units                 = state.reduced.units;
        const auto put = [&](const StrainFunctional::Number number, const GaitNumber::Index what, const double unit) {
          if (!wishes.numbers[what])
            return;
          const StrainSamples weights = grid_->weights(number, samples.on_grid, state.body(*grid_));
          for (std::size_t i = 0; i < x.size(); ++i)
            if (only_strain[i])
              values.gradients[what][i] =
                unit * (dot(weights.strain, slopes[i].on_grid.strain) + dot(weights.rate, slopes[i].on_grid.rate));
        };
        put(StrainFunctional::displacement, GaitNumber::displacement, units.length);
        put(StrainFunctional::displacement, GaitNumber::speed, units.length / state.physical.end_time);
        put(StrainFunctional::stress_work, GaitNumber::work, units.energy());
        put(StrainFunctional::positive_work, GaitNumber::positive_work, units.energy());
        put(StrainFunctional::dissipation, GaitNumber::dissipation, units.energy());
        put(StrainFunctional::mean_square, GaitNumber::mean_square, 1.);
        for (const Samples &slope : slopes) // empty if strains are not limited
          values.strain.gradients.push_back(slope.limited);
      }

      const std::vector<double> start_;
      unsigned int n_space_ = 1, n_time_ = 1; ///< panels
      std::optional<StrainFunctional> grid_;
      unsigned int n_limited_s_ = 1,
                   n_limited_t_ = 1; ///< parts of body and duration; the strain is limited at their ends
      std::optional<Linear> linear_;
    };
  } // namespace

  std::unique_ptr<GaitModel>
  kinematic_gait(SceneFamily &family, const std::vector<double> &start)
  {
    return std::make_unique<KinematicGait>(family, start);
  }
} // namespace crawler
