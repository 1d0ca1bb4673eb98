// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/adjoint/displacement_gradient.h>
#include <crawler/adjoint/forces_at_points.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace crawler
{
  namespace
  {
    /// f' from f(-2), f(-1), f(1), f(2).
    double
    fourth_order(const std::array<double, 4> &values, const double step)
    {
      return (8. * (values[2] - values[1]) - (values[3] - values[0])) / (12. * step);
    }

    /// A number that varies: the forces in the four scenes, and what they change.
    struct Direction
    {
      std::array<std::unique_ptr<ForcesAtPoints>, 4> forces;
      std::array<double, 4> sums = {}; ///< of the displacement, in natural units
      double at_edges            = 0.; ///< of them, by jumps at start and end
    };

    /// One backward sweep.
    class Sweep
    {
    public:
      Sweep(const RecordedRun &run, const std::span<const Variation> variations, LocalSensitivity &local)
        : run_(run)
        , local_(local)
        , adjoint_(run.natural, run.method)
        , setup_(adjoint_.tables().setup)
        , tableau_(radau_tableau(setup_.n_stages))
        , cells_(setup_)
        , stages_(run.steps, tableau_)
        , own_(run.scene, run.scene, cells_.points())
        , at_(cells_.size())
        , mu_(cells_.size())
        , mu_s_(cells_.size())
        , zeta_(cells_.size())
        , zeta_s_(cells_.size())
      {
        for (const Variation &variation : variations)
        {
          Direction &direction = directions_.emplace_back();
          for (std::size_t k = 0; k < 4; ++k)
            direction.forces[k] = std::make_unique<ForcesAtPoints>(*variation.scenes[k], run.scene, cells_.points());
        }
        constexpr std::size_t most_samples = 4000000;
        keeps_stress_                      = run.steps.n_steps() * tableau_.n * cells_.size() <= most_samples;
        local_ = {cells_.points(), std::vector<double>(cells_.size()), std::vector<double>(cells_.size()), {}, {}};
      }

      void
      make()
      {
        look_at_end();
        const auto by_start = adjoint_.solve(run_.steps,
                                             adjoint_.gradient_of_displacement(),
                                             [this](const std::size_t step,
                                                    const std::span<const double> mu,
                                                    const std::span<const double> zeta) { look(step, mu, zeta); });
        if (!by_start)
          throw std::runtime_error("the adjoint of a step did not converge");
        for (double &s : local_.s)
          s *= run_.units.length;
        std::ranges::reverse(local_.times);
        std::ranges::reverse(local_.stress);
      }

      /// There is none where jumps at the edges count.
      std::optional<double>
      derivative(const std::size_t number, const double step) const
      {
        constexpr double nothing   = 1e-7;
        const Direction &direction = directions_[number];
        std::array<double, 4> lengths;
        for (std::size_t k = 0; k < 4; ++k)
          lengths[k] = direction.forces[k]->units().length;
        const double L = run_.units.length;
        const double result =
          L * fourth_order(direction.sums, step) + run_.displacement / L * fourth_order(lengths, step);
        return L * direction.at_edges <= nothing * step * std::abs(result) ? std::optional(result) : std::nullopt;
      }

    private:
      /// The mean displacement of a body that is longer in some places.
      void
      look_at_end()
      {
        cells_.evaluate(run_.steps.end().data(), at_.u, at_.e);
        for (Direction &direction : directions_)
          for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t p = 0; p < cells_.size(); ++p)
              direction.sums[k] += cells_.weight(p) * (direction.forces[k]->longer(p) - 1.) * at_.u[p];
      }

      void
      look(const std::size_t step, const std::span<const double> mu, const std::span<const double> zeta)
      {
        const std::size_t n = mu.size() / tableau_.n;
        const double end = run_.steps.time(step), h = run_.steps.size(step);
        if (!zeta.empty())
          cells_.evaluate(zeta.data(), zeta_, zeta_s_);
        stages_.go_back(step);
        for (unsigned int i = tableau_.n; i-- > 0;)
        {
          stages_.go_to_stage(i);
          cells_.evaluate(stages_.u(), stages_.v(), at_);
          cells_.evaluate(mu.data() + i * n, mu_, mu_s_);
          own_.evaluate(stages_.time(), end, at_);
          add_local(h * tableau_.b[i]);
          const bool is_start = step == 0 && i == 0, is_end = i + 1 == tableau_.n;
          for (Direction &direction : directions_)
            for (std::size_t k = 0; k < 4; ++k)
            {
              ForcesAtPoints &forces = *direction.forces[k];
              forces.evaluate(stages_.time(), end, at_);
              for (std::size_t p = 0; p < cells_.size(); ++p) // the differences, since the sums nearly cancel
                direction.sums[k] += cells_.weight(p) * ((forces.body_force(p) - own_.body_force(p)) * mu_s_[p] +
                                                         (forces.friction(p) - own_.friction(p)) * mu_[p]);
              if (is_end && forces.has_between(end, false))
                add_impulse(direction, k, forces.between(end, false), zeta_s_, -1., end == 1.);
              if (is_start && forces.has_between(0., true))
                add_impulse(direction, k, forces.between(0., true), mu_s_, 1. / (h * tableau_.b[i]), true);
            }
        }
      }

      /// @p weight of the stage.
      void
      add_local(const double weight)
      {
        for (std::size_t p = 0; p < cells_.size(); ++p)
        {
          local_.elastic_modulus[p] += own_.elastic(p, at_.e[p]) * mu_s_[p];
          local_.friction[p] += own_.friction(p) * mu_[p];
        }
        if (!keeps_stress_)
          return;
        local_.times.push_back(stages_.time() * run_.units.time);
        for (std::size_t p = cells_.size(); p-- > 0;)
          local_.stress.push_back(mu_s_[p] / (weight * run_.units.force * run_.units.time));
      }

      void
      add_impulse(Direction &direction,
                  const std::size_t k,
                  const std::vector<double> &impulse,
                  const std::vector<double> &effect,
                  const double factor,
                  const bool is_edge) const
      {
        double sum = 0.;
        for (std::size_t p = 0; p < cells_.size(); ++p)
          sum += factor * cells_.weight(p) * impulse[p] * effect[p];
        direction.sums[k] += sum;
        // Where friction is not linear in the velocity an impulse is more than its size.
        if (is_edge || (setup_.laws & LaneLaws::nonlinear_in_velocity) != 0)
          direction.at_edges = std::max(direction.at_edges, std::abs(sum));
      }

      const RecordedRun &run_;
      LocalSensitivity &local_;
      LaneAdjoint adjoint_;
      const LaneSetup &setup_;
      const RadauTableau &tableau_;
      const CellPoints cells_;
      BackwardStages stages_;
      ForcesAtPoints own_;
      std::vector<Direction> directions_;
      bool keeps_stress_ = true;
      StateAtPoints at_;
      std::vector<double> mu_, mu_s_, zeta_, zeta_s_; ///< adjoint at the points, and its derivatives by s
    };
  } // namespace

  bool
  have_similar_breaks(const Scene &scene, const Scene &other)
  {
    return BreakMap(breaks_in_space_of(scene), breaks_in_space_of(other)).is_one_to_one() &&
           BreakMap(breaks_in_time_of(scene), breaks_in_time_of(other)).is_good();
  }

  DisplacementGradient::DisplacementGradient(const RecordedRun &run)
    : run_(run)
  {
  }

  std::vector<std::optional<double>>
  DisplacementGradient::derivatives(const std::span<const Variation> variations)
  {
    Sweep sweep(run_, variations, local_);
    sweep.make();
    std::vector<std::optional<double>> result;
    for (std::size_t i = 0; i < variations.size(); ++i)
      result.push_back(sweep.derivative(i, variations[i].step));
    return result;
  }
} // namespace crawler
