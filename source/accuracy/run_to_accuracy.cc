// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/choose_numerics.h>
#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/mesh_choices.h>
#include <crawler/accuracy/mesh_family.h>
#include <crawler/accuracy/moving_fronts.h>
#include <crawler/accuracy/pilots.h>
#include <crawler/accuracy/run_to_accuracy.h>
#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/run/self_check.h>
#include <crawler/time/failure.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    /// Number of next tries, also while the error falls and is within near_factor; factors on the cells, and on the
    /// time tolerance.
    constexpr unsigned int max_refinements = 3, max_refinements_if_near = 6;
    constexpr double near_factor = 4., refined_cells = 1.2, refined_cells_if_rough = 1.5, max_refined_cells = 4.,
                     refined_tolerance = 0.1;

    /**
     * Confirms an inversion where the user chose the numerics, since a coarse mesh or long steps can fake a stretch
     * that is lost inside: finer runs must lose it, too, at nearly the same time.
     */
    void
    confirm_inversion(const Problem &problem, const NumericsChoice &choice, SimulationResult &result)
    {
      constexpr unsigned int max_runs = 4;
      constexpr double same           = 0.02; // relative
      const TimeParameters time       = time_of_finer_run(problem.parameters.time);
      NumericsChoice finer            = choice;
      const Extreme lost              = *result.inversion;
      std::string found;
      for (unsigned int i = 0; i < max_runs; ++i)
      {
        finer.numerics = numerics_of_finer_run(finer, time, problem.scene, result);
        const SimulationResult check =
          Simulation(problem.ranks, problem.scene, time, finer.numerics).run({}, {}, {}, problem.keep_going);
        if (check.time.status == Status::stopped)
          return;
        const double before = result.inversion->t;
        if (check.time.status != Status::inverted)
        {
          found = check.time.status == Status::finished ? "did not lose it" : "ended with " + check.time.reason;
          break;
        }
        if (std::abs(check.inversion->t - before) <= same * before)
        {
          if (i == 0)
            return;
          found = fmt::format("lost it only at t = {:.6g}", check.inversion->t);
          break;
        }
        result.inversion->t = check.inversion->t;
        found               = fmt::format("lost it at t = {:.6g}", check.inversion->t);
      }
      result.time.status = Status::failed;
      result.time.reason = "under_resolved";
      result.time.message =
        fmt::format("the computed stretch was lost at s = {:.6g}, t = {:.6g}, but a run with {} cells "
                    "and a smaller tolerance {}: a larger Discretization/Number of cells and a "
                    "smaller Time/Tolerance are needed",
                    lost.s,
                    lost.t,
                    finer.numerics.n_cells,
                    found);
      result.inversion.reset();
    }

    /// True if a run with finer numerics may end where this one did not.
    bool
    is_for_finer_numerics(const TimeOutcome &outcome)
    {
      constexpr const char *reasons[] = {
        "newton_diverged", "linear_failed", "rejection_limit", "step_underflow", "under_resolved"};
      return outcome.status == Status::failed && std::ranges::find(reasons, outcome.reason) != std::end(reasons);
    }

    /// Answer on one rank, without files.
    Answer
    answer_with(const NumericsChoice &choice, const Problem &problem, const RecordOptions &options)
    {
      const Problem alone{problem.parameters, problem.scene, problem.keep_going};
      RecordOptions own   = options;
      own.cycles          = cycle_wish(alone.parameters, alone.scene, /*has_pictures=*/false);
      const auto simulate = [&](const NumericsChoice &next) {
        return Simulation(MPI_COMM_SELF, alone.scene, alone.parameters.time, next.numerics)
          .run({}, own, {}, alone.keep_going);
      };
      return run_to_accuracy(alone, choice, simulate, own, /*writes=*/false);
    }

    /// The form that the rule did not choose, for scenes where the other one has no answer that is as accurate as
    /// wanted.
    class OtherForm
    {
    public:
      OtherForm(const OtherForm &) = delete; // its problem refers to its parameters
      OtherForm(const FormulationEntry form, const Problem &problem)
        : parameters_(problem.parameters)
        , problem_{parameters_, problem.scene, problem.keep_going}
      {
        parameters_.discretization.formulation = form;
      }

      /// True if there is a mesh of this form: not an adaptive one, nor very many cells, to which kinks of a rough
      /// stress would lead, for hours.
      bool
      has_mesh()
      {
        if (!choice_)
          choice_ = choose_numerics(problem_);
        return choice_ && choice_->numerics.mesh.tolerance == 0. &&
               !(choice_->is_rough && choice_->numerics.formulation == Formulation::position &&
                 choice_->numerics.n_cells > mesh_choice::max_uniform_cells);
      }

      /// Answer, if there is a mesh.
      std::optional<Answer>
      answer(const RecordOptions &options)
      {
        return has_mesh() ? std::optional(answer_with(*choice_, problem_, options)) : std::nullopt;
      }

    private:
      RunParameters parameters_;
      const Problem problem_;
      std::optional<NumericsChoice> choice_;
    };

    /// Answer with the files of one more run. Its output times change its steps a little; the numbers are those to
    /// which the bounds belong. Where the body inverts they are those of the last state in the files.
    Answer
    with_files(Answer answer, const std::function<SimulationResult(const NumericsChoice &)> &simulate)
    {
      if (answer.result.time.status == Status::stopped && answer.result.time.reason != "step_limit")
        return answer;
      SimulationResult files = simulate(answer.choice);
      if (files.time.status == Status::stopped)
        answer.result = files;
      else if (files.inversion && answer.result.inversion)
      {
        files.inversion = answer.result.inversion;
        end_before_inversion(files);
        answer.result = files;
      }
      answer.result.process.seconds.output = files.process.seconds.output;
      return answer;
    }
  } // namespace

  Answer
  answer_in_memory(const Problem &problem, const RecordOptions &options)
  {
    if (const auto choice = choose_numerics({problem.parameters, problem.scene, problem.keep_going}))
      return answer_with(*choice, problem, options);
    Answer answer;
    answer.result.time.status = Status::stopped;
    return answer;
  }

  namespace
  {
    /// Tries: successive runs with finer numerics, until one is as accurate as required.
    class Tries
    {
    public:
      Tries(const Problem &problem,
            const NumericsChoice &choice,
            const std::function<SimulationResult(const NumericsChoice &)> &simulate,
            const bool sweeps)
        : problem_(problem)
        , first_(choice)
        , simulate_(simulate)
        , sweeps_(sweeps)
      {
        answer_.choice = choice;
      }

      Answer
      answer()
      {
        result_ = simulate_(first_);
        do
        {
          if (result_.time.status == Status::finished)
            answer_.choice.set_size(result_.displacement, problem_.parameters.accuracy);
          if (result_.time.status == Status::inverted && result_.time.reason == "inverted_inside" && first_.is_users)
            confirm_inversion(problem_, first_, result_);
        } while (tries_again());
        result_.process.refinements   = refinements_;
        result_.process.seconds.error = estimate_seconds_;
        return std::move(answer_);
      }

    private:
      bool
      tries_again()
      {
        if (is_for_finer_numerics(result_.time))
        {
          if (!first_.follows_rule() || !has_tries())
            return false;
          make_finer(refined_cells, refined_tolerance);
          return true;
        }
        if (!problem_.parameters.error_estimate || result_.time.status != Status::finished)
          return false;
        const Stopwatch watch;
        estimate_errors(problem_, answer_.choice, result_);
        if (sweeps_ && is_good())
          sweep_error(problem_, answer_.choice, result_);
        estimate_seconds_ += watch.seconds();
        // Where the energy balance does not close a finer run is tried, too; the self-check judges the last one.
        const bool closes = !result_.energy_balance || result_.energy_balance->residual() <=
                                                         energy_balance_tolerance(result_, problem_.parameters);
        if (is_good() && (closes || std::isnan(wanted())))
          return false;
        std::string problem;
        if (has_tries() && first_.min_error <= wanted())
          try
          {
            // Smooth solutions need few more cells; where these do not help errors fall by a power of the cell size.
            const double total = result_.error->total, least = first_.is_rough ? refined_cells_if_rough : refined_cells;
            const double cells = refinements_ == 0 || !(total > wanted())
                                   ? least
                                   : std::clamp(std::cbrt(total / wanted()), least, max_refined_cells);
            // The error of a rough stress is that of its kinks in the cells, unless more cells hardly reduce it.
            constexpr double hardly = 0.95;
            const bool is_of_cells  = first_.is_rough && first_.numerics.mesh.tolerance == 0. && total > wanted() &&
                                     total < hardly * error_before_;
            error_before_ = total;
            make_finer(cells, is_of_cells ? 1. : refined_tolerance);
            return true;
          }
          catch (...) // the earlier answer stays
          {
            problem = "; the next try failed: " + failure_of(std::current_exception()).message;
            if (size_of(problem_.ranks) > 1) // the other ranks may be waiting
              throw;
          }
        if (is_good())
          return false;
        fails_accuracy(result_, wanted(), "a finer run did not finish");
        result_.time.message += problem;
        if (!answer_.choice.advice.empty())
          result_.time.message += "; " + answer_.choice.advice;
        return false;
      }

      /// True if one more try is admitted: a few always are, and more while the error falls and the wanted one is near.
      bool
      has_tries() const
      {
        if (first_.measured_error) // its tries were successive meshes
          return false;
        const double total = result_.error ? result_.error->total : std::numeric_limits<double>::quiet_NaN();
        const bool is_near = total <= near_factor * wanted() && total < error_before_;
        return refinements_ < (is_near ? max_refinements_if_near : max_refinements);
      }

      void
      make_finer(const double cells, const double tolerance)
      {
        const NumericsChoice next = refined(answer_.choice, problem_.scene, cells, tolerance);
        result_                   = simulate_(next);
        answer_.choice            = next;
        ++refinements_;
      }

      double
      wanted() const
      {
        return answer_.choice.wanted_error;
      }

      bool
      is_good() const
      {
        const double total = result_.error->total;
        const bool stopped = std::isnan(total) && !problem_.keep_going();
        return std::isnan(wanted()) || total <= wanted() || stopped;
      }

      const Problem &problem_;
      const NumericsChoice &first_;
      const std::function<SimulationResult(const NumericsChoice &)> &simulate_;
      const bool sweeps_; ///< true if the adjoint judges tries that are good by a finer run
      Answer answer_;
      SimulationResult &result_ = answer_.result;
      unsigned int refinements_ = 0;
      double estimate_seconds_  = 0.;
      double error_before_      = std::numeric_limits<double>::infinity(); ///< of the try before
    };

    /// Answer of the family, or of the position form if that alone meets Accuracy, or comes nearer to it: meshes of the
    /// stretch form have few digits.
    Answer
    better_of_both_forms(const Problem &problem, const NumericsChoice &choice, const RecordOptions &options)
    {
      const bool is_automatic = problem.parameters.discretization.formulation == FormulationEntry::automatic;
      OtherForm position(FormulationEntry::position, problem);
      Answer answer = answer_of_family(problem, choice, options, [&]() {
        try
        {
          return is_automatic && position.has_mesh();
        }
        catch (const std::exception &) // said below, if it matters
        {
          return false;
        }
      });
      if (answer.result.time.reason != accuracy_not_met || !is_automatic)
        return answer;
      try
      {
        auto other = position.answer(options);
        if (other && other->result.error && std::isfinite(other->result.error->total) &&
            (other->result.time.status == Status::finished || !answer.result.error ||
             other->result.error->total < answer.result.error->total))
          return std::move(*other);
      }
      catch (...) // the earlier answer stays
      {
        answer.result.time.message +=
          "; the position form also failed: " + failure_of(std::current_exception()).message;
      }
      return answer;
    }
  } // namespace

  Answer
  run_to_accuracy(const Problem &problem,
                  const NumericsChoice &choice,
                  const std::function<SimulationResult(const NumericsChoice &)> &simulate,
                  const RecordOptions &options,
                  const bool writes)
  {
    const auto in_files = [&](Answer answer) {
      if (!writes)
        return answer;
      answer              = with_files(std::move(answer), simulate);
      const double wanted = answer.choice.wanted_error;
      // The position form alone has an adjoint.
      if (sweep_error(problem, answer.choice, answer.result) && std::isfinite(wanted))
        fails_accuracy(answer.result, wanted, "");
      return answer;
    };
    if (choice.has_fronts)
      return in_files(
        answer_of_fronts(problem, [&](const Problem &other) { return answer_in_memory(other, options); }));
    if (choice.is_family)
      return in_files(better_of_both_forms(problem, choice, options));
    Answer answer = Tries(problem, choice, simulate, /*sweeps=*/writes).answer();
    // The position form may fail shortly before an end inverts, since the stretch nearby is tiny.
    if (is_for_finer_numerics(answer.result.time) && !choice.is_users && size_of(problem.ranks) == 1 &&
        may_be_stretch_form(problem))
      if (auto other = OtherForm(FormulationEntry::stretch, problem).answer(options);
          other && other->result.time.status != Status::failed)
        return in_files(std::move(*other));
    return answer;
  }
} // namespace crawler
