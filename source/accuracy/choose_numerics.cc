// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/choose_numerics.h>
#include <crawler/accuracy/mesh_choices.h>
#include <crawler/base/clock.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/time/integrators.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace crawler
{
  namespace
  {
    using namespace mesh_choice;

    constexpr unsigned int automatic_degree = 6;
    /// Factor on the number of steps times the tolerance: a bound of the error of the displacement in time.
    constexpr double time_factor = 0.25;
    /// Factors on that tolerance for radau 5 and 9 on uniform meshes of the position form, whose steps end better.
    constexpr double radau_5_superconvergence = 50., radau_9_superconvergence = 2000.;
    /// Part of them where the body may have a rhythm of its own, whose errors of the phase add up.
    constexpr double part_of_rhythm = 0.1;
    /// Smallest tolerances relative to the motion; below the second, kinks in the friction of stiff bodies stop a run.
    constexpr double min_tolerance = 1e-15, min_tolerance_if_kinks = 1e-10;
    /// Wanted error, relative to the largest deformation, below which runs on uniform meshes are by radau 9, others by
    /// radau 5.
    constexpr double radau_9_accuracy = 1.1e-4;
    /// Numbers of breaks beyond which graded meshes become too large, or too many starts have nothing sudden.
    constexpr std::size_t max_graded_places = 200, max_gentle_breaks = 200;
    /// Largest tolerance with pictures, relative to the wanted error, since the displacement within a step of radau 5
    /// or 9 has an error of up to half the tolerance; and its floor, as a part of the length.
    constexpr double tolerance_of_pictures = 2., min_tolerance_of_pictures = 1e-13;
    /// Runs long_run times as long as their first strides that do not end when cycles repeat, or whose pilots do not,
    /// have their numerics chosen by those strides. Strides are slow to repeat below this stiffness, in natural units
    /// of a stride.
    constexpr double first_strides = 3., long_run = 4., min_settling_stiffness = 0.02;
    /// Lengths of the active stress on the body, and Accuracy, beyond which many cells of the position form are cheaper
    /// than the stretch form.
    constexpr double max_lengths = 30., min_steep_accuracy = 1e-7;
    /// Relative error that very soft bodies may have on adaptive meshes, whatever Accuracy is.
    constexpr double soft_error = 3e-3;

    /// Chooser of the numerics: of the kind of mesh (mesh_choices.h), then of the time steps.
    class Chooser
    {
    public:
      explicit Chooser(const Problem &problem)
        : pilots_(problem)
        , own_(problem.parameters.discretization)
        , time_(problem.parameters.time)
        , accuracy_(problem.parameters.accuracy)
        , has_own_steps_(time_.tolerance || time_.step_control == StepControl::fixed)
      {
        Numerics &n      = choice_.numerics;
        n.degree         = own_.degree.value_or(automatic_degree);
        n.initial_step   = time_.initial_step.value_or(multistep_start * problem.scene.end_time);
        n.step_limits    = pilots_.scales.step_limits;
        n.min_event      = pilots_.scales.jumps_move ? 0. : min_event * pilots_.scales.stress;
        choice_.is_rough = !pilots_.scales.is_smooth;
      }

      NumericsChoice
      choose(const bool must_settle = false)
      {
        pilots_.must_settle = must_settle;
        const Scene &scene  = pilots_.scene;
        choice_.is_users    = own_.n_cells || has_own_steps_ || own_.mesh_tolerance;
        if (own_.formulation != FormulationEntry::stretch && own_.n_cells && has_own_steps_ &&
            own_.mesh != MeshKind::adaptive)
        {
          choice_.numerics.n_cells   = *own_.n_cells;
          choice_.numerics.tolerance = time_.tolerance.value_or(1e-10 * scene.body.length); // of Newton's method only
          choice_.explanation        = "cells and time steps as set by the user";
          return choice_;
        }
        const bool may_be_fronts = own_.mesh == MeshKind::automatic && pilots_.scales.jumps_move &&
                                   own_.formulation != FormulationEntry::stretch && !own_.n_cells && !has_own_steps_;
        if (may_be_fronts && with_fronts(scene, 1.))
          choose_fronts();
        else if (may_be_fronts)
        {
          choose_mesh_for_moving_jumps(pilots_, choice_);
          choose_steps();
        }
        else if (choose_mesh())
          choose_steps();
        else
          choose_stretch_form(pilots_, choice_);
        return choice_;
      }

    private:
      /// Chooses a mesh of the position form; returns false if the stretch form is better.
      bool
      choose_mesh()
      {
        const Scene &scene      = pilots_.scene;
        const bool is_automatic = own_.mesh == MeshKind::automatic;
        if (own_.formulation == FormulationEntry::stretch)
          return false;
        if (is_automatic && starts_or_jumps())
          if (const auto ratio = choose_graded_mesh(pilots_, choice_))
          {
            space_over_time_ = *ratio;
            return true;
          }
        const bool may_be_stretch = may_be_stretch_form(pilots_);
        if (may_be_stretch && pilots_.is_soft())
          return false;
        // Solutions unresolved by few cells are steep, not fine, if the active stress is smooth: fronts of friction.
        const bool may_be_steep = may_be_stretch && scene.friction_exponent() < 0. &&
                                  scene.body.length / pilots_.scales.length < max_lengths &&
                                  accuracy_ >= min_steep_accuracy;
        bool enough = false;
        if (own_.mesh != MeshKind::adaptive)
        {
          const bool only_uniform = own_.mesh == MeshKind::uniform || own_.n_cells || scene.keeps_its_centre();
          const auto ratio =
            choose_uniform_mesh(pilots_, choice_, only_uniform ? max_cells : max_uniform_cells, may_be_steep);
          enough           = ratio.has_value();
          space_over_time_ = ratio.value_or(1.);
        }
        if (!enough && may_be_steep && pilots_.last.time.reason != "inverted_at_end")
          return false;
        if (own_.mesh == MeshKind::adaptive || (is_automatic && !enough && !pilots_.is_for_stretch() && !own_.n_cells))
          choose_adaptive_mesh(pilots_, choice_);
        return !pilots_.is_for_stretch();
      }

      /// True if the active stress makes layers suddenly, and a graded mesh may be chosen for that.
      bool
      starts_or_jumps() const
      {
        const StressScales &scales = pilots_.scales;
        const double sudden        = sudden_part * std::sqrt(accuracy_);
        return scales.sudden > sudden && scales.in_space <= max_graded_places &&
               (scales.sudden_later > sudden || scales.in_time <= max_gentle_breaks) && !own_.n_cells &&
               time_.step_control == StepControl::adaptive && !own_.mesh_tolerance;
      }

      /// Chooses fronts for moving jumps that are known to be waves, each with numerics of its own (moving_fronts.h).
      /// The numerics set here are those of a first run.
      void
      choose_fronts()
      {
        Numerics &n         = choice_.numerics;
        n.degree            = own_.degree.value_or(moving_degree);
        n.n_cells           = first_moving_cells;
        n.integrator        = "radau 5";
        n.tolerance         = moving_tolerance * pilots_.scale / n.n_cells;
        n.jumps_move        = true;
        choice_.has_fronts  = true;
        choice_.explanation = fmt::format("for Accuracy {:g}: jumps that move, by ever steeper fronts", accuracy_);
      }

      /// Order of the error estimate of the run, on which the growth of its number of steps depends.
      unsigned int
      estimated_order() const
      {
        const Integrator &method = integrator(integrator_of(time_, choice_.numerics));
        return method.petsc_type == "radau" ? method.n_stages : time_.order;
      }

      /// True where the friction switches its direction, so that kinks pass through the steps.
      bool
      kinks_move() const
      {
        return pilots_.scene.ground.direction.is_uneven();
      }

      /// Factor by which the tolerance may exceed that of the rule.
      double
      superconvergence() const
      {
        const std::string &name = integrator_of(time_, choice_.numerics);
        if (choice_.numerics.mesh.tolerance > 0. || pilots_.last.stretch.min.value < emptied || kinks_move())
          return 1.;
        const double usual = name == "radau 9"   ? radau_9_superconvergence
                             : name == "radau 5" ? radau_5_superconvergence
                                                 : 1.;
        return pilots_.scene.feels_elsewhere() ? std::max(part_of_rhythm * usual, 1.) : usual;
      }

      /// Time tolerance for the wanted error: the number of steps grows as tolerance^(-1/(order+1)), and error =
      /// time_factor * steps * tolerance = accuracy * size.
      double
      tolerance_by_rule() const
      {
        const double r = 1. / (1. + estimated_order()), tolerance = pilots_.tolerance;
        const double wanted =
          accuracy_ * pilots_.size / (time_factor * pilots_.steps_to_the_end() * std::pow(tolerance, r));
        return std::max(superconvergence() * std::min(std::pow(wanted, 1. / (1. - r)), tolerance),
                        std::max({(kinks_move() ? min_tolerance_if_kinks : min_tolerance) * pilots_.scale,
                                  pilots_.negligible_displacement(),
                                  pilots_.inverts_at_end ? 0.1 * accuracy_ * tolerance : 0.})); // the size is unknown
      }

      /// Chooses the steps on the mesh, unless they came with it.
      void
      choose_steps()
      {
        Numerics &n         = choice_.numerics;
        const bool predicts = pilots_.finished();
        if (pilots_.size == 0.)
          pilots_.size = pilots_.scale;
        if (!n.jumps_move && n.grading.levels == 0)
        {
          if (n.integrator == "radau 5" && n.mesh.tolerance == 0. &&
              accuracy_ * pilots_.size < radau_9_accuracy * std::max(pilots_.last.size.largest_u, pilots_.size))
            n.integrator = "radau 9";
          n.tolerance = time_.tolerance.value_or(tolerance_by_rule());
        }
        if (!time_.initial_step && n.grading.levels == 0)
          n.initial_step = pilots_.first_step(n);
        if (predicts && !n.jumps_move && !own_.n_cells && !has_own_steps_ && !own_.mesh_tolerance)
        {
          choice_.space_share  = space_over_time_ / (1. + space_over_time_);
          choice_.wanted_error = accuracy_ * pilots_.size;
          if (n.mesh.tolerance > 0. && stiffness(pilots_.scene) < very_soft)
            choice_.min_error = soft_error * pilots_.size;
        }
        if (n.jumps_move && predicts)
          choice_.wanted_error = accuracy_ * pilots_.size;
        if (std::isfinite(choice_.wanted_error))
          choice_.min_size = std::max(displacement_floor * pilots_.last.size.largest_u, pilots_.min_size());
        explain();
      }

      void
      explain()
      {
        const Numerics &n     = choice_.numerics;
        const bool is_at_rest = pilots_.scene.keeps_its_centre();
        const std::string kind =
          n.jumps_move            ? "jumps of the active stress that move, "
          : n.grading.levels > 0  ? fmt::format("sudden stress, {} of cells smaller by {:g} each, ",
                                               counted(n.grading.levels, "level"),
                                               n.grading.ratio)
          : n.mesh.tolerance > 0. ? fmt::format("adaptive mesh, tolerance {:.2g}, ", n.mesh.tolerance)
                                  : "";
        choice_.explanation      = pilots_.finished()
                                     ? fmt::format("for Accuracy {:g}: {}from {} in {:.2g} s: {} about {:.3g}",
                                              accuracy_,
                                              kind,
                                              counted(pilots_.n, "pilot run"),
                                              watch_.seconds(),
                                              is_at_rest ? "deformation" : "displacement",
                                              is_at_rest ? pilots_.size : pilots_.last.displacement)
                                     : fmt::format("for Accuracy {:g}: {}the last of {}, with {} cells, ended early: {}",
                                              accuracy_,
                                              kind,
                                              counted(pilots_.n, "pilot run"),
                                              n.n_cells,
                                              pilots_.last.time.message);
        const double least_error = choice_.measured_error.value_or(choice_.min_error);
        if (least_error > 1.5 * choice_.wanted_error)
          choice_.explanation += fmt::format("; Accuracy cannot be met, the error is about {:.2g} of the displacement",
                                             least_error / pilots_.size);
        if (!pilots_.scales.sees_all)
          choice_.explanation +=
            "; an event of the active stress that is shorter than a step of its sampling may be missed";
        if (n.jumps_move && !choice_.advice.empty())
          choice_.explanation += "; " + choice_.advice;
      }

      const Stopwatch watch_;
      Pilots pilots_;
      const DiscretizationParameters &own_;
      const TimeParameters &time_;
      const double accuracy_;
      const bool has_own_steps_;
      NumericsChoice choice_;
      double space_over_time_ = 1.; ///< ratio of the errors predicted by the rule
    };

    /// End of the first strides of a run, if it has many more: numerics good for these are good for all.
    std::optional<double>
    end_of_first_strides(const RunParameters &parameters, const Scene &scene)
    {
      const auto gait = scene.active_stress->repetition();
      if (!gait || parameters.time.step_control != StepControl::adaptive || parameters.discretization.n_cells ||
          parameters.time.tolerance)
        return std::nullopt;
      const double end = gait->from + first_strides * gait->period;
      return scene.end_time > long_run * end ? std::optional(end) : std::nullopt;
    }

    /// True if strides should soon repeat, so that they need not all be computed.
    bool
    may_settle(const RunParameters &parameters, const Scene &scene)
    {
      const double period = scene.active_stress->repetition()->period;
      return cycle_wish(parameters, scene, /*has_pictures=*/false) &&
             stiffness(scene) * period / scene.end_time > min_settling_stiffness;
    }
  } // namespace

  std::optional<NumericsChoice>
  choose_numerics(const Problem &problem)
  {
    const Scene &scene = problem.scene;
    try
    {
      if (const auto end = end_of_first_strides(problem.parameters, scene))
      {
        if (may_settle(problem.parameters, scene))
          try
          {
            return Chooser(problem).choose(/*must_settle=*/true);
          }
          catch (const PilotsUnsettled &) // coarse steps keep cycles from repeating
          {
          }
        Scene beginning       = scene;
        beginning.end_time    = *end;
        NumericsChoice choice = Chooser({problem.parameters, beginning, problem.keep_going, problem.ranks}).choose();
        if (std::isfinite(choice.wanted_error) || choice.is_of_several_runs())
        {
          choice.numerics.step_limits = stress_scales(scene).step_limits;
          choice.min_error *= scene.end_time / *end;
          choice.explanation += fmt::format("; the first {:g} of {:.4g} strides chose",
                                            first_strides,
                                            scene.end_time / scene.active_stress->repetition()->period);
          return choice;
        }
      }
      return Chooser(problem).choose();
    }
    catch (const PilotsInterrupted &)
    {
      return std::nullopt;
    }
  }

  void
  prepare_for_pictures(NumericsChoice &choice, const RunParameters &parameters)
  {
    const double largest = tolerance_of_pictures * choice.wanted_error;
    if (parameters.time.tolerance || choice.is_of_several_runs() || !choice.numerics.integrator.starts_with("radau") ||
        !(largest < choice.numerics.tolerance))
      return;
    choice.numerics.tolerance = std::max(largest, min_tolerance_of_pictures * parameters.body.length);
    choice.explanation += fmt::format("; tolerance {:.2g} for pictures", choice.numerics.tolerance);
  }
} // namespace crawler
