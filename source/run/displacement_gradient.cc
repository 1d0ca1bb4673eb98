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

    /// [0, 1] to [0, 1], linear between breaks and taking those of one scene to those of another.
    class BreakMap
    {
    public:
      BreakMap(std::vector<double> from, std::vector<double> to)
        : from_(std::move(from))
        , to_(std::move(to))
      {
        for (std::vector<double> *list : {&from_, &to_})
        {
          list->insert(list->begin(), 0.);
          list->push_back(1.);
        }
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

    private:
      std::vector<double> from_, to_;
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
     * time that this takes, w = 1 + e/S, v -> v/R, and a piece of the body is S times as long.
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
        segments_.restart();
        for (std::size_t i = 0; i < piece; ++i)
          segments_.go_on();
        const double slower = in_time_.slope(piece);
        at_.u               = at.u;
        for (std::size_t p = 0; p < g_.size(); ++p)
        {
          at_.v[p]    = at.v[p] / slower;
          at_.e[p]    = at.e[p] / longer_[p];
          at_.w[p]    = 1. + at_.e[p];
          at_.rate[p] = at.rate[p] / (longer_[p] * slower);
        }
        body_->evaluate(segments_.inside(in_time_(piece, t)), at_.e, {at_.w, at_.rate, {}, {}});
        sliding_->evaluate(at_.u, at_.v);
        scene_.friction->values(at_.w, g_);
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
    return breaks_in_space(scene).size() == breaks_in_space(other).size() &&
           breaks_in_time(scene).size() == breaks_in_time(other).size();
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
    if (scene.active_stress->feedback() != nullptr && !TimeSegments(*scene.active_stress, scene.end_time).breaks().empty())
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

  std::vector<double>
  DisplacementGradient::derivatives(const std::span<const Variation> variations)
  {
    LaneAdjoint adjoint(natural_, method_);
    const LaneTables &tables     = adjoint.tables();
    const LaneSetup &setup       = tables.setup;
    const std::size_t n_points   = tables.points.size(), n = steps_.end().size();
    const RadauTableau &tableau  = radau_tableau(setup.n_stages);
    const std::size_t per_cell   = setup.degree + 1;
    std::vector<double> weights(n_points);
    for (std::size_t i = 0; i < n_points; ++i)
      weights[i] = setup.sizes[i / per_cell] * setup.weights[i % per_cell];

    ForcesAtPoints own(scene_, scene_, tables.points);
    std::vector<std::array<std::unique_ptr<ForcesAtPoints>, 4>> others(variations.size());
    for (std::size_t i = 0; i < variations.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k)
        others[i][k] = std::make_unique<ForcesAtPoints>(*variations[i].scenes[k], scene_, tables.points);
    std::vector<std::array<double, 4>> sums(variations.size());
    constexpr std::size_t most_samples = 4000000;
    const bool keeps_stress            = steps_.n_steps() * tableau.n * n_points <= most_samples;
    local_ = {tables.points, std::vector<double>(n_points, 0.), std::vector<double>(n_points, 0.), {}, {}};

    std::vector<double> y = steps_.end(), u(n), v(n), mu_at(n_points), mu_s(n_points);
    StateAtPoints at(n_points);
    const auto see = [&](const std::size_t step, const std::span<const double> mu) {
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
    std::vector<double> result;
    for (std::size_t i = 0; i < variations.size(); ++i)
    {
      std::array<double, 4> lengths;
      for (std::size_t k = 0; k < 4; ++k)
        lengths[k] = others[i][k]->units().length;
      result.push_back(units_.length * fourth_order(sums[i], variations[i].step) +
                       natural_displacement * fourth_order(lengths, variations[i].step));
    }
    for (double &s : local_.s)
      s *= units_.length;
    std::reverse(local_.times.begin(), local_.times.end());
    std::reverse(local_.stress.begin(), local_.stress.end());
    return result;
  }
} // namespace crawler
