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
      KinematicGait(SceneFamily &family, const GaitWishes wishes, const std::vector<double> &start)
        : family_(family)
        , wishes_(wishes)
        , start_(start)
      {
        constexpr unsigned int most = 128;
        const State state(family.parameters(start));
        const ActiveStress &stress = *state.reduced.scene().active_stress;
        n_space_                   = GaussPanels::number_ending_at(state.reduced.scene().breaks_in_space(), 1, most);
        n_time_                    = GaussPanels::number_ending_at(stress.breaks_in_time(), 1, most);
        grid_.emplace(n_space_, n_time_);
        while (refine(start))
          ;
        look_for_linearity(start);
      }

      GaitValues
      evaluate(const std::vector<double> &x, const bool with_gradients, const std::vector<std::size_t> &) override
      {
        GaitValues result;
        std::shared_ptr<const State> state;
        Samples samples;
        try
        {
          state             = linear_ ? linear_->state : std::make_shared<const State>(family_.parameters(x));
          samples           = linear_ ? linear_samples(x) : sample(*state);
          const auto values = grid_->values(samples.on_grid, state->body(*grid_));
          if (!values)
          {
            result.problem = "the body inverts: the strain reaches -1";
            return result;
          }
          result.numbers = numbers(*state, samples, *values);
          if (const double efficiency = result.numbers[GaitNumber::efficiency]; efficiency > 1. + accurate_enough)
          {
            result.problem =
              fmt::format("gait_efficiency: the gait efficiency is {:.8g}, but no gait can exceed 1", efficiency);
            return result;
          }
          if (wishes_.strain)
            result.strain.values = samples.limited;
          if (wishes_.stress)
            result.stress = family_.stress(x, /*rate=*/false, with_gradients);
          if (wishes_.stress_rate)
            result.stress_rate = family_.stress(x, /*rate=*/true, with_gradients);
          if (with_gradients)
            add_gradients(x, *state, samples, result);
        }
        catch (const InputError &error)
        {
          result.problem = error.what();
        }
        return result;
      }

      bool
      refine(const std::vector<double> &x) override
      {
        constexpr std::size_t most = 400000;
        const bool is_large        = grid_->points().size() * grid_->times().size() > most;
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
          possible.emplace(family_.parameters(x));
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
          return grid.values(grid.sample(*state.reduced.strain()), state.body(grid));
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
        const State state(family_.parameters(x));
        const StrainExtremes extremes =
          find_extremes(*state.reduced.strain(), 1., 1., 16 * n_space_ + 1, 16 * n_time_ + 1);
        return {extremes.smallest.strain, extremes.largest.strain};
      }

      std::string
      description() const override
      {
        return fmt::format("kinematic level, {} x {} points of quadrature in s and t{}",
                           grid_->points().size(),
                           grid_->times().size(),
                           linear_ ? ", the strain is linear in the variables" : "");
      }

    private:
      /// Scene of the family, with its reduced form.
      struct State
      {
        explicit State(const Parameters &parameters)
          : physical(parameters.create_scene())
          , reduced(physical)
        {
          if (reduced.strain() == nullptr)
            throw InputError(
              "the kinematic level needs a prescribed strain, or an active stress whose rate is known and "
              "that does not jump",
              "Model");
        }

        BodyAtPoints
        body(const StrainFunctional &grid) const
        {
          return {reduced.scene(), grid.points()};
        }

        /// True if body, ground, units and time are those of another state, so that only the strain may differ.
        bool
        is_like(const State &other) const
        {
          std::array<double, 3> w = {{0.5, 1., 1.7}}, own{}, others{};
          reduced.scene().friction->values(w, own);
          other.reduced.scene().friction->values(w, others);
          const Units &a = reduced.units(), &b = other.reduced.units();
          return own == others && reduced.scene().body.elastic_modulus == other.reduced.scene().body.elastic_modulus &&
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
        Samples samples{grid_->sample(*state.reduced.strain()), {}};
        if (!wishes_.strain)
          return samples;
        std::vector<double> strain(n_limited_s_ + 1);
        const auto at = state.reduced.strain()->at(equal_parts(0., 1., n_limited_s_));
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
        jacobian_.reset();
      }

      /// True if the samples of the strain at @p x are those of linear_, but for round-off.
      bool
      are_linear(const Samples &samples, const std::vector<double> &x) const
      {
        constexpr double round_off = 1e-11;
        const Samples guess        = linear_samples(x);
        for (const auto member : {&StrainSamples::strain, &StrainSamples::rate})
        {
          const std::vector<double> &own = samples.on_grid.*member, &first = linear_->samples.on_grid.*member,
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

      /// Sets linear_ if the strain is linear. Returns false if a changed strain is not admissible.
      bool
      measure_slopes(const std::vector<double> &start, const bool nearly_inverts)
      {
        const double step     = nearly_inverts ? 1e-4 : 1e-2;
        const auto &variables = family_.variables;
        const auto n          = static_cast<double>(start.size());
        Linear linear{start, std::make_shared<const State>(family_.parameters(start)), {}, {}};
        linear.samples  = sample(*linear.state);
        const auto base = linear.state;
        // Small changes: at large values the strain may not be admissible.
        const auto away = [&](const std::size_t i, const double part) {
          const double range = variables[i].to - variables[i].from;
          return part * range * (start[i] + part * range > variables[i].to ? -1. : 1.);
        };
        try
        {
          const auto at = [&](const std::vector<double> &x, Samples &samples) {
            const State state(family_.parameters(x));
            samples = sample(state);
            return state.is_like(*base);
          };
          for (std::size_t i = 0; i < start.size(); ++i)
          {
            std::vector<double> x = start;
            const double d        = away(i, step);
            x[i] += d;
            Samples samples;
            if (!at(x, samples))
              return true;
            samples.add(-1., linear.samples);
            linear.slopes.emplace_back().add(1. / d, samples);
          }
          linear_ = std::move(linear);
          for (const double part : {0.31, 0.77})
          {
            std::vector<double> x = start;
            for (std::size_t i = 0; i < x.size(); ++i)
              x[i] = nearly_inverts ? std::clamp((1. - part) * x[i], variables[i].from, variables[i].to) // tamer
                                    : x[i] + away(i, part / (3. * n) * (1. + 0.3 * std::sin(static_cast<double>(i))));
            Samples samples;
            at(x, samples);
            if (!are_linear(samples, x))
            {
              linear_.reset();
              return true;
            }
          }
        }
        catch (const InputError &)
        {
          linear_.reset();
          return false;
        }
        return true;
      }

      /// Measures the derivatives of the strain at the start, and tests whether they hold for another strain, with all
      /// variables changed. Where the body nearly inverts only small changes are admissible, and those to tamer gaits.
      void
      look_for_linearity(const std::vector<double> &start)
      {
        linear_.reset();
        jacobian_.reset();
        choose_limited_places(/*many=*/true);
        if (!measure_slopes(start, /*nearly_inverts=*/false))
          measure_slopes(start, /*nearly_inverts=*/true);
        if (!linear_)
          choose_limited_places(/*many=*/false);
        else if (wishes_.strain)
          leave_out_places();
      }

      Samples
      linear_samples(const std::vector<double> &x) const
      {
        Samples samples = linear_->samples;
        for (std::size_t i = 0; i < x.size(); ++i)
          if (x[i] != linear_->x[i])
            samples.add(x[i] - linear_->x[i], linear_->slopes[i]);
        return samples;
      }

      ByGaitNumber<double>
      numbers(const State &state, const Samples &samples, const StrainFunctional::Values &values) const
      {
        const Units &units  = state.reduced.units();
        const Scene &scene  = state.physical;
        const double energy = units.energy(), D = units.length * values[StrainFunctional::displacement];
        // The bound holds for the sums of the quadrature, too, with the strains at its points.
        const auto [least, most] = std::ranges::minmax(samples.on_grid.strain);
        const double bound       = largest_merit(*state.reduced.scene().friction, 1. + least, 1. + most) *
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
        for (auto &gradient : values.gradients)
          gradient.assign(x.size(), 0.);
        std::vector<bool> only_strain(x.size(), true);
        std::vector<Samples> own_slopes; // unless the strain is linear
        if (!linear_)
        {
          own_slopes.assign(x.size(), {});
          for (std::size_t i = 0; i < x.size(); ++i)
          {
            ByGaitNumber<double> derivatives{};
            for (const auto &point : family_.stencil(x, i, step))
            {
              const State there(family_.parameters(point.x));
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
        const Units &units                 = state.reduced.units();
        const auto put = [&](const StrainFunctional::Number number, const GaitNumber::Index what, const double unit) {
          if (!wishes_.numbers[what])
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
        if (!wishes_.strain)
          return;
        if (!linear_ || !jacobian_)
        {
          std::vector<double> rows(values.strain.values.size() * x.size());
          for (std::size_t i = 0; i < x.size(); ++i)
            for (std::size_t p = 0; p < values.strain.values.size(); ++p)
              rows[p * x.size() + i] = slopes[i].limited[p];
          jacobian_ = std::make_shared<const std::vector<double>>(std::move(rows));
        }
        values.strain.jacobian = jacobian_;
      }

      SceneFamily &family_;
      const GaitWishes wishes_;
      const std::vector<double> start_;
      unsigned int n_space_ = 1, n_time_ = 1; ///< panels
      std::optional<StrainFunctional> grid_;
      unsigned int n_limited_s_ = 1,
                   n_limited_t_ = 1; ///< parts of body and duration; the strain is limited at their ends
      /// Strain that is linear in the variables: its values at some x, and its derivatives [variable].
      struct Linear
      {
        std::vector<double> x;
        std::shared_ptr<const State> state; ///< everything but the strain
        Samples samples;
        std::vector<Samples> slopes;
      };
      std::optional<Linear> linear_;
      std::shared_ptr<const std::vector<double>> jacobian_; ///< Jacobian of the strain where it is limited, if it is
                                                            ///< linear
    };
  } // namespace

  std::unique_ptr<GaitModel>
  kinematic_gait(SceneFamily &family, const GaitWishes &wishes, const std::vector<double> &start)
  {
    return std::make_unique<KinematicGait>(family, wishes, start);
  }
} // namespace crawler
