// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/adjoint/error_sweep.h>
#include <crawler/adjoint/forces_at_points.h>
#include <crawler/mesh/reference_element.h>
#include <crawler/time/radau_tableau.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    // Constants measured by tests/verification/error_sweep_test.cc; doc/numerics.md, "Errors by the adjoint".
    /// Quadrature points of a cell beyond its degree + 1; number of improvements of the functions of higher degree.
    constexpr unsigned int more_points = 2, rounds = 2;
    /// Bound of the corrected displacement: this part of the sums of the sizes of all errors, plus the change of the
    /// last round. Nothing is estimated below least_stretch.
    constexpr double part_of_sums = 0.4, least_stretch = 0.1;

    /// Functions L_{q+1}, L_{q+2} at points x of [0,1]: integrals of Legendre polynomials, which vanish at both ends,
    /// with int L_j' L_l' dx = delta_jl over a cell of size 1; and their derivatives there. [point][function]
    struct Bubbles
    {
      static constexpr unsigned int n = 2;
      std::vector<double> values, slopes;

      Bubbles(const unsigned int degree, const std::vector<double> &points)
      {
        for (const double x : points)
          for (unsigned int j = degree + 1; j <= degree + n; ++j)
          {
            values.push_back(integrated_legendre(j - 1, x) * std::sqrt(2. * j - 1.));
            slopes.push_back(std::legendre(j - 1, 2. * x - 1.) * std::sqrt(2. * j - 1.));
          }
      }
    };

    /// One backward sweep.
    class ErrorSweep
    {
    public:
      explicit ErrorSweep(const RecordedRun &run)
        : adjoint_(run.natural, with_more_stages(run.method))
        , setup_(adjoint_.tables().setup)
        , c_(radau_tableau(setup_.n_stages).c)
        , steps_(run.steps.at_places(radau_tableau(run.method.n_stages).c, c_))
        , stages_(steps_, setup_)
        , cells_(setup_)
        , fine_(setup_, more_points)
        , bubbles_(setup_.degree, fine_.places)
        , slopes_(interpolation_matrix(c_, c_, /*derivative=*/true))
        , forces_(run.scene, run.scene, cells_.points)
        , fine_forces_(run.scene, run.scene, fine_.points)
        , fine_at_(setup_.n_stages, StateAtPoints(fine_.size()))
      {
      }

      /// Errors of a body of this length.
      std::optional<SweptErrors>
      compute(const double length)
      {
        result_.of_steps.resize(steps_.times.size());
        result_.of_cells.resize(setup_.n_cells);
        const bool is_solved = adjoint_.solve(
          steps_,
          adjoint_.gradient_of_displacement(),
          [this](const std::size_t step, const std::span<const double> mu, const auto &) { look(step, mu); });
        if (!is_solved || lost_)
          return std::nullopt;
        const auto sum_up = [length](std::vector<double> &errors, double &sum, double &sum_of_sizes) {
          for (double &error : errors)
          {
            error *= length;
            sum += error;
            sum_of_sizes += std::abs(error);
          }
        };
        sum_up(result_.of_steps, result_.time, result_.time_sum);
        sum_up(result_.of_cells, result_.space, result_.space_sum);
        result_.space_change = std::abs(result_.space - length * before_last_);
        return result_;
      }

    private:
      static LaneMethod
      with_more_stages(LaneMethod method)
      {
        method.n_stages += 2;
        return method;
      }

      void
      look(const std::size_t step, const std::span<const double> mu)
      {
        std::vector<double> of_cells(setup_.n_cells, 0.), mu_at(cells_.size()), mu_s(cells_.size());
        StateAtPoints at(cells_.size());
        const std::size_t n = mu.size() / setup_.n_stages;
        stages_.go_back(step);
        for (unsigned int i = 0; i < setup_.n_stages; ++i)
        {
          stages_.go_to_stage(i);
          cells_.evaluate(stages_, at);
          cells_.evaluate(mu.data() + i * n, mu_at, mu_s);
          forces_.evaluate(steps_.times[step], at);
          for (std::size_t p = 0; p < cells_.size(); ++p)
          {
            const double part = cells_.weight(p) * (forces_.body_force(p) * mu_s[p] + forces_.friction(p) * mu_at[p]);
            result_.of_steps[step] += part;
            of_cells[cells_.cell_of(p)] -= part;
          }
          fine_.evaluate(stages_, fine_at_[i]);
        }
        look_at_bubbles(step, mu.data(), n, of_cells);
      }

      /// Adds the bubbles of all cells, @p c [cell][function], at the points of the cells.
      void
      add_bubbles(const double *c, std::vector<double> &values, std::vector<double> &slopes) const
      {
        for (std::size_t p = 0; p < fine_.size(); ++p)
          for (unsigned int j = 0; j < Bubbles::n; ++j)
          {
            const std::size_t cell = fine_.cell_of(p), row = p % fine_.per_cell * Bubbles::n + j;
            values[p] += c[cell * Bubbles::n + j] * bubbles_.values[row];
            slopes[p] += c[cell * Bubbles::n + j] * bubbles_.slopes[row] / setup_.sizes[cell];
          }
      }

      /// States of all stages with the contribution of the bubbles @p c [stage][cell][function].
      std::vector<StateAtPoints>
      with_bubbles(const std::vector<double> &c, const double h) const
      {
        std::vector<StateAtPoints> states = fine_at_;
        std::vector<double> rate(n_bubbles());
        for (unsigned int i = 0; i < setup_.n_stages; ++i)
        {
          std::ranges::fill(rate, 0.);
          for (unsigned int j = 0; j < setup_.n_stages; ++j)
            for (std::size_t b = 0; b < n_bubbles(); ++b)
              rate[b] += slopes_[i * setup_.n_stages + j] / h * c[j * n_bubbles() + b];
          add_bubbles(c.data() + i * n_bubbles(), states[i].u, states[i].e);
          add_bubbles(rate.data(), states[i].v, states[i].rate);
          for (std::size_t p = 0; p < states[i].e.size(); ++p)
            states[i].w[p] = 1. + states[i].e[p];
        }
        return states;
      }

      /// Improves the bubbles of a stage by one round: c_j <- c_j - F(U + e; L_j)/k.
      void
      improve(double *c) const
      {
        for (std::size_t cell = 0; cell < setup_.n_cells; ++cell)
        {
          double k = 0., residual[Bubbles::n] = {};
          for (std::size_t i = 0; i < fine_.per_cell; ++i)
          {
            const std::size_t p = cell * fine_.per_cell + i;
            k += fine_.weight(p) * fine_forces_.elastic(p, 1.);
            for (unsigned int j = 0; j < Bubbles::n; ++j)
              residual[j] += fine_.weight(p) *
                             (fine_forces_.friction(p) * bubbles_.values[i * Bubbles::n + j] +
                              fine_forces_.body_force(p) * bubbles_.slopes[i * Bubbles::n + j] / setup_.sizes[cell]);
          }
          for (unsigned int j = 0; j < Bubbles::n; ++j)
            c[cell * Bubbles::n + j] -= residual[j] * setup_.sizes[cell] * setup_.sizes[cell] / k;
        }
      }

      /// @p mu: [stages][n]; @p without: the run's own part in each cell.
      void
      look_at_bubbles(const std::size_t step, const double *mu, const std::size_t n, const std::vector<double> &without)
      {
        std::vector<double> c(setup_.n_stages * n_bubbles(), 0.), mu_at(fine_.size()), mu_s(fine_.size());
        for (unsigned int round = 0; round <= rounds; ++round)
        {
          const auto states            = with_bubbles(c, steps_.sizes[step]);
          std::vector<double> of_cells = without;
          for (unsigned int i = 0; i < setup_.n_stages; ++i)
          {
            if (*std::ranges::min_element(states[i].w) < least_stretch)
            {
              lost_ = true;
              return;
            }
            fine_forces_.evaluate(steps_.times[step], states[i]);
            if (round + 1 >= rounds) // the last two rounds
            {
              fine_.evaluate(mu + i * n, mu_at, mu_s);
              for (std::size_t p = 0; p < fine_.size(); ++p)
                of_cells[fine_.cell_of(p)] +=
                  fine_.weight(p) * (fine_forces_.body_force(p) * mu_s[p] + fine_forces_.friction(p) * mu_at[p]);
            }
            if (round < rounds)
              improve(c.data() + i * n_bubbles());
          }
          for (std::size_t cell = 0; cell < setup_.n_cells; ++cell)
            if (round + 1 == rounds)
              before_last_ += of_cells[cell];
            else if (round == rounds)
              result_.of_cells[cell] += of_cells[cell];
        }
      }

      /// Number of the bubbles in all cells.
      std::size_t
      n_bubbles() const
      {
        return setup_.n_cells * Bubbles::n;
      }

      LaneAdjoint adjoint_;
      const LaneSetup &setup_;
      const std::vector<double> &c_; ///< stages of the method with more of them
      const LaneRecord steps_;       ///< steps with the states at these stages
      BackwardStages stages_;
      const CellPoints cells_, fine_;
      const Bubbles bubbles_;
      const std::vector<double> slopes_; ///< derivatives at the stages of the polynomial through values there
      ForcesAtPoints forces_, fine_forces_;
      std::vector<StateAtPoints> fine_at_; ///< [stage], without bubbles
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
    return ErrorSweep(run).compute(run.units.length);
  }
} // namespace crawler
