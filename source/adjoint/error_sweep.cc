// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/adjoint/error_sweep.h>
#include <crawler/adjoint/forces_at_points.h>
#include <crawler/mesh/reference_element.h>
#include <crawler/run/accuracy_rule.h>
#include <crawler/time/radau_loops.h>
#include <crawler/time/radau_tableau.h>

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    using namespace accuracy_rule::sweep;

    /// The functions L_{q+1}, L_{q+2} at points x of [0,1]: integrals of Legendre polynomials, which vanish at both
    /// ends, with int L_j' L_l' dx = delta_jl over a cell of size 1; and their derivatives there. [point][function]
    struct Bubbles
    {
      static constexpr unsigned int n = 2;
      std::vector<double> values, slopes;

      Bubbles(const unsigned int degree, const std::vector<double> &points)
      {
        for (const double x : points)
          for (unsigned int j = degree + 1; j <= degree + n; ++j)
          {
            const double y = 2. * x - 1.;
            values.push_back((std::legendre(j, y) - std::legendre(j - 2, y)) / (2. * std::sqrt(2. * j - 1.)));
            slopes.push_back(std::legendre(j - 1, y) * std::sqrt(2. * j - 1.));
          }
      }
    };

    /// A finer quadrature in the same cells, with the tables that go with it.
    class FinePoints
    {
    public:
      explicit FinePoints(const LaneSetup &setup)
        : setup_(setup)
        , per_cell(setup.degree + 1 + more_points)
        , bubbles_(0, {})
      {
        const dealii::QGauss<1> gauss(per_cell);
        std::vector<double> places;
        for (unsigned int p = 0; p < per_cell; ++p)
        {
          places.push_back(gauss.point(p)[0]);
          weights_.push_back(gauss.weight(p));
        }
        const ReferenceElement &element = reference_element(setup.degree);
        values_                         = interpolation_matrix(element.nodes, places);
        slopes_                         = interpolation_matrix(element.nodes, places, 1);
        bubbles_                        = Bubbles(setup.degree, places);
        double left                     = 0.;
        for (std::size_t c = 0; c < setup.n_cells; left += setup.sizes[c++])
          for (const double place : places)
            points.push_back(left + place * setup.sizes[c]);
      }

      void
      evaluate(const double *nodal, std::vector<double> &values, std::vector<double> &slopes) const
      {
        const std::size_t n = setup_.degree + 1;
        for (std::size_t c = 0; c < setup_.n_cells; ++c)
          for (std::size_t p = 0; p < per_cell; ++p)
          {
            double value = 0., slope = 0.;
            for (std::size_t i = 0; i < n; ++i)
            {
              value += values_[p * n + i] * nodal[c * setup_.degree + i];
              slope += slopes_[p * n + i] * nodal[c * setup_.degree + i];
            }
            values[c * per_cell + p] = value;
            slopes[c * per_cell + p] = slope / setup_.sizes[c];
          }
      }

      /// Adds sum_j c_j L_j, @p c [cell][function].
      void
      add_bubbles(const double *c, std::vector<double> &values, std::vector<double> &slopes) const
      {
        for (std::size_t cell = 0; cell < setup_.n_cells; ++cell)
          for (std::size_t p = 0; p < per_cell; ++p)
            for (unsigned int j = 0; j < Bubbles::n; ++j)
            {
              const double factor = c[cell * Bubbles::n + j];
              values[cell * per_cell + p] += factor * bubbles_.values[p * Bubbles::n + j];
              slopes[cell * per_cell + p] += factor * bubbles_.slopes[p * Bubbles::n + j] / setup_.sizes[cell];
            }
      }

      /// int f L_j + N L_j' of a cell.
      double
      bubble_residual(const ForcesAtPoints &forces, const std::size_t cell, const unsigned int j) const
      {
        double sum = 0.;
        for (std::size_t p = 0; p < per_cell; ++p)
          sum += weights_[p] *
                 (setup_.sizes[cell] * forces.friction(cell * per_cell + p) * bubbles_.values[p * Bubbles::n + j] +
                  forces.body_force(cell * per_cell + p) * bubbles_.slopes[p * Bubbles::n + j]);
        return sum;
      }

      double
      weight(const std::size_t point) const
      {
        return weights_[point % per_cell] * setup_.sizes[point / per_cell];
      }

    private:
      const LaneSetup &setup_;
      std::vector<double> weights_, values_, slopes_; ///< of a cell of size 1: [point], [point][node]

    public:
      const std::size_t per_cell;
      std::vector<double> points;

    private:
      Bubbles bubbles_;
    };

    /// The derivative at the points c_i of the polynomial through values there: [i][j].
    std::vector<double>
    derivative_at_stages(const std::vector<double> &c)
    {
      return interpolation_matrix(c, c, 1);
    }

    /// One backward sweep.
    class Sweep
    {
    public:
      explicit Sweep(const RecordedRun &run)
        : run_(run)
        , method_(with_more_stages(run.method))
        , adjoint_(run.natural, method_)
        , setup_(adjoint_.tables().setup)
        , tableau_(radau_tableau(method_.n_stages))
        , fine_(setup_)
        , slopes_(derivative_at_stages(tableau_.c))
        , forces_(run.scene, run.scene, adjoint_.tables().points)
        , fine_forces_(run.scene, run.scene, fine_.points)
        , n_(run.steps.end().size())
        , n_bubbles_(setup_.n_cells * Bubbles::n)
        , u_(n_)
        , v_(n_)
        , at_(adjoint_.tables().points.size())
        , fine_at_(tableau_.n, StateAtPoints(fine_.points.size()))
      {
      }

      std::optional<SweptErrors>
      compute()
      {
        const LaneRecord steps = run_.steps.at_places(radau_tableau(run_.method.n_stages).c, tableau_.c);
        result_                = {};
        result_.of_steps.resize(steps.n_steps());
        result_.of_cells.resize(setup_.n_cells);
        y_               = steps.end();
        const auto start = adjoint_.solve(steps,
                                          adjoint_.gradient_of_displacement(),
                                          [&](const std::size_t step, const std::span<const double> mu, const auto &) {
                                            look(steps, step, mu.data());
                                          });
        if (!start || lost_)
          return std::nullopt;
        const double L = run_.units.length;
        for (double &error : result_.of_steps)
        {
          error *= L;
          result_.time += error;
          result_.time_sum += std::abs(error);
        }
        for (double &error : result_.of_cells)
        {
          error *= L;
          result_.space += error;
          result_.space_sum += std::abs(error);
        }
        result_.space_change = std::abs(result_.space - L * before_last_);
        return result_;
      }

    private:
      static LaneMethod
      with_more_stages(LaneMethod method)
      {
        method.n_stages += 2;
        return method;
      }

      double
      time_of(const LaneRecord &steps, const std::size_t step, const unsigned int stage) const
      {
        return steps.time(step) - (1. - tableau_.c[stage]) * steps.size(step);
      }

      void
      look(const LaneRecord &steps, const std::size_t step, const double *mu)
      {
        const double *z = steps.z(step);
        for (std::size_t d = 0; d < n_; ++d)
          y_[d] -= z[(tableau_.n - 1) * n_ + d];
        std::vector<double> of_cells(setup_.n_cells, 0.), mu_at(at_.u.size()), mu_s(at_.u.size());
        const std::size_t per_cell = setup_.degree + 1;
        for (unsigned int i = 0; i < tableau_.n; ++i)
        {
          for (std::size_t d = 0; d < n_; ++d)
            u_[d] = y_[d] + z[i * n_ + d];
          radau::stage_rate(static_cast<int>(tableau_.n),
                            tableau_.inverse.data(),
                            static_cast<int>(i),
                            1. / steps.size(step),
                            z,
                            static_cast<int>(n_),
                            v_.data());
          evaluate_at_points(setup_, u_.data(), at_.u, at_.e);
          evaluate_at_points(setup_, v_.data(), at_.v, at_.rate);
          evaluate_at_points(setup_, mu + i * n_, mu_at, mu_s);
          for (std::size_t p = 0; p < at_.e.size(); ++p)
            at_.w[p] = 1. + at_.e[p];
          forces_.evaluate(time_of(steps, step, i), steps.time(step), at_);
          for (std::size_t p = 0; p < at_.e.size(); ++p)
          {
            const double part = setup_.sizes[p / per_cell] * setup_.weights[p % per_cell] *
                                (forces_.body_force(p) * mu_s[p] + forces_.friction(p) * mu_at[p]);
            result_.of_steps[step] += part;
            of_cells[p / per_cell] -= part;
          }
          fine_.evaluate(u_.data(), fine_at_[i].u, fine_at_[i].e);
          fine_.evaluate(v_.data(), fine_at_[i].v, fine_at_[i].rate);
        }
        look_at_bubbles(steps, step, mu, of_cells);
      }

      /// The states of all stages with what the bubbles @p c [stage][cell][function] add.
      std::vector<StateAtPoints>
      with_bubbles(const std::vector<double> &c, const double h) const
      {
        std::vector<StateAtPoints> states = fine_at_;
        std::vector<double> rate(n_bubbles_);
        for (unsigned int i = 0; i < tableau_.n; ++i)
        {
          std::ranges::fill(rate, 0.);
          for (unsigned int j = 0; j < tableau_.n; ++j)
            for (std::size_t b = 0; b < n_bubbles_; ++b)
              rate[b] += slopes_[i * tableau_.n + j] / h * c[j * n_bubbles_ + b];
          fine_.add_bubbles(c.data() + i * n_bubbles_, states[i].u, states[i].e);
          fine_.add_bubbles(rate.data(), states[i].v, states[i].rate);
          for (std::size_t p = 0; p < states[i].e.size(); ++p)
            states[i].w[p] = 1. + states[i].e[p];
        }
        return states;
      }

      void
      look_at_bubbles(const LaneRecord &steps,
                      const std::size_t step,
                      const double *mu,
                      const std::vector<double> &without)
      {
        const double h = steps.size(step);
        std::vector<double> c(tableau_.n * n_bubbles_, 0.), mu_at(fine_.points.size()), mu_s(fine_.points.size());
        for (unsigned int round = 0; round <= rounds; ++round)
        {
          const auto states            = with_bubbles(c, h);
          std::vector<double> of_cells = without;
          for (unsigned int i = 0; i < tableau_.n; ++i)
          {
            if (*std::ranges::min_element(states[i].w) < least_stretch)
            {
              lost_ = true;
              return;
            }
            fine_forces_.evaluate(time_of(steps, step, i), steps.time(step), states[i]);
            if (round + 1 >= rounds) // of the last two
            {
              fine_.evaluate(mu + i * n_, mu_at, mu_s);
              for (std::size_t p = 0; p < mu_at.size(); ++p)
                of_cells[p / fine_.per_cell] +=
                  fine_.weight(p) * (fine_forces_.body_force(p) * mu_s[p] + fine_forces_.friction(p) * mu_at[p]);
            }
            for (std::size_t cell = 0; cell < setup_.n_cells && round < rounds; ++cell)
            {
              double k = 0.;
              for (std::size_t p = 0; p < fine_.per_cell; ++p)
                k += fine_.weight(cell * fine_.per_cell + p) * fine_forces_.elastic(cell * fine_.per_cell + p, 1.);
              for (unsigned int j = 0; j < Bubbles::n; ++j)
                c[i * n_bubbles_ + cell * Bubbles::n + j] -=
                  fine_.bubble_residual(fine_forces_, cell, j) * setup_.sizes[cell] * setup_.sizes[cell] / k;
            }
          }
          if (round + 1 == rounds)
            for (const double part : of_cells)
              before_last_ += part;
          if (round == rounds)
            for (std::size_t cell = 0; cell < setup_.n_cells; ++cell)
              result_.of_cells[cell] += of_cells[cell];
        }
      }

      const RecordedRun &run_;
      const LaneMethod method_;
      LaneAdjoint adjoint_;
      const LaneSetup &setup_;
      const RadauTableau &tableau_;
      const FinePoints fine_;
      const std::vector<double> slopes_; ///< derivatives at the stages
      ForcesAtPoints forces_, fine_forces_;
      const std::size_t n_, n_bubbles_;
      std::vector<double> y_, u_, v_;
      StateAtPoints at_;
      std::vector<StateAtPoints> fine_at_; ///< of the stages, without bubbles
      SweptErrors result_{};
      double before_last_ = 0.; ///< error in space with one round less, in natural units
      bool lost_          = false;
    };
  } // namespace

  double
  SweptErrors::bound_of_corrected() const
  {
    return part_of_sums * (time_sum + space_sum) + space_change;
  }

  std::optional<SweptErrors>
  sweep_errors(const RecordedRun &run)
  {
    return Sweep(run).compute();
  }
} // namespace crawler
