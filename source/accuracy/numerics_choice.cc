// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/form_choice.h>
#include <crawler/accuracy/graded_choice.h>
#include <crawler/accuracy/numerics_choice.h>
#include <crawler/accuracy/stress_scales.h>
#include <crawler/base/clock.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/run/accuracy_rule.h>
#include <crawler/scene/moving_jumps.h>
#include <crawler/time/integrators.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace crawler
{
  namespace
  {
    using namespace accuracy_rule::choice;
    using accuracy_rule::displacement_floor;

    /// Exception for a stop that was requested during the pilots.
    struct Interrupted
    {
    };

    /// Chooser of the numerics; each function below makes one decision.
    class Chooser
    {
    public:
      Chooser(MPI_Comm communicator, const RunParameters &parameters, const Scene &scene, const KeepGoing &keep_going)
        : communicator_(communicator)
        , keep_going_(keep_going)
        , parameters_(parameters)
        , scene_(scene)
        , scales_(stress_scales(scene))
        , user_cells_(parameters.discretization.n_cells)
        , user_tolerance_(parameters.time.tolerance)
        , T_(scene.end_time)
        , L_(scene.body.length)
        , accuracy_(parameters.accuracy)
        , scale_(scales_.displacement > 0. ? std::max(scales_.displacement, min_size()) : L_)
        , adaptive_steps_(parameters.time.step_control == StepControl::adaptive)
      {
        Numerics &n              = choice_.numerics;
        n.degree                 = parameters.discretization.degree.value_or(automatic_degree);
        n.initial_step           = parameters.time.initial_step.value_or(multistep_start * T_);
        n.step_limits            = scales_.step_limits;
        choice_.is_rough         = !scales_.is_smooth;
        n.min_event              = scales_.jumps_move ? 0. : min_event * scales_.stress;
        pilot_time_              = parameters.time;
        pilot_time_.step_control = StepControl::adaptive;
        pilot_time_.petsc_prefix = "pilot_"; // options after "--" are for the real run
        pilot_time_.max_steps    = std::min(pilot_time_.max_steps, max_pilot_steps);
        tolerance_               = std::max(1e-3 * scale_, negligible_displacement());
        cycles_                  = cycle_wish(parameters, scene, /*has_pictures=*/false);
        if (cycles_)
          cycles_->accuracy = std::max(accuracy_, pilot_accuracy);
      }

      NumericsChoice
      choose()
      {
        const MeshKind mesh = parameters_.discretization.mesh;
        const bool fixed    = parameters_.time.step_control == StepControl::fixed;
        if (parameters_.discretization.formulation == FormulationEntry::stretch)
        {
          stretch_form();
          return choice_;
        }
        choice_.is_users = user_cells_ || user_tolerance_ || fixed || parameters_.discretization.mesh_tolerance;
        if (user_cells_ && (user_tolerance_ || fixed) && mesh != MeshKind::adaptive)
        {
          choice_.numerics.n_cells   = *user_cells_;
          choice_.numerics.tolerance = user_tolerance_.value_or(1e-10 * L_); // tolerance of Newton's method only
          choice_.explanation        = "cells and time steps as set by the user";
          return choice_;
        }
        if (mesh == MeshKind::automatic && scales_.jumps_move && adaptive_steps_ && !user_cells_ && !user_tolerance_)
        {
          if (with_fronts(scene_, 1.))
          {
            fronts();
            return choice_;
          }
          moving_jumps();
          finish(fixed);
          return choice_;
        }
        if (mesh == MeshKind::automatic && starts_or_jumps() && graded())
        {
          finish(fixed);
          return choice_;
        }
        if (may_be_stretch() && is_soft(stiffness(), scene_.friction_exponent(), accuracy_))
        {
          stretch_form();
          return choice_;
        }
        // Solutions unresolved by few cells are steep, not fine, if the active stress is smooth: fronts of friction.
        const bool may_be_steep = may_be_stretch() && scene_.friction_exponent() < 0. &&
                                  is_cheaper_than_many_cells(L_ / scales_.length, accuracy_);
        bool enough = false;
        if (mesh != MeshKind::adaptive)
          enough = uniform(mesh == MeshKind::uniform || user_cells_ || scene_.keeps_its_centre() ? max_cells
                                                                                                 : max_uniform_cells,
                           may_be_steep);
        if (!enough && may_be_steep && pilot_.time.reason != "inverted_at_end")
        {
          stretch_form();
          return choice_;
        }
        if (mesh == MeshKind::adaptive || (mesh == MeshKind::automatic && !enough && !is_for_stretch() && !user_cells_))
          adaptive();
        if (is_for_stretch())
        {
          stretch_form();
          return choice_;
        }
        finish(fixed);
        return choice_;
      }

    private:
      /// Displacements below this count as zero: their squares underflow.
      double
      negligible_displacement() const
      {
        return 1e-25 * L_;
      }

      SimulationResult
      pilot(const Numerics &numerics, const ResolutionWish resolution)
      {
        Simulation simulation(communicator_, scene_, pilot_time_, numerics);
        ++n_pilots_;
        SimulationResult result =
          simulation.run({}, {.energy_balance = false, .resolution = resolution, .cycles = cycles_}, {}, keep_going_);
        if (result.time.status == Status::stopped && result.time.reason.empty())
          throw Interrupted();
        // Displacements that are 0 whatever the numerics are tell nothing about them; the deformation at the end does,
        // while the largest one depends on where steps end.
        if (scene_.keeps_its_centre())
          result.displacement = result.last_u;
        return result;
      }

      Numerics
      pilot_numerics(const unsigned int degree, const unsigned int n_cells, const double tolerance) const
      {
        Numerics numerics     = choice_.numerics;
        numerics.degree       = degree;
        numerics.n_cells      = n_cells;
        numerics.tolerance    = tolerance;
        numerics.initial_step = first_step();
        return numerics;
      }

      /// The user's integrator, or the chosen one; empty if that is not known yet.
      const std::string &
      integrator_name() const
      {
        const std::string &own = parameters_.time.integrator;
        return own == "automatic" ? choice_.numerics.integrator : own;
      }

      /// The automatic size of the first step.
      double
      first_step() const
      {
        return (integrator_name().starts_with("radau") ? one_step_start : multistep_start) * T_;
      }

      /// Number of steps of the last pilot to the end, whether it went there or its cycles were extrapolated.
      double
      steps_to_the_end() const
      {
        const double steps = std::max(pilot_.time.steps, 1u);
        return pilot_.cycles ? steps * (1. + 1. * pilot_.cycles->extrapolated / pilot_.cycles->computed) : steps;
      }

      /// Measures the size of the displacement, to which Accuracy is relative.
      void
      measure_size()
      {
        const bool finished = pilot_.time.status == Status::finished;
        const double part   = scene_.keeps_its_centre() ? 1. : displacement_floor;
        size_               = std::max(finished ? std::abs(pilot_.displacement) : 0., part * pilot_.largest_u);
        if (size_ > 0.)
          size_ = std::max(size_, min_size());
      }

      /// Stiffness k T/(gamma L^2).
      double
      stiffness() const
      {
        return scene_.body.elastic_modulus / natural_units(scene_).force;
      }

      /// Stiffness k T/(g L^2) for the largest friction g of the last pilot, which determines thin layers.
      double
      stiffness_over_friction() const
      {
        const double a       = scene_.friction_exponent();
        const double largest = std::max(std::pow(pilot_.min_stretch.value, a), std::pow(pilot_.max_stretch.value, a));
        return stiffness() / largest;
      }

      /// True if all layers are wide enough to show in the modes of the stretch on this mesh. Where nothing starts
      /// suddenly they are as wide as elasticity smooths against the largest friction of the last pilot while the
      /// active stress changes.
      bool
      sees_layers(const unsigned int degree, const unsigned int n_cells) const
      {
        if (!scene_.is_plain() || !scales_.is_smooth || scales_.sudden > sudden_part * std::sqrt(accuracy_))
          return false;
        double time = T_; // time in which the active stress changes
        for (const StepLimit &limit : scales_.step_limits)
          time = std::min(time, limit.longest);
        return std::sqrt(stiffness_over_friction() * time / T_) * degree * n_cells >= widest_hidden_layer;
      }

      /// True if the active stress makes layers suddenly, and a graded mesh may be chosen for that.
      bool
      starts_or_jumps() const
      {
        const double sudden = sudden_part * std::sqrt(accuracy_);
        return scales_.sudden > sudden && scales_.in_space <= max_graded_places &&
               (scales_.sudden_later > sudden || scales_.in_time <= max_gentle_breaks) && !user_cells_ &&
               adaptive_steps_ && !parameters_.discretization.mesh_tolerance;
      }

      /// Thickness, relative to the length, of the layer in which velocities after a sudden stress, which fall with
      /// time to the power -1/2, are above the one at which friction switches its direction. No refinement shows this
      /// layer to a mesh that is much coarser.
      double
      fast_layer() const
      {
        const auto &direction = scene_.ground.direction;
        return direction.is_uneven() ? scales_.sudden * scales_.stress /
                                         (scene_.body.friction_coefficient * direction.switching_velocity * L_)
                                     : 0.;
      }

      /// Chooses a mesh that is graded towards the ends and breaks in space; returns true if one is good enough.
      bool
      graded()
      {
        Numerics start = choice_.numerics;
        start.degree   = parameters_.discretization.degree.value_or(accuracy_ < accurate_graded ? accurate_graded_degree
                                                                                              : graded_degree);
        start.n_cells =
          static_cast<unsigned int>(std::clamp(std::ceil(0.25 * L_ / scales_.length), 1. * min_cells, 1. * max_cells));
        const std::string &own = parameters_.time.integrator;
        // Pieces between breaks have a cell at least.
        start.n_cells          = std::max(start.n_cells, static_cast<unsigned int>(scales_.in_space) + 1);
        start.integrator       = accuracy_ < radau_9_accuracy_if_graded ? "radau 9" : "radau 5";
        const std::string name = own == "automatic" ? start.integrator : own;
        start.tolerance        = user_tolerance_.value_or(0.);
        const auto cycles      = cycles_;
        if (cycles_)
          cycles_->accuracy = accuracy_; // the displacements are compared here
        const auto found =
          find_graded_mesh({.scene             = scene_,
                            .start             = start,
                            .accuracy          = accuracy_,
                            .scale             = scale_,
                            .choose_tolerance  = !user_tolerance_,
                            .choose_first_step = !parameters_.time.initial_step,
                            .tolerance_factor  = name == "radau 9"   ? graded_radau_9
                                                 : name == "radau 5" ? graded_radau_5
                                                                     : graded_others,
                            .layer             = fast_layer(),
                            .run = [this](const Numerics &numerics) { return pilot(numerics, ResolutionWish::size); },
                            .size =
                              [this](const SimulationResult &result) {
                                pilot_ = result;
                                measure_size();
                                return size_;
                              }});
        cycles_ = cycles;
        if (!found)
        {
          size_ = 0.;
          return false;
        }
        choice_.numerics  = found->numerics;
        pilot_            = found->result;
        space_over_time_  = found->space_over_time;
        choice_.min_error = found->rest;
        measure_size();
        return true;
      }

      /// Time at which an end has inverted in the last pilot.
      std::optional<double>
      end_inversion() const
      {
        return pilot_.time.reason == "inverted_at_end" ? std::optional(pilot_.inversion->t) : std::nullopt;
      }

      /// True if the ends invert at the same time in two pilots, which suffice since the end conditions determine this
      /// time on any mesh.
      bool
      ends_invert_then(const std::optional<double> &before)
      {
        constexpr double same  = 1e-6;
        const auto now         = end_inversion();
        return inverts_at_end_ = now && before && std::abs(*now - *before) <= same * *now;
      }

      /// Makes pilots on meshes from @p n_cells cells on, at most @p most, with smaller steps each time, until one
      /// shows the deformation.
      void
      pilots_on_uniform_mesh(const unsigned int degree, unsigned int &n_cells, const unsigned int most)
      {
        bool good = false;
        while (!good && n_pilots_ < 20)
        {
          const auto inversion_before = end_inversion();
          pilot_                      = pilot(pilot_numerics(degree, n_cells, tolerance_), ResolutionWish::all);
          measure_size();
          if (accuracy_ >= 1e-7 && is_for_stretch())
            return;
          const bool finished = pilot_.time.status == Status::finished;
          const bool resolves = user_cells_ || pilot_.unresolved <= std::max(resolved, accuracy_) || n_cells >= most;
          // Coarse meshes or steps can look like an inversion; if finer ones agree the real run will name it.
          if (ends_invert_then(inversion_before))
            good = true;
          else if (!finished && !user_cells_ && n_cells < std::min(most, 64u))
          {
            n_cells *= 2;
            tolerance_ *= 0.1;
          }
          else if (finished && !resolves)
            n_cells = std::min(most, 2 * n_cells);
          else if (finished && size_ > 0. && tolerance_ > 0.03 * size_)
            tolerance_ = std::max(0.01 * size_, 1e-3 * tolerance_);
          else
            good = true;
        }
      }

      /// Chooses a uniform mesh from pilots with up to @p most cells; returns true if there is one, and, if the
      /// solution @p may_be_steep, if few cells are enough.
      bool
      uniform(const unsigned int most, const bool may_be_steep)
      {
        Numerics &n = choice_.numerics;
        if (adaptive_steps_)
          n.integrator = "radau 5";
        // Linear elements have no mode of the stretch that could show the error: one degree more shows it.
        const unsigned int pilot_degree = std::max(choice_.numerics.degree, 2u);
        // Cells of this degree resolve a stress whose scale is a quarter of their size.
        const double seen    = std::clamp(std::ceil(0.25 * L_ / scales_.length), 1. * min_cells, 0.25 * max_cells);
        unsigned int n_cells = user_cells_.value_or(static_cast<unsigned int>(seen));
        if (n_cells > most && !user_cells_)
          return false;
        pilots_on_uniform_mesh(pilot_degree, n_cells, most);
        choice_.numerics.n_cells = n_cells;
        if ((accuracy_ >= 1e-7 && is_for_stretch()) || inverts_at_end_)
          return true;
        const bool predicts = pilot_.time.status == Status::finished;
        if (!predicts || pilot_.unresolved > std::max(resolved, accuracy_))
          return most == max_cells; // nothing else is left, whatever the reason
        if (most < max_cells && stiffness() < very_soft)
          return false; // a pilot may pass over these layers by luck
        return user_cells_ || extrapolate_cells(pilot_degree, n_cells, may_be_steep);
      }

      /**
       * Finds the number of cells from that of a pilot that resolves the deformation; false if the solution @p
       * may_be_steep and few cells are not enough. On smooth solutions `unresolved` falls as (cell size)^(2q-2), q the
       * pilot's degree, and the error of the displacement at least as fast. Thin layers look resolved before they are:
       * so the rate is measured, with smaller steps whose errors do not hide it, on meshes twice as fine each time
       * until it is at least half of that.
       */
      bool
      extrapolate_cells(const unsigned int pilot_degree, unsigned int n_cells, const bool may_be_steep)
      {
        const double enough_cells = n_cells; // fewer failed or left too much unresolved
        const double full_rate = 2. * pilot_degree - 2., wanted_part = accuracy_ / space_factor;
        const auto rate_of = [full_rate](const double coarse, const double fine) {
          return std::clamp(std::log2(coarse / fine), 0.5, full_rate);
        };
        double unresolved = pilot_.unresolved, indicator = pilot_.largest_indicator;
        double rate = sees_layers(pilot_degree, n_cells) ? full_rate : 0., indicator_rate = rate;
        const auto unbalanced = [&]() {
          return may_be_steep && indicator_factor * indicator > accuracy_ * pilot_.strain &&
                 indicator_rate < 0.5 * full_rate;
        };
        while ((rate < 0.5 * full_rate || unbalanced()) && 2 * n_cells <= max_cells / 4)
        {
          if (may_be_steep && 2 * n_cells > max_uniform_cells)
            return false;
          const SimulationResult finer =
            pilot(pilot_numerics(pilot_degree, 2 * n_cells, 0.01 * tolerance_), ResolutionWish::all);
          if (finer.time.status != Status::finished || finer.unresolved == 0.)
            break;
          rate           = rate_of(unresolved, finer.unresolved);
          indicator_rate = rate_of(indicator, finer.largest_indicator);
          unresolved     = finer.unresolved;
          indicator      = finer.largest_indicator;
          n_cells *= 2;
          if (unresolved <= 0.01 * wanted_part && !unbalanced())
            break;
        }
        double cells = rate > 0. ? n_cells * std::pow(unresolved / wanted_part, 1. / rate) : n_cells;
        // Layers thinner than the cells do not show in the stretch, but the balance of forces shows them; its rate,
        // too, must be that of a smooth solution.
        const double gain      = std::pow(std::max(1., cells / n_cells), full_rate);
        const double too_large = indicator_factor * indicator / (accuracy_ * gain * pilot_.strain);
        if (may_be_steep && too_large > 1.)
        {
          if (indicator_rate < 0.5 * full_rate || stiffness_over_friction() < very_soft)
            return false;
          cells = std::max(cells, 1. * n_cells) * std::pow(too_large, 1. / indicator_rate);
        }
        choice_.numerics.n_cells =
          static_cast<unsigned int>(std::clamp(std::ceil(cells), enough_cells, static_cast<double>(max_cells)));
        choice_.is_steep = !choice_.is_rough && rate > 0. && std::min(rate, indicator_rate) < 0.5 * full_rate;
        // Error in space predicted by the rule, relative to the wanted one.
        space_over_time_ = std::pow(cells / choice_.numerics.n_cells, rate > 0. ? rate : full_rate);
        return !may_be_steep || choice_.numerics.n_cells <= max_uniform_cells;
      }

      /// Chooses an adaptive mesh: pilots measure the strain, which scales its tolerance, and the number of steps.
      void
      adaptive()
      {
        Numerics &n  = choice_.numerics;
        n.integrator = "";
        n.degree     = parameters_.discretization.degree.value_or(adaptive_degree);
        n.n_cells    = user_cells_.value_or(
          static_cast<unsigned int>(std::clamp(std::ceil(L_ / scales_.length), 8., 1. * max_cells)));
        n.mesh        = {1., parameters_.discretization.smallest_cell.value_or(1e-6 * L_)};
        double strain = pilot_.strain > 0. ? pilot_.strain : scale_ * scale_ / L_;
        // Pilots that need more steps than this collapse, and the scheme that is safe then costs less.
        const TimeParameters usual = pilot_time_;
        pilot_time_.max_steps      = std::min(pilot_time_.max_steps, max_adaptive_pilot_steps);
        double tighter             = 1.;
        for (int i = 0; i < 4; ++i)
        {
          Numerics settings        = pilot_numerics(n.degree, n.n_cells, tolerance_);
          settings.mesh.tolerance  = tighter * resolved * strain;
          settings.mesh.most_cells = max_adaptive_pilot_cells;
          pilot_                   = pilot(settings, ResolutionWish::all);
          measure_size();
          const bool finished = pilot_.time.status == Status::finished;
          const double before = strain;
          if (finished && pilot_.strain > 0.)
            strain = pilot_.strain;
          const bool strain_known = strain < 4. * before && strain > 0.25 * before;
          if (!finished)
            tighter *= 0.01; // the mesh may have caused the loss of the stretch
          const bool coarse_steps = finished && size_ > 0. && tolerance_ > 0.03 * size_;
          if (coarse_steps || (!finished && i < 2))
            tolerance_ = finished ? std::max(0.01 * size_, 1e-3 * tolerance_) : 0.03 * tolerance_;
          else if (strain_known)
            break;
        }
        pilot_time_       = usual;
        const double part = parameters_.discretization.mesh_tolerance.value_or(
          std::min(accuracy_ / indicator_factor, tighter * resolved));
        n.mesh.tolerance = part * strain;
        // Method bdf restarts with each mesh, unlike one-step methods; but where the stretch collapses it is faster.
        if (adaptive_steps_ && pilot_.min_stretch.value > emptied)
          n.integrator = "radau 5";
      }

      bool
      may_be_stretch() const
      {
        return may_be_stretch_form(parameters_, scene_);
      }

      /// True if the last pilot came near an emptied state.
      bool
      is_for_stretch() const
      {
        // Stretch form has few digits; so for a smaller Accuracy only where the position form cannot go on.
        return may_be_stretch() && pilot_.time.reason != "inverted_at_end" &&
               (accuracy_ >= 1e-7 || pilot_.time.status != Status::finished) &&
               empties(pilot_.min_stretch.value, scene_.friction_exponent(), accuracy_);
      }

      /// Chooses the stretch form: the first of a family of meshes (mesh_family.h), or the user's settings.
      void
      stretch_form()
      {
        Numerics &n      = choice_.numerics;
        const double k   = scene_.body.elastic_modulus;
        const double m_s = scales_.stress / scales_.length;
        const double a   = std::max(1., std::abs(scene_.friction_exponent()));
        n.formulation    = Formulation::stretch;
        n.degree         = 1;
        n.mesh           = {};
        n.grading        = {};
        n.layer          = m_s > 0. ? std::min(largest_layer * L_, layer_lengths / a * k / m_s) : largest_layer * L_;
        if (parameters_.discretization.mesh == MeshKind::uniform)
          n.layer = 0.;
        n.parts        = 1;
        n.integrator   = "radau 5";
        choice_.strain = std::min(scale_ / std::min(L_, scales_.length), 0.3);
        const double first =
          std::clamp(std::ceil(cells_of_length * L_ / scales_.length), 1. * first_family_cells, 0.25 * max_cells);
        n.n_cells   = user_cells_.value_or(static_cast<unsigned int>(first));
        n.tolerance = user_tolerance_.value_or(
          std::max(std::min(family_tolerance * accuracy_, largest_family_tolerance) * choice_.strain * L_, 1e-13 * L_));
        if (!parameters_.time.initial_step)
          n.initial_step = 1e-4 * T_;
        choice_.is_family    = !user_cells_;
        choice_.is_users     = !choice_.is_family;
        choice_.wanted_error = choice_.space_share = std::numeric_limits<double>::quiet_NaN();
        choice_.explanation =
          choice_.is_family
            ? fmt::format("for Accuracy {:g}: the stretch form, on ever finer meshes until the displacement settles",
                          accuracy_)
            : "stretch form, with cells as set by the user";
      }

      /// Chooses fronts for moving jumps that are known to be waves, each with numerics of its own (moving_fronts.h).
      /// The numerics set here are those of a first run.
      void
      fronts()
      {
        Numerics &n         = choice_.numerics;
        n.degree            = parameters_.discretization.degree.value_or(moving_degree);
        n.n_cells           = first_moving_cells;
        n.integrator        = "radau 5";
        n.tolerance         = moving_tolerance * scale_ / n.n_cells;
        n.jumps_move        = true;
        choice_.has_fronts  = true;
        choice_.explanation = fmt::format("for Accuracy {:g}: jumps that move, by ever steeper fronts", accuracy_);
      }

      /**
       * Chooses the mesh for moving jumps of the active stress, where every method is of order 1 in the cell size: the
       * mesh is doubled until the displacement settles, or until too many cells would be needed. The error that is left
       * is the one that is reported.
       */
      void
      moving_jumps()
      {
        Numerics &n  = choice_.numerics;
        jumps_move_  = true;
        n.jumps_move = true;
        n.degree     = parameters_.discretization.degree.value_or(moving_degree);
        n.integrator = "radau 5";
        if (cycles_)
          cycles_->accuracy = 0.01 * accuracy_; // the displacements are compared here
        const double period = std::min(scene_.active_stress->period().value_or(T_), T_);
        double change       = std::numeric_limits<double>::infinity();
        for (n.n_cells = first_moving_cells;; n.n_cells *= 2)
        {
          // Steps that pass over many cells at once miss the motion in between, and their errors look small.
          n.step_limits        = {{0., period / (moving_steps * n.n_cells)}};
          tolerance_           = moving_tolerance * scale_ / n.n_cells;
          const double before  = pilot_.displacement;
          const bool is_second = pilot_.time.status == Status::finished;
          pilot_               = pilot(pilot_numerics(n.degree, n.n_cells, tolerance_), ResolutionWish::size);
          measure_size();
          const bool finished = pilot_.time.status == Status::finished;
          if (!finished && (n.n_cells > first_moving_cells || pilot_.time.reason == "inverted_at_end"))
            return; // the run will report the reason
          // Meshes double their cells and take up to twice the steps.
          unsigned int last = n.n_cells;
          for (double work = 4. * n.n_cells * pilot_.time.steps;
               2 * last <= last_moving_cells && work < max_moving_work;
               work *= 4.)
            last *= 2;
          if (finished && is_second)
          {
            const double change_before = change;
            change                     = std::abs(pilot_.displacement - before);
            // Changes may be small by chance if there is only one.
            const bool is_first = !std::isfinite(change_before);
            const double error =
              is_first ? moving_factor_of_first * change : moving_factor * std::max(change, 0.5 * change_before);
            const double wanted    = accuracy_ * size_;
            choice_.measured_error = error;
            choice_.space_share    = 0.9; // the tolerance is small
            choice_.advice = "the active stress jumps at places that move through the cells, where the error falls "
                             "only like the size of a cell, and works and energies are known only to within some per "
                             "cent: fronts of finite width (a smoothed square profile) cost far less";
            const bool hopeless = !is_first && error > wanted * last / n.n_cells;
            if (error <= 0.9 * wanted || hopeless) // the end of cycles has an error, too
              return;
          }
          if (n.n_cells == last)
            return;
        }
      }

      /// Order of the error estimate of the run, on which the growth of its number of steps depends.
      unsigned int
      estimated_order() const
      {
        const Integrator &method = integrator(integrator_name().empty() ? "automatic" : integrator_name());
        return method.petsc_type == "radau" ? method.n_stages : parameters_.time.order;
      }

      /// Smallest size of a displacement whose wanted error is round-off.
      double
      min_size() const
      {
        return min_error * L_ / accuracy_;
      }

      /// True where the friction switches its direction, so that kinks pass through the steps.
      bool
      kinks_move() const
      {
        return scene_.ground.direction.is_uneven();
      }

      /// Factor by which the tolerance may exceed that of the rule.
      double
      superconvergence() const
      {
        const std::string &name = integrator_name();
        if (choice_.numerics.mesh.tolerance > 0. || pilot_.min_stretch.value < emptied || kinks_move())
          return 1.;
        return name == "radau 9" ? radau_9_superconvergence : name == "radau 5" ? radau_5_superconvergence : 1.;
      }

      /// Time tolerance for the wanted error: the number of steps grows as tolerance^(-1/(order+1)), and error =
      /// time_factor * steps * tolerance = accuracy * size.
      double
      tolerance_by_rule() const
      {
        const double r      = 1. / (1. + estimated_order());
        const double wanted = accuracy_ * size_ / (time_factor * steps_to_the_end() * std::pow(tolerance_, r));
        return std::max(superconvergence() * std::min(std::pow(wanted, 1. / (1. - r)), tolerance_),
                        std::max({(kinks_move() ? min_tolerance_if_kinks : min_tolerance) * scale_,
                                  negligible_displacement(),
                                  inverts_at_end_ ? 0.1 * accuracy_ * tolerance_ : 0.})); // the size is not known then
      }

      /// Sets the time tolerance, and the explanation.
      void
      finish(const bool fixed)
      {
        Numerics &n         = choice_.numerics;
        const bool predicts = pilot_.time.status == Status::finished;
        if (size_ == 0.)
          size_ = scale_;
        const bool is_graded = n.grading.levels > 0; // all is chosen already
        if (!jumps_move_ && !is_graded && n.integrator == "radau 5" && n.mesh.tolerance == 0. &&
            accuracy_ < radau_9_accuracy)
          n.integrator = "radau 9";
        if (!parameters_.time.initial_step && !is_graded)
          n.initial_step = first_step();
        n.tolerance = user_tolerance_.value_or(jumps_move_ ? tolerance_
                                               : is_graded ? n.tolerance
                                                           : tolerance_by_rule());
        if (predicts && !jumps_move_ && !user_cells_ && !user_tolerance_ && !fixed &&
            !parameters_.discretization.mesh_tolerance)
        {
          choice_.space_share  = space_over_time_ / (1. + space_over_time_);
          choice_.wanted_error = accuracy_ * size_;
          if (n.mesh.tolerance > 0. && stiffness() < very_soft)
            choice_.min_error = soft_error * size_;
        }
        if (jumps_move_ && predicts)
          choice_.wanted_error = accuracy_ * size_;
        if (std::isfinite(choice_.wanted_error))
          choice_.min_size = std::max(displacement_floor * pilot_.largest_u, min_size());
        const double seconds     = watch_.seconds();
        const std::string kind   = jumps_move_ ? "jumps of the active stress that move, "
                                   : is_graded ? fmt::format("sudden stress, {} of cells smaller by {:g} each, ",
                                                           counted(n.grading.levels, "level"),
                                                           n.grading.ratio)
                                   : n.mesh.tolerance > 0.
                                     ? fmt::format("adaptive mesh, tolerance {:.2g}, ", n.mesh.tolerance)
                                     : "";
        choice_.explanation      = predicts
                                     ? fmt::format("for Accuracy {:g}: {}from {} in {:.2g} s: {} about {:.3g}",
                                              accuracy_,
                                              kind,
                                              counted(n_pilots_, "pilot run"),
                                              seconds,
                                              scene_.keeps_its_centre() ? "deformation" : "displacement",
                                              scene_.keeps_its_centre() ? size_ : pilot_.displacement)
                                     : fmt::format("for Accuracy {:g}: {}the last of {}, with {} cells, ended early: {}",
                                              accuracy_,
                                              kind,
                                              counted(n_pilots_, "pilot run"),
                                              n.n_cells,
                                              pilot_.time.message);
        const double least_error = choice_.measured_error.value_or(choice_.min_error);
        if (least_error > 1.5 * choice_.wanted_error)
          choice_.explanation +=
            fmt::format("; Accuracy cannot be met, the error is about {:.2g} of the displacement", least_error / size_);
        if (!scales_.sees_all)
          choice_.explanation +=
            "; an event of the active stress that is shorter than a step of its sampling may be missed";
        if (jumps_move_ && !choice_.advice.empty())
          choice_.explanation += "; " + choice_.advice;
      }

      const Stopwatch watch_;
      const MPI_Comm communicator_;
      const KeepGoing &keep_going_;
      const RunParameters &parameters_;
      const Scene &scene_;
      const StressScales scales_;
      const std::optional<unsigned int> &user_cells_;
      const std::optional<double> &user_tolerance_;
      const double T_, L_, accuracy_, scale_;
      const bool adaptive_steps_;
      TimeParameters pilot_time_;
      std::optional<CycleWish> cycles_; ///< cycle request of pilots
      NumericsChoice choice_;
      SimulationResult pilot_; ///< last one that counts
      double tolerance_ = 0., size_ = 0.;
      unsigned int n_pilots_ = 0;
      bool jumps_move_ = false, inverts_at_end_ = false;
      double space_over_time_ = 1.; ///< ratio of the errors predicted by the rule
    };
  } // namespace

  namespace
  {
    /// Beginning of a scene, with the same active stress.
    class Beginning
    {
    public:
      Beginning(const Scene &whole, const double duration)
        : scene_{whole.body,
                 whole.friction->scaled(1.),
                 std::unique_ptr<const ActiveStress>(whole.active_stress.get()), // lent, see below
                 duration,
                 whole.profiles,
                 whole.ground}
      {
      }
      ~Beginning()
      {
        static_cast<void>(scene_.active_stress.release());
      }
      Beginning(const Beginning &) = delete;

      const Scene &
      scene() const
      {
        return scene_;
      }

    private:
      Scene scene_;
    };

    /// End of the first strides of a run, if it has many more and they are all computed: numerics good for these are
    /// good for all.
    std::optional<double>
    end_of_first_strides(const RunParameters &parameters, const Scene &scene)
    {
      const auto gait = scene.active_stress->repetition();
      if (!gait || parameters.time.step_control != StepControl::adaptive || parameters.discretization.n_cells ||
          parameters.time.tolerance)
        return std::nullopt;
      const double softness = scene.body.elastic_modulus / natural_units(scene).force * gait->period / scene.end_time;
      const bool settles = cycle_wish(parameters, scene, /*has_pictures=*/false) && softness > min_settling_stiffness;
      const double end   = gait->from + first_strides * gait->period;
      return !settles && scene.end_time > long_run * end ? std::optional(end) : std::nullopt;
    }
  } // namespace

  std::optional<NumericsChoice>
  choose_numerics(MPI_Comm communicator,
                  const RunParameters &parameters,
                  const Scene &scene,
                  const KeepGoing &keep_going)
  {
    try
    {
      if (const auto end = end_of_first_strides(parameters, scene))
      {
        const Beginning beginning(scene, *end);
        NumericsChoice choice = Chooser(communicator, parameters, beginning.scene(), keep_going).choose();
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
      return Chooser(communicator, parameters, scene, keep_going).choose();
    }
    catch (const Interrupted &)
    {
      return std::nullopt;
    }
  }

  void
  prepare_for_pictures(NumericsChoice &choice, const RunParameters &parameters)
  {
    const double largest = accuracy_rule::choice::tolerance_of_pictures * choice.wanted_error;
    if (parameters.time.tolerance || choice.is_of_several_runs() || !choice.numerics.integrator.starts_with("radau") ||
        !(largest < choice.numerics.tolerance))
      return;
    choice.numerics.tolerance =
      std::max(largest, accuracy_rule::choice::min_tolerance_of_pictures * parameters.body.length);
    choice.explanation += fmt::format("; tolerance {:.2g} for pictures", choice.numerics.tolerance);
  }
} // namespace crawler
