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

    /// The force N in a body and the friction f at points, in natural units of the body.
    class ForcesAtPoints
    {
    public:
      ForcesAtPoints(const Scene &physical, const std::vector<double> &points)
        : units_(natural_units(physical))
        , segments_(*physical.active_stress, physical.end_time)
        , scene_(in_units(physical, units_, &segments_))
        , body_(scene_, points)
        , sliding_(scene_, points)
        , g_(points.size())
      {
      }

      const Units &
      units() const
      {
        return units_;
      }

      /// At the time @p t in the piece that ends at @p end or later.
      void
      evaluate(const double t, const double end, const StateAtPoints &at)
      {
        constexpr double tiny = 1e-12;
        for (segments_.restart(); !segments_.is_last() && segments_.end() < end - tiny;)
          segments_.go_on();
        body_.evaluate(segments_.inside(t), at.e, {at.w, at.rate, {}, {}});
        sliding_.evaluate(at.u, at.v);
        scene_.friction->values(at.w, g_);
      }

      double
      N(const std::size_t point) const
      {
        return body_.N[point];
      }
      double
      f(const std::size_t point) const
      {
        return g_[point] * sliding_.force[point];
      }
      double
      elastic(const std::size_t point, const double e) const
      {
        return body_.k[point] * e;
      }

    private:
      const Units units_;
      TimeSegments segments_;
      const Scene scene_;
      BodyForceAtPoints body_;
      SlidingAtPoints sliding_;
      std::vector<double> g_;
    };

    /// f' from f(-2), f(-1), f(1), f(2).
    double
    fourth_order(const std::array<double, 4> &values, const double step)
    {
      return (8. * (values[2] - values[1]) - (values[3] - values[0])) / (12. * step);
    }

    bool
    are_near(const std::vector<double> &a, const std::vector<double> &b)
    {
      constexpr double same = 1e-9;
      return std::equal(
        a.begin(), a.end(), b.begin(), b.end(), [](const double x, const double y) { return std::abs(x - y) <= same; });
    }

    LaneMethod
    method_of(const Scene &natural, const TimeParameters &time, const Numerics &numerics)
    {
      return batch_method(natural, time, numerics).value();
    }
  } // namespace

  bool
  have_same_breaks(const Scene &scene, const Scene &other)
  {
    const auto places = [](const Scene &one) {
      std::vector<double> list = one.breaks_in_space();
      for (double &place : list)
        place /= one.body.length;
      return list;
    };
    return are_near(places(scene), places(other)) && are_near(TimeSegments(*scene.active_stress, scene.end_time).breaks(),
                                                              TimeSegments(*other.active_stress, other.end_time).breaks());
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

    ForcesAtPoints own(scene_, tables.points);
    std::vector<std::array<std::unique_ptr<ForcesAtPoints>, 4>> others(variations.size());
    for (std::size_t i = 0; i < variations.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k)
        others[i][k] = std::make_unique<ForcesAtPoints>(*variations[i].scenes[k], tables.points);
    std::vector<std::array<double, 4>> sums(variations.size());
    local_ = {tables.points, std::vector<double>(n_points, 0.), std::vector<double>(n_points, 0.)};

    std::vector<double> y = steps_.end(), u(n), v(n), mu_at(n_points), mu_s(n_points);
    StateAtPoints at(n_points);
    const auto see = [&](const std::size_t step, const std::span<const double> mu) {
      const double *z = steps_.z(step);
      for (std::size_t d = 0; d < n; ++d)
        y[d] -= z[(tableau.n - 1) * n + d];
      for (unsigned int i = 0; i < tableau.n; ++i)
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
    for (std::size_t p = 0; p < n_points; ++p)
      local_.s[p] *= units_.length; // a density by s/L times L is one by s times L^2: of x ds in lengths it stays
    return result;
  }
} // namespace crawler
