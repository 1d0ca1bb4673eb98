// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/extrapolation.h>
#include <crawler/accuracy/finer_run_errors.h>
#include <crawler/accuracy/mesh_family.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    // Constants measured by tests/verification/random_extremes.cc and tests/benchmark/stretch_table.cc;
    // doc/numerics.md, "Stretch form".
    /// Cells of the finest mesh: in general, for an Accuracy below accurate, and of bodies that invert.
    constexpr unsigned int max_cells = 51200, max_cells_if_accurate = 6400, max_cells_if_inverted = 1600;
    constexpr double accurate = 2e-6;
    /// Limits on cells times steps of the next mesh, about a second for each 2e6, in general, for an Accuracy below
    /// accurate, and if it is the last one by the observed order and the other form has no mesh; factor by which it
    /// takes more of them than the last one.
    constexpr double max_work = 2.5e7, max_work_if_accurate = 5e7, max_work_if_near = 1e8, more_work = 5.;
    /// Part of the wanted error that the error in time may be; number of reductions of the time tolerance for that.
    constexpr double time_part            = 0.3;
    constexpr unsigned int max_tolerances = 5;
    constexpr double finer_tolerance      = 0.1;
    /// Stretch below which cells are empty; largest tolerance that checks the error in time then, over the length.
    constexpr double empty = 1e-9, check_if_empty = 3e-8;
    constexpr unsigned int few_steps = 30;                 ///< steps below which errors grow fast with the cells
    constexpr double min_part        = 0.5;                ///< part of the wanted error that all runs have in common
    constexpr double min_order = 1.5, largest_order = 2.7; ///< observed orders accepted as the second
    /// Factors by which a time tolerance, relative to the strain, may be too large or small before it is chosen anew.
    constexpr double too_large = 2., too_small = 0.05;
    /// Limits relative to the time of an inversion: error beyond which it may be none; change beyond which meshes are
    /// too coarse.
    constexpr double believed = 0.3, largest_change_of_inversion = 0.2;
    /// Round-off of the displacement, in lengths of the body.
    constexpr double round_off = 4e-15;
    /// Rates at which extrapolations settle: the fastest that is believed, and at a turning point. Regions thinner than
    /// cells count unseen_part of their length, for a displacement of at least part_of_largest displacement of a point.
    constexpr double fastest = 8., turned = 4., unseen_part = 0.15, part_of_largest = 0.25;
    /// Factor on the last change of the time of an inversion for its error, for a between min_slow_exponent and 0, and
    /// the rate at which such changes are believed to fall.
    constexpr double min_slow_exponent = -0.5, sticking_factor = 3., sticking_rate = 3.;
    /// Deviation of the order from 2 up to which that is accepted; else a first change counts unclean_factor times.
    /// Two orders in a row that deviate by at most regular are no chance.
    constexpr double clean = 0.25, unclean_factor = 2., regular = 0.1;
    /// Least relative error of the displacement, as a part of the relative change of the extrapolated work.
    constexpr double part_like_work = 0.04;

    class Family
    {
    public:
      Family(const Problem &problem,
             const NumericsChoice &choice,
             const RecordOptions &options,
             const std::function<bool()> &is_for_other_form)
        : problem_(problem)
        , is_for_other_form_(is_for_other_form)
        , parameters_(problem.parameters)
        , scene_(problem.scene)
        , options_(options)
      {
        answer_.choice          = choice;
        options_.resolution     = ResolutionWish::size; // the size of the deformation
        options_.energy_balance = true;                 // works tell whether displacements agree by chance
        options_.cycles         = cycle_wish(parameters_, scene_, /*has_pictures=*/false); // these runs write none
        if (options_.cycles)
          options_.cycles->accuracy *= 0.1; // displacements are compared
      }

      Answer
      compute()
      {
        settle_time();
        if (is_final(latest_))
          return end();
        keep(latest_);
        for (;;)
        {
          const bool good = is_good_in_space();
          if (good ? is_fine_in_time() : 2 * latest_.process.mesh.n_cells > max_cells_now() || !is_worth_it())
            break;
          if (!good)
            numerics().parts *= 2;
          latest_ = run(numerics());
          if (is_final(latest_))
            return end();
          keep(latest_);
        }
        if (latest_.inversion && std::isfinite(space_error_) && sticks() && (!has_order() || inverts_slowly()))
          check_inversion();
        return end();
      }

    private:
      bool
      sticks() const
      {
        const double a = scene_.friction_exponent();
        return a > -1. && a < 0.;
      }

      bool
      inverts_slowly() const
      {
        return latest_.inversion && sticks() && scene_.friction_exponent() > min_slow_exponent;
      }

      /// True if the last meshes show an order.
      bool
      has_order() const
      {
        return !levels_.empty() && levels_.back().order > min_order;
      }

      bool
      is_worth_it() const
      {
        const double work = more_work * latest_.process.mesh.n_cells * latest_.time.steps;
        if (work <= (parameters_.accuracy < accurate ? max_work_if_accurate : max_work))
          return true;
        const bool is_near = has_order() && space_error_ / 4. <= (1. - time_part) * wanted(); // one mesh more
        return work <= max_work_if_near && is_near && !is_for_other_form_();
      }

      unsigned int
      max_cells_now() const
      {
        if (latest_.inversion && space_error_ <= believed * latest_.inversion->t)
          return max_cells_if_inverted;
        return parameters_.accuracy < accurate ? max_cells_if_accurate : max_cells; // the position form may need fewer
      }

      Numerics &
      numerics()
      {
        return answer_.choice.numerics;
      }

      SimulationResult
      run(const Numerics &numerics)
      {
        ++n_runs_;
        return Simulation(MPI_COMM_SELF, scene_, parameters_.time, numerics).run({}, options_, {}, problem_.keep_going);
      }

      static bool
      finished(const SimulationResult &result)
      {
        return result.time.status == Status::finished;
      }

      /// True if a finer mesh gives no more information.
      static bool
      is_final(const SimulationResult &result)
      {
        return result.time.status == Status::stopped || result.time.reason == "inverted_at_end" ||
               result.time.reason == "law_not_positive" || result.time.reason == "nonfinite";
      }

      /// Value that has to settle: the displacement, or the time of inversion.
      static std::optional<double>
      value(const SimulationResult &result)
      {
        if (finished(result))
          return result.displacement;
        return result.inversion ? std::optional(result.inversion->t) : std::nullopt;
      }

      static bool
      are_alike(const SimulationResult &a, const SimulationResult &b)
      {
        return value(a) && value(b) && finished(a) == finished(b);
      }

      static double
      strain(const SimulationResult &result)
      {
        return std::max(1. - result.stretch.min.value, result.stretch.max.value - 1.);
      }

      void
      measure_size()
      {
        size_ = finished(latest_)
                  ? std::max(std::abs(latest_.displacement), displacement_floor * latest_.size.largest_u)
                  : scene_.end_time;
      }

      double
      wanted() const
      {
        return std::max(parameters_.accuracy * size_, round_off * scene_.body.length);
      }

      /// Smaller time tolerance that shows the error of this one. Cells that become empty refill according to the
      /// little that is left in them, which only small tolerances see at all.
      double
      checking(const double tolerance) const
      {
        const double usual = finer_tolerance * tolerance;
        return latest_.stretch.min.value < empty ? std::min(usual, check_if_empty * scene_.body.length) : usual;
      }

      /// Settles the time tolerance: on the coarsest mesh a tenth of it must make little difference.
      void
      settle_time()
      {
        latest_            = run(numerics());
        const double right = numerics().tolerance * strain(latest_) / answer_.choice.strain;
        if (!parameters_.time.tolerance && strain(latest_) > 0. &&
            (numerics().tolerance > too_large * right || numerics().tolerance < too_small * right))
        {
          numerics().tolerance = std::min(right, numerics().tolerance * 100.);
          latest_              = run(numerics());
        }
        measure_size();
        SimulationResult other;
        double checked = 0.; ///< tolerance of that run
        for (unsigned int i = 0; i < max_tolerances && value(latest_); ++i)
        {
          if (Numerics finer = numerics(); checking(finer.tolerance) != checked)
          {
            finer.tolerance = checked = checking(finer.tolerance);
            other                     = run(finer);
          }
          if (!value(other))
          {
            if (is_final(other))
              latest_ = other;
            break;
          }
          if (are_alike(other, latest_))
          {
            time_error_  = 2. * std::abs(*value(other) - *value(latest_));
            time_errors_ = number_errors(other, latest_, 2., 0.);
            if (time_error_ <= time_part * wanted() || parameters_.time.tolerance)
              break;
          }
          numerics().tolerance *= finer_tolerance;
          latest_ = numerics().tolerance > checked ? run(numerics()) : other;
          measure_size();
        }
      }

      /// Measures the error in time, which grows with the number of cells on stiff bodies, again on the last mesh but
      /// one, or on the last one itself if this takes few steps, whose errors grow fast. If it is too large the last
      /// mesh must be repeated with the smaller tolerance. Returns true if it is not.
      bool
      is_fine_in_time()
      {
        if (parameters_.time.tolerance || levels_.size() < 2)
          return true;
        const bool is_on_last       = latest_.time.steps <= few_steps;
        SimulationResult &before    = levels_[levels_.size() - 2].result;
        const SimulationResult &own = is_on_last ? latest_ : before;
        Numerics half               = numerics();
        half.parts /= 2;
        Numerics other = is_on_last ? numerics() : half;
        // Change from looser steps, which cost less, bounds the error amply. Either error may be small by chance.
        const auto accept = [&](const double error) {
          time_error_ = std::max(error, std::min(time_error_, time_part * wanted()));
          return true;
        };
        if (latest_.stretch.min.value >= empty)
        {
          other.tolerance               = numerics().tolerance / finer_tolerance;
          const SimulationResult looser = run(other);
          const double error            = are_alike(looser, own) ? std::abs(*value(looser) - *value(own)) : HUGE_VAL;
          if (error <= time_part * wanted())
            return accept(error);
        }
        other.tolerance = half.tolerance = checking(numerics().tolerance);
        const SimulationResult result    = run(other);
        if (!are_alike(result, own))
          return true;
        const double error = 2. * std::abs(*value(result) - *value(own));
        if (error <= time_part * wanted() || ++n_corrections_ > max_tolerances)
          return accept(error);
        numerics().tolerance = other.tolerance;
        before               = is_on_last ? run(half) : result;
        levels_.pop_back();
        return false;
      }

      /// Extrapolates, and finds the error in space.
      void
      keep(const SimulationResult &result)
      {
        measure_size();
        extrapolated_ = result;
        space_error_  = HUGE_VAL;
        if (!value(result))
        {
          levels_.clear();
          return;
        }
        if (!levels_.empty() && !are_alike(result, levels_.back().result)) // earlier assumptions are false
          levels_.clear();
        Level now{result, *value(result)};
        now.work = work_of(result);
        if (!levels_.empty())
        {
          const Level &before = levels_.back();
          const double change = *value(result) - *value(before.result);
          if (!inverts_slowly())
            extrapolate(before.result);
          now.value   = *value(extrapolated_);
          now.work    = work_of(extrapolated_);
          now.change  = change;
          now.settled = now.value - before.value;
          // Displacements of two meshes may agree by chance; times that have changed by much show no order yet.
          const bool inverts_elsewhere =
            latest_.inversion && std::abs(before.change) > largest_change_of_inversion * latest_.inversion->t;
          if (levels_.size() > 1 && !inverts_elsewhere)
          {
            const double error = (end_is_nearly_lost() ? 2. : 1.) * error_of(before, now);
            space_error_       = std::max(error, unseen(now));
          }
        }
        levels_.push_back(now);
      }

      struct Level
      {
        SimulationResult result;
        double value;        ///< extrapolated value
        double work    = 0.; ///< extrapolated work of the active stress; 0 if it was not computed
        double change  = 0.,
               settled = HUGE_VAL; ///< changes of the value itself and of the extrapolated one since the last level
        double order   = 0.;       ///< observed order of the value; 0 if there is none
      };

      /// Error by thin features: diffusion smooths the stretch over `length` in a stride, and the displacements of
      /// meshes with larger cells seem to converge without features as thin. Where they do not even seem to, nothing is
      /// known.
      double
      unseen(const Level &now) const
      {
        const Body &body    = scene_.body;
        const double stride = scene_.active_stress->period().value_or(scene_.end_time),
                     length = std::sqrt(body.elastic_modulus * stride / body.friction_coefficient) / body.length;
        const bool is_seen  = now.result.process.mesh.n_cells * length >= 1.;
        if (is_seen || !finished(now.result))
          return 0.;
        const double size = std::max(std::abs(now.value), part_of_largest * now.result.size.largest_u);
        return now.order < min_order ? HUGE_VAL : unseen_part * length * size;
      }

      /// True if an end is nearly lost: the last half of a cell then has friction unlike that of its middle, and order
      /// 2 shows late.
      bool
      end_is_nearly_lost() const
      {
        const double L = scene_.body.length, s = latest_.stretch.min.s;
        return latest_.stretch.min.value < 0.1 && (s < 0.02 * L || s > 0.98 * L);
      }

      /// Error of the extrapolated value, from the last two changes.
      double
      error_of(const Level &before, Level &now)
      {
        // Changes of alternating sign have no order.
        const double change = std::abs(now.change), last = std::abs(before.change);
        const double order  = now.change * before.change < 0. ? 0. : std::log2(last / change);
        const bool is_clean = std::abs(order - 2.) < clean;
        now.order           = order;
        if (inverts_slowly())
          return sticking_factor * std::max(change, last / sticking_rate);
        if (!(order > 0.2))
          return 5. * change;
        if (order < min_order)
          return std::max(std::abs(now.settled), change / (std::exp2(order) - 1.));
        const double least = std::max(std::abs(now.settled), error_like_work(before, now));
        if (order > largest_order)
          return std::max(least, change / 3.);
        // Displacements may agree by chance; their works rarely do at the same time, nor do three changes in a row.
        const bool is_regular = std::abs(order - 2.) < regular && std::abs(before.order - 2.) < regular;
        const double settled  = std::max(least, is_regular ? 0. : unsettled_work(before, now) * change);
        if (levels_.size() == 2) // one change of the extrapolated value alone
          return is_clean ? settled : unclean_factor * settled;
        const double settled_before = std::abs(before.settled);
        if (now.settled * before.settled < 0.) // the small change is at a turning point
          return std::max(settled, settled_before / turned);
        return std::max(settled, settled_before / fastest);
      }

      static double
      work_of(const SimulationResult &result)
      {
        return result.energy_balance ? result.energy_balance->stress_work : 0.;
      }

      /// Bound for an error of order 1 in the displacement, which shows in the work first: changes of order 2 hide it.
      /// Works of stiff bodies, which are small, are compared with the elastic energy, whose errors they share.
      double
      error_like_work(const Level &before, const Level &now) const
      {
        const Body &body     = scene_.body;
        const double largest = strain(now.result),
                     energy  = std::abs(now.work) + body.elastic_modulus * body.length * largest * largest / 2.;
        return finished(now.result) ? part_like_work * size_ * std::abs(now.work - before.work) / energy : 0.;
      }

      /// Change of the extrapolated work since the level before, relative to that of the work itself.
      double
      unsettled_work(const Level &before, const Level &now) const
      {
        const double change = std::abs(work_of(now.result) - work_of(before.result));
        return finished(now.result) && change > 0. ? std::abs(now.work - before.work) / change : 0.;
      }

      /// Checks an inversion: near it the last of the stretch may be fed by tiny flows, and the time converges slowly;
      /// the effect of the node rule on these flows is a part of the error.
      void
      check_inversion()
      {
        Numerics other             = numerics();
        other.other_rule           = true;
        const SimulationResult run = this->run(other);
        space_error_ =
          are_alike(run, latest_) ? std::max(space_error_, std::abs(*value(run) - *value(latest_))) : HUGE_VAL;
      }

      void
      extrapolate(const SimulationResult &coarse)
      {
        if (latest_.inversion)
        {
          extrapolated_.inversion->t = (4. * latest_.inversion->t - coarse.inversion->t) / 3.;
          extrapolated_.time.time =
            std::min((4. * latest_.time.time - coarse.time.time) / 3., extrapolated_.inversion->t);
          extrapolated_.displacement = (4. * latest_.displacement - coarse.displacement) / 3.;
        }
        else
        {
          const SimulationResult *const results[] = {&coarse, &latest_};
          const double weights[]                  = {-1. / 3., 4. / 3.};
          extrapolated_                           = combined(scene_, results, weights);
        }
      }

      /// True if the mesh is good enough with the largest error in time that is admissible; that on the coarsest mesh
      /// does not count here.
      bool
      is_good_in_space() const
      {
        return value(latest_) && std::max(space_error_, min_part * wanted()) + time_part * wanted() <= wanted();
      }

      Answer
      end()
      {
        answer_.choice.explanation += fmt::format("; {} runs with up to {} cells, tolerance {:.2g}",
                                                  n_runs_,
                                                  latest_.process.mesh.n_cells,
                                                  numerics().tolerance);
        answer_.choice.wanted_error = wanted();
        answer_.result              = latest_;
        SimulationResult &result    = answer_.result;
        if (is_final(latest_))
          return answer_;
        if (finished(latest_))
        {
          result              = extrapolated_;
          const double cycles = result.cycles ? result.cycles->bound : 0.;
          const double floor  = min_part * wanted();
          result.error        = {.total = std::max(space_error_, floor) + time_error_ + cycles,
                                 .space = std::max(space_error_, floor),
                                 .time  = time_error_ + cycles,
                                 .model = 0.};
          std::vector<const SimulationResult *> meshes;
          for (const Level &level : levels_)
            meshes.push_back(&level.result);
          result.errors = errors_of_extrapolation(extrapolated_, meshes, min_part * parameters_.accuracy);
          for (std::size_t i = 0; i < result.errors.size(); ++i)
            result.errors[i] += time_errors_.empty() ? std::numeric_limits<double>::quiet_NaN() : time_errors_[i];
          add_errors_of_cycles(result, size_);
          if (!std::isfinite(space_error_))
            result.error = DisplacementError();
          extend_errors(scene_, result);
          fails_accuracy(result, wanted() * (1. + 1e-9), "the meshes do not agree");
        }
        else if (latest_.inversion)
        {
          result = extrapolated_;
          if (std::isfinite(space_error_)) // Accuracy, relative to the duration, does not bind an early one
            result.inversion->error =
              std::max(space_error_, min_part * std::min(wanted(), believed * latest_.inversion->t)) + time_error_;
          end_before_inversion(result);
          if (!(result.inversion->error.value_or(HUGE_VAL) <= believed * latest_.inversion->t))
          {
            result.time.status  = Status::failed;
            result.time.reason  = "under_resolved";
            result.time.message = fmt::format("the stretch was lost at s = {:.6g}, t = {:.6g} with {} cells, but the "
                                              "meshes do not agree on it: more cells or a smaller tolerance are needed",
                                              latest_.inversion->s,
                                              latest_.inversion->t,
                                              latest_.process.mesh.n_cells);
            result.inversion.reset();
          }
        }
        return answer_;
      }

      const Problem &problem_;
      const std::function<bool()> &is_for_other_form_;
      const RunParameters &parameters_;
      const Scene &scene_;
      RecordOptions options_;
      Answer answer_;
      SimulationResult latest_, extrapolated_;
      std::vector<Level> levels_;       ///< levels that agree
      std::vector<double> time_errors_; ///< empty if they are not known
      double size_ = 0., time_error_ = 0., space_error_ = HUGE_VAL;
      unsigned int n_runs_ = 0, n_corrections_ = 0;
    };
  } // namespace

  Answer
  answer_of_family(const Problem &problem,
                   const NumericsChoice &choice,
                   const RecordOptions &options,
                   const std::function<bool()> &is_for_other_form)
  {
    Answer answer = Family(problem, choice, options, is_for_other_form).compute();
    if (!options.energy_balance) // not requested
    {
      answer.result.energy_balance.reset();
      if (answer.result.gait)
        answer.result.gait->energy_balance.reset();
    }
    return answer;
  }
} // namespace crawler
