// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/general_laws.h>
#include <crawler/lanes/lane_adjoint.h>
#include <crawler/run/batch.h>
#include <crawler/run/displacement_gradient.h>
#include <crawler/time/radau_loops.h>
#include <crawler/time/radau_tableau.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <stdexcept>

namespace crawler
{
  namespace
  {
    /// A state at all quadrature points.
    struct StateAtPoints
    {
      std::vector<double> u, v, e, w, rate;

      explicit StateAtPoints(const std::size_t n)
        : u(n)
        , v(n)
        , e(n)
        , w(n)
        , rate(n)
      {
      }
    };

    /// A field, and its derivative by s, at all points from its values at the nodes.
    void
    evaluate(const LaneSetup &setup, const double *nodal, std::vector<double> &values, std::vector<double> &slopes)
    {
      const std::size_t n = setup.degree + 1;
      for (std::size_t c = 0; c < setup.n_cells; ++c)
        for (std::size_t p = 0; p < n; ++p)
        {
          double value = 0., slope = 0.;
          for (std::size_t i = 0; i < n; ++i)
          {
            value += setup.values[p * n + i] * nodal[c * setup.degree + i];
            slope += setup.derivatives[p * n + i] * nodal[c * setup.degree + i];
          }
          values[c * n + p] = value;
          slopes[c * n + p] = slope / setup.sizes[c];
        }
    }

    /**
     * [0, 1] to [0, 1], linear between breaks and taking those of one scene to those of another, which are near them:
     * where several come together in the one, to the mean of what they are in the other.
     */
    class BreakMap
    {
    public:
      BreakMap(const std::vector<double> &from, const std::vector<double> &to)
        : from_{0.}
        , to_{0.}
        , bunches_(1)
      {
        constexpr double near = 0.4;
        for (const double x : from)
          from_.push_back(x);
        from_.push_back(1.);
        bunches_.resize(from_.size());
        for (const double x : to)
        {
          const auto right   = std::upper_bound(from_.begin() + 1, from_.end() - 1, x);
          const auto nearest = x - *(right - 1) < *right - x ? right - 1 : right;
          bunches_[static_cast<std::size_t>(nearest - from_.begin())].push_back(x);
          is_good_ = is_good_ && std::abs(x - *nearest) <= near * (*right - *(right - 1));
        }
        for (std::size_t i = 1; i + 1 < from_.size(); ++i)
        {
          const std::vector<double> &bunch = bunches_[i];
          is_good_                         = is_good_ && !bunch.empty();
          to_.push_back(std::accumulate(bunch.begin(), bunch.end(), 0.) / static_cast<double>(bunch.size()));
        }
        to_.push_back(1.);
      }

      /// Has each break of the one some of the other near it, and the other no more but at the ends?
      bool
      is_good() const
      {
        return is_good_;
      }
      /// Are they as many?
      bool
      is_one_to_one() const
      {
        return is_good_ && std::ranges::all_of(bunches_, [](const auto &bunch) { return bunch.size() <= 1; }) &&
               bunches_.front().empty() && bunches_.back().empty();
      }

      /// The number of the piece in which @p x is; the left one at a break.
      std::size_t
      piece(const double x) const
      {
        const auto right = std::lower_bound(from_.begin() + 1, from_.end() - 1, x - 1e-12);
        return static_cast<std::size_t>(right - from_.begin()) - 1;
      }
      double
      slope(const std::size_t piece) const
      {
        return (to_[piece + 1] - to_[piece]) / (from_[piece + 1] - from_[piece]);
      }
      double
      operator()(const std::size_t piece, const double x) const
      {
        return to_[piece] + slope(piece) * (x - from_[piece]);
      }

      double
      start(const std::size_t piece) const
      {
        return from_[piece];
      }
      double
      end(const std::size_t piece) const
      {
        return from_[piece + 1];
      }
      bool
      is_last(const std::size_t piece) const
      {
        return piece + 2 == from_.size();
      }
      /// The breaks of the other scene near break @p number of the one; 0 is the start, and what they are taken for.
      const std::vector<double> &
      bunch(const std::size_t number) const
      {
        return bunches_[number];
      }
      double
      image_of_break(const std::size_t number) const
      {
        return to_[number];
      }
      /// The number of the piece of the other scene that this one becomes.
      std::size_t
      image(const std::size_t piece) const
      {
        std::size_t n = 0;
        for (std::size_t i = 0; i <= piece; ++i)
          n += bunches_[i].size();
        return n;
      }

    private:
      std::vector<double> from_, to_;
      std::vector<std::vector<double>> bunches_; ///< [break of the one, and both ends]
      bool is_good_ = true;
    };

    /// In units of the length.
    std::vector<double>
    breaks_in_space(const Scene &scene)
    {
      std::vector<double> list = scene.breaks_in_space();
      for (double &place : list)
        place /= scene.body.length;
      return list;
    }

    /// In units of the duration.
    std::vector<double>
    breaks_in_time(const Scene &scene)
    {
      return TimeSegments(*scene.active_stress, scene.end_time).breaks();
    }

    /**
     * The force N in a body and the friction f at points, in natural units of the body. The state is that of another
     * scene at the points; its breaks are taken to those of this one: with S and R the stretches of the body and of the
     * time that this takes, w = 1 + e/S, v -> v/R, and a piece of the body is S times as long. What comes between jumps
     * in time that come together in the other scene is in between().
     */
    class ForcesAtPoints
    {
    public:
      ForcesAtPoints(const Scene &physical, const Scene &other, const std::vector<double> &points)
        : units_(natural_units(physical))
        , segments_(*physical.active_stress, physical.end_time)
        , scene_(in_units(physical, units_, &segments_))
        , in_time_(breaks_in_time(other), segments_.breaks())
        , at_(points.size())
        , g_(points.size())
      {
        const BreakMap in_space(breaks_in_space(other), breaks_in_space(physical));
        std::vector<double> own = points;
        for (double &s : own)
        {
          const std::size_t piece = in_space.piece(s);
          longer_.push_back(in_space.slope(piece));
          s = in_space(piece, s);
        }
        body_.emplace(scene_, own);
        sliding_.emplace(scene_, own);
      }

      const Units &
      units() const
      {
        return units_;
      }

      /// At the time @p t of a step that ends at @p end.
      void
      evaluate(const double t, const double end, const StateAtPoints &at)
      {
        const std::size_t piece = in_time_.piece(end);
        const double slower     = in_time_.slope(piece);
        at_.u                   = at.u;
        for (std::size_t p = 0; p < g_.size(); ++p)
        {
          at_.v[p]    = at.v[p] / slower;
          at_.e[p]    = at.e[p] / longer_[p];
          at_.w[p]    = 1. + at_.e[p];
          at_.rate[p] = at.rate[p] / (longer_[p] * slower);
        }
        force(in_time_.image(piece), in_time_(piece, t));
        sliding_->evaluate(at_.u, at_.v);
        scene_.friction->values(at_.w, g_);
      }

      /// Is the end of a step where several jumps come together, or where some come in or go out of the run? (@p start:
      /// of the run.)
      bool
      has_between(const double time, const bool start) const
      {
        const std::size_t number = start ? 0 : in_time_.piece(time) + 1;
        const bool is_edge       = start || in_time_.is_last(number - 1);
        return in_time_.bunch(number).size() >= (is_edge ? 1 : 2) &&
               (start || std::abs(time - in_time_.end(number - 1)) <= 1e-12);
      }

      /// int N dt over the short times between them, less what evaluate() has instead, at all points; for the state
      /// that was evaluated last.
      std::vector<double>
      between(const double time, const bool start)
      {
        const std::size_t number  = start ? 0 : in_time_.piece(time) + 1;
        std::vector<double> edges = in_time_.bunch(number);
        const double middle       = in_time_.image_of_break(number);
        const std::size_t left = start ? 0 : in_time_.image(number - 1), right = left + edges.size();
        const bool is_end = !start && in_time_.is_last(number - 1);
        std::vector<double> sum(g_.size(), 0.);
        const auto add = [&](const std::size_t piece, const double from, const double to) {
          if (!(to > from))
            return;
          const double t = 0.5 * (from + to);
          force(piece, t);
          for (std::size_t p = 0; p < sum.size(); ++p)
            sum[p] += (to - from) * body_->N[p];
          force(t < middle || is_end ? left : right, t);
          for (std::size_t p = 0; p < sum.size(); ++p)
            sum[p] -= (to - from) * body_->N[p];
        };
        if (start)
          add(left, 0., edges.front());
        for (std::size_t i = 0; i + 1 < edges.size(); ++i)
        {
          add(left + i + 1, edges[i], std::min(edges[i + 1], middle));
          add(left + i + 1, std::max(edges[i], middle), edges[i + 1]);
        }
        if (is_end)
          add(right, edges.back(), 1.);
        return sum;
      }

      double
      N(const std::size_t point) const
      {
        return body_->N[point];
      }
      /// For each length of the other body.
      double
      f(const std::size_t point) const
      {
        return longer_[point] * g_[point] * sliding_->force[point];
      }
      double
      longer(const std::size_t point) const
      {
        return longer_[point];
      }
      double
      elastic(const std::size_t point, const double e) const
      {
        return body_->k[point] * e;
      }

    private:
      /// N at a time of a piece, or as near to it as the piece comes.
      void
      force(const std::size_t piece, const double t)
      {
        segments_.restart();
        for (std::size_t i = 0; i < piece; ++i)
          segments_.go_on();
        body_->evaluate(segments_.inside(t), at_.e, {at_.w, at_.rate, {}, {}});
      }

      const Units units_;
      TimeSegments segments_;
      const Scene scene_;
      const BreakMap in_time_;
      std::vector<double> longer_;
      std::optional<BodyForceAtPoints> body_;
      std::optional<SlidingAtPoints> sliding_;
      StateAtPoints at_;
      std::vector<double> g_;
    };

    /// f' from f(-2), f(-1), f(1), f(2).
    double
    fourth_order(const std::array<double, 4> &values, const double step)
    {
      return (8. * (values[2] - values[1]) - (values[3] - values[0])) / (12. * step);
    }

    LaneMethod
    method_of(const Scene &natural, const TimeParameters &time, const Numerics &numerics)
    {
      return batch_method(natural, time, numerics).value();
    }
  } // namespace

  bool
  have_similar_breaks(const Scene &scene, const Scene &other)
  {
    return BreakMap(breaks_in_space(scene), breaks_in_space(other)).is_one_to_one() &&
           BreakMap(breaks_in_time(scene), breaks_in_time(other)).is_good();
  }

  std::string
  DisplacementGradient::reason_against(const Scene &scene, const TimeParameters &time, const Numerics &numerics)
  {
    if (numerics.linear)
      return "the displacement of the linear level is 0";
    if (numerics.formulation != Formulation::position)
      return "they are not there for the stretch form, which computes this scene";
    if (scene.profiles.initial_stretch)
      return "they are not there for an initial stretch";
    if (scene.active_stress->feedback() != nullptr &&
        !TimeSegments(*scene.active_stress, scene.end_time).breaks().empty())
      return "they are not there for feedback to an active stress that jumps in time";
    if (numerics.jumps_move)
      return "they are not there for jumps of the active stress that move";
    if (!batch_method(scene, time, numerics))
      return "they need the fused engine: radau, and a mesh that does not change";
    return "";
  }

  DisplacementGradient::DisplacementGradient(const Scene &scene,
                                             const TimeParameters &time,
                                             const Numerics &numerics,
                                             const std::function<bool()> &keep_going)
    : scene_(scene)
    , units_(natural_units(scene))
    , segments_(*scene.active_stress, scene.end_time)
    , natural_(in_units(scene, units_, &segments_))
    , method_(method_of(natural_, time, in_units(numerics, units_)))
  {
    const SimulationResult result =
      Simulation(MPI_COMM_SELF, scene, time, numerics).run({}, {.steps = &steps_}, {}, keep_going);
    if (result.time.status != Status::finished)
      throw std::runtime_error("the run did not finish: " + result.time.message);
    displacement_ = result.displacement;
    double from   = 0.;
    for (std::size_t i = 0; i < steps_.n_steps(); ++i)
    {
      if (std::abs(steps_.time(i) - steps_.size(i) - from) > 1e-9 * steps_.size(i) + 1e-14)
        from = HUGE_VAL;
      else
        from = steps_.time(i);
    }
    if (!(std::abs(from - 1.) <= 1e-12))
      throw std::runtime_error("the fused engine did not make all steps");
  }

  std::vector<std::optional<double>>
  DisplacementGradient::derivatives(const std::span<const Variation> variations)
  {
    LaneAdjoint adjoint(natural_, method_);
    const LaneTables &tables   = adjoint.tables();
    const LaneSetup &setup     = tables.setup;
    const std::size_t n_points = tables.points.size(), n = steps_.end().size();
    const RadauTableau &tableau = radau_tableau(setup.n_stages);
    const std::size_t per_cell  = setup.degree + 1;
    std::vector<double> weights(n_points);
    for (std::size_t i = 0; i < n_points; ++i)
      weights[i] = setup.sizes[i / per_cell] * setup.weights[i % per_cell];

    ForcesAtPoints own(scene_, scene_, tables.points);
    std::vector<std::array<std::unique_ptr<ForcesAtPoints>, 4>> others(variations.size());
    for (std::size_t i = 0; i < variations.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k)
        others[i][k] = std::make_unique<ForcesAtPoints>(*variations[i].scenes[k], scene_, tables.points);
    std::vector<std::array<double, 4>> sums(variations.size());
    std::vector<double> at_edges(variations.size()); ///< of them, at start and end
    constexpr std::size_t most_samples = 4000000;
    const bool keeps_stress            = steps_.n_steps() * tableau.n * n_points <= most_samples;
    local_ = {tables.points, std::vector<double>(n_points, 0.), std::vector<double>(n_points, 0.), {}, {}};

    std::vector<double> y = steps_.end(), u(n), v(n), mu_at(n_points), mu_s(n_points);
    StateAtPoints at(n_points);
    const auto see = [&](const std::size_t step, const std::span<const double> mu, const std::span<const double> zeta) {
      std::vector<double> zeta_at(n_points), zeta_s(n_points);
      if (!zeta.empty())
        evaluate(setup, zeta.data(), zeta_at, zeta_s);
      const double *z = steps_.z(step);
      for (std::size_t d = 0; d < n; ++d)
        y[d] -= z[(tableau.n - 1) * n + d];
      for (unsigned int i = tableau.n; i-- > 0;)
      {
        for (std::size_t d = 0; d < n; ++d)
          u[d] = y[d] + z[i * n + d];
        radau::stage_rate(static_cast<int>(tableau.n),
                          tableau.inverse.data(),
                          static_cast<int>(i),
                          1. / steps_.size(step),
                          z,
                          static_cast<int>(n),
                          v.data());
        evaluate(setup, u.data(), at.u, at.e);
        evaluate(setup, v.data(), at.v, at.rate);
        for (std::size_t p = 0; p < n_points; ++p)
          at.w[p] = 1. + at.e[p];
        evaluate(setup, mu.data() + i * n, mu_at, mu_s);
        const double t = steps_.time(step) - (1. - tableau.c[i]) * steps_.size(step);
        own.evaluate(t, steps_.time(step), at);
        for (std::size_t p = 0; p < n_points; ++p)
        {
          local_.elastic_modulus[p] += own.elastic(p, at.e[p]) * mu_s[p];
          local_.friction[p] += own.f(p) * mu_at[p];
        }
        if (keeps_stress)
        {
          local_.times.push_back(t * units_.time);
          for (std::size_t p = n_points; p-- > 0;)
            local_.stress.push_back(mu_s[p] / (steps_.size(step) * tableau.b[i] * units_.force * units_.time));
        }
        for (std::size_t number = 0; number < others.size(); ++number)
          for (std::size_t k = 0; k < 4; ++k)
          {
            ForcesAtPoints &forces = *others[number][k];
            forces.evaluate(t, steps_.time(step), at);
            for (std::size_t p = 0; p < n_points; ++p) // the differences, since the sums nearly cancel
              sums[number][k] +=
                weights[p] * ((forces.N(p) - own.N(p)) * mu_s[p] + (forces.f(p) - own.f(p)) * mu_at[p]);
            const bool is_start = step == 0 && i == 0, is_end = i + 1 == tableau.n;
            if (!(is_start || is_end) || !forces.has_between(t, is_start))
              continue;
            const std::vector<double> between = forces.between(t, is_start);
            double sum                        = 0.;
            for (std::size_t p = 0; p < n_points; ++p)
              sum -= weights[p] * between[p] * (is_end ? zeta_s[p] : -mu_s[p] / (steps_.size(step) * tableau.b[i]));
            sums[number][k] += sum;
            // Where friction is not linear in the velocity an impulse is more than its size.
            if (is_start || steps_.time(step) == 1. || (setup.laws & LaneLaws::nonlinear_in_velocity) != 0)
              at_edges[number] = std::max(at_edges[number], std::abs(sum));
          }
      }
    };
    evaluate(setup, y.data(), at.u, at.e);
    for (std::size_t number = 0; number < others.size(); ++number)
      for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t p = 0; p < n_points; ++p)
          sums[number][k] += weights[p] * (others[number][k]->longer(p) - 1.) * at.u[p];
    if (!adjoint.solve(steps_, adjoint.gradient_of_displacement(), see))
      throw std::runtime_error("the adjoint of a step did not converge");

    const double natural_displacement = displacement_ / units_.length;
    std::vector<std::optional<double>> result;
    for (std::size_t i = 0; i < variations.size(); ++i)
    {
      constexpr double nothing = 1e-7;
      std::array<double, 4> lengths;
      for (std::size_t k = 0; k < 4; ++k)
        lengths[k] = others[i][k]->units().length;
      const double derivative = units_.length * fourth_order(sums[i], variations[i].step) +
                                natural_displacement * fourth_order(lengths, variations[i].step);
      if (units_.length * at_edges[i] <= nothing * variations[i].step * std::abs(derivative))
        result.push_back(derivative);
      else
        result.push_back(std::nullopt);
    }
    for (double &s : local_.s)
      s *= units_.length;
    std::reverse(local_.times.begin(), local_.times.end());
    std::reverse(local_.stress.begin(), local_.stress.end());
    return result;
  }
} // namespace crawler
