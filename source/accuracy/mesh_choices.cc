// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/mesh_choices.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace crawler
{
  using namespace mesh_choice;

  namespace
  {
    /// Thickness, in distances between the unknowns, below which layers may look resolved when they are not.
    constexpr double widest_hidden_layer = 1.;
    /// Factor on `unresolved` of the mesh: a bound of the relative error of the displacement in space.
    constexpr double space_factor = 6.;

    /// Changes of the displacement by twice the cells, relative to the wanted error, after which no more cells are
    /// tried, whatever layers look like: the larger one if the change before was at least twice as large.
    constexpr double last_change = 0.3, last_small_change = 0.03;

    /// True if all layers are wide enough to show in the modes of the stretch on this mesh. Where nothing starts
    /// suddenly they are as wide as elasticity smooths against the largest friction of the last pilot while the active
    /// stress changes.
    bool
    sees_layers(const Pilots &pilots, const unsigned int degree, const unsigned int n_cells)
    {
      const Scene &scene = pilots.scene;
      if (!scene.is_plain() || !pilots.scales.is_smooth ||
          pilots.scales.sudden > sudden_part * std::sqrt(pilots.parameters.accuracy))
        return false;
      double time = scene.end_time; // time in which the active stress changes
      for (const StepLimit &limit : pilots.scales.step_limits)
        time = std::min(time, limit.longest);
      return std::sqrt(pilots.stiffness_over_friction() * time / scene.end_time) * degree * n_cells >=
             widest_hidden_layer;
    }

    /// Time at which an end has inverted in the last pilot.
    std::optional<double>
    end_inversion(const SimulationResult &last)
    {
      return last.time.reason == "inverted_at_end" ? std::optional(last.inversion->t) : std::nullopt;
    }

    /// Makes pilots on meshes from @p n_cells cells on, at most @p most, with smaller steps each time, until one shows
    /// the deformation.
    void
    run_until_resolved(Pilots &pilots,
                       const Numerics &numerics,
                       const unsigned int degree,
                       unsigned int &n_cells,
                       const unsigned int most)
    {
      constexpr double same_time = 1e-6;
      const double accuracy      = pilots.parameters.accuracy;
      const bool are_users       = pilots.parameters.discretization.n_cells.has_value();
      for (bool good = false; !good && pilots.n < 20;)
      {
        const auto before = end_inversion(pilots.last);
        pilots.count(pilots.run(numerics, degree, n_cells, ResolutionWish::all));
        if (accuracy >= 1e-7 && pilots.is_for_stretch())
          return;
        const bool finished = pilots.finished();
        const bool resolves =
          are_users || pilots.last.size.unresolved() <= std::max(resolved, accuracy) || n_cells >= most;
        // Two pilots suffice whose ends invert at the same time, since the end conditions determine it on any mesh.
        const auto now        = end_inversion(pilots.last);
        pilots.inverts_at_end = now && before && std::abs(*now - *before) <= same_time * *now;
        // Coarse meshes or steps can look like an inversion; if finer ones agree the real run will name it.
        if (pilots.inverts_at_end)
          good = true;
        else if (!finished && !are_users && n_cells < std::min(most, 64u))
        {
          n_cells *= 2;
          pilots.tolerance *= 0.1;
        }
        else if (finished && !resolves)
          n_cells = std::min(most, 2 * n_cells);
        else if (finished && pilots.size > 0. && pilots.tolerance > 0.03 * pilots.size)
          pilots.tolerance = std::max(0.01 * pilots.size, 1e-3 * pilots.tolerance);
        else
          good = true;
      }
    }

    /**
     * Finds the number of cells from that of a pilot that resolves the deformation; nothing if the solution @p
     * may_be_steep and few cells are not enough. On smooth solutions `unresolved` falls as (cell size)^(2q-2), q the
     * pilot's degree, and the error of the displacement at least as fast. Thin layers look resolved before they are:
     * so the rate is measured, with smaller steps whose errors do not hide it, on meshes twice as fine each time until
     * it is at least half of that, or the displacement hardly changes any more.
     */
    std::optional<double>
    extrapolate_cells(
      Pilots &pilots, NumericsChoice &choice, const unsigned int degree, unsigned int n_cells, const bool may_be_steep)
    {
      const double accuracy     = pilots.parameters.accuracy;
      const double enough_cells = n_cells; // fewer failed or left too much unresolved
      const double full_rate = 2. * degree - 2., wanted_part = accuracy / space_factor;
      const auto rate_of = [full_rate](const double coarse, const double fine) {
        return std::clamp(std::log2(coarse / fine), 0.5, full_rate);
      };
      const SimulationResult &last = pilots.last;
      double unresolved = last.size.unresolved(), indicator = last.size.largest_indicator;
      double rate = sees_layers(pilots, degree, n_cells) ? full_rate : 0., indicator_rate = rate;
      const auto unbalanced = [&]() {
        return may_be_steep && indicator_factor * indicator > accuracy * last.size.strain &&
               indicator_rate < 0.5 * full_rate;
      };
      double displacement = std::numeric_limits<double>::quiet_NaN(), change = displacement; // with the smaller steps
      bool settled = false;
      while (!settled && (rate < 0.5 * full_rate || unbalanced()) && 2 * n_cells <= max_cells / 4)
      {
        if (may_be_steep && 2 * n_cells > max_uniform_cells)
          return std::nullopt;
        const SimulationResult finer = pilots.run(choice.numerics, degree, 2 * n_cells, ResolutionWish::all, 0.01);
        if (finer.time.status != Status::finished || finer.size.unresolved() == 0.)
          break;
        rate           = rate_of(unresolved, finer.size.unresolved());
        indicator_rate = rate_of(indicator, finer.size.largest_indicator);
        unresolved     = finer.size.unresolved();
        indicator      = finer.size.largest_indicator;
        n_cells *= 2;
        const double before = std::exchange(change, std::abs(finer.displacement - displacement));
        displacement        = finer.displacement;
        settled             = std::isfinite(before) && pilots.stiffness_over_friction() >= very_soft &&
                  change <= (2. * change <= before ? last_change : last_small_change) * accuracy * pilots.size;
        if (unresolved <= 0.01 * wanted_part && !unbalanced())
          break;
      }
      double cells = rate > 0. ? n_cells * std::pow(unresolved / wanted_part, 1. / rate) : n_cells;
      // Layers thinner than the cells do not show in the stretch, but the balance of forces shows them; its rate, too,
      // must be that of a smooth solution.
      const double gain      = std::pow(std::max(1., cells / n_cells), full_rate);
      const double too_large = indicator_factor * indicator / (accuracy * gain * last.size.strain);
      if (settled)
        cells = std::min(cells, 1. * n_cells);
      else if (may_be_steep && too_large > 1.)
      {
        if (indicator_rate < 0.5 * full_rate || pilots.stiffness_over_friction() < very_soft)
          return std::nullopt;
        cells = std::max(cells, 1. * n_cells) * std::pow(too_large, 1. / indicator_rate);
      }
      unsigned int &chosen = choice.numerics.n_cells;
      chosen = static_cast<unsigned int>(std::clamp(std::ceil(cells), enough_cells, static_cast<double>(max_cells)));
      choice.is_steep = !choice.is_rough && rate > 0. && std::min(rate, indicator_rate) < 0.5 * full_rate;
      if (may_be_steep && chosen > max_uniform_cells)
        return std::nullopt;
      return std::pow(cells / chosen, rate > 0. ? rate : full_rate);
    }
  } // namespace

  std::optional<double>
  choose_uniform_mesh(Pilots &pilots, NumericsChoice &choice, const unsigned int most, const bool may_be_steep)
  {
    constexpr double nothing_predicted = 1.;
    const RunParameters &parameters    = pilots.parameters;
    const auto &user_cells             = parameters.discretization.n_cells;
    Numerics &n                        = choice.numerics;
    if (parameters.time.step_control == StepControl::adaptive)
      n.integrator = "radau 5";
    // Linear elements have no mode of the stretch that could show the error: one degree more shows it.
    const unsigned int degree = std::max(n.degree, 2u);
    // Cells of this degree resolve a stress whose scale is a quarter of their size.
    const double length = pilots.scene.body.length;
    const double seen   = std::clamp(std::ceil(0.25 * length / pilots.scales.length), 1. * min_cells, 0.25 * max_cells);
    unsigned int n_cells = user_cells.value_or(static_cast<unsigned int>(seen));
    if (n_cells > most && !user_cells)
      return std::nullopt;
    run_until_resolved(pilots, n, degree, n_cells, most);
    n.n_cells = n_cells;
    if ((parameters.accuracy >= 1e-7 && pilots.is_for_stretch()) || pilots.inverts_at_end)
      return nothing_predicted;
    if (!pilots.finished() || pilots.last.size.unresolved() > std::max(resolved, parameters.accuracy))
      return most == max_cells ? std::optional(nothing_predicted) : std::nullopt; // nothing else is left
    if (most < max_cells && stiffness(pilots.scene) < very_soft)
      return std::nullopt; // a pilot may pass over these layers by luck
    return user_cells ? nothing_predicted : extrapolate_cells(pilots, choice, degree, n_cells, may_be_steep);
  }

  namespace
  {
    constexpr unsigned int adaptive_degree = 4, max_adaptive_pilot_steps = 20000, max_adaptive_pilot_cells = 1200;
  }

  void
  choose_adaptive_mesh(Pilots &pilots, NumericsChoice &choice)
  {
    const DiscretizationParameters &own = pilots.parameters.discretization;
    const double L                      = pilots.scene.body.length;
    Numerics &n                         = choice.numerics;
    n.integrator                        = "bdf";
    n.degree                            = own.degree.value_or(adaptive_degree);
    n.n_cells                           = own.n_cells.value_or(
      static_cast<unsigned int>(std::clamp(std::ceil(L / pilots.scales.length), 8., 1. * max_cells)));
    n.mesh        = {1., own.smallest_cell.value_or(1e-6 * L)};
    double strain = pilots.last.size.strain > 0. ? pilots.last.size.strain : pilots.scale * pilots.scale / L;
    // Pilots that need more steps than this collapse, and the scheme that is safe then costs less.
    const unsigned int usual = pilots.time.max_steps;
    pilots.time.max_steps    = std::min(usual, max_adaptive_pilot_steps);
    double tighter           = 1.;
    for (int i = 0; i < 4; ++i)
    {
      Numerics settings        = n;
      settings.mesh.tolerance  = tighter * resolved * strain;
      settings.mesh.most_cells = max_adaptive_pilot_cells;
      pilots.count(pilots.run(settings, n.degree, n.n_cells, ResolutionWish::all));
      const bool finished = pilots.finished();
      const double before = strain;
      if (finished && pilots.last.size.strain > 0.)
        strain = pilots.last.size.strain;
      const bool strain_known = strain < 4. * before && strain > 0.25 * before;
      if (!finished)
        tighter *= 0.01; // the mesh may have caused the loss of the stretch
      const bool coarse_steps = finished && pilots.size > 0. && pilots.tolerance > 0.03 * pilots.size;
      if (coarse_steps || (!finished && i < 2))
        pilots.tolerance = finished ? std::max(0.01 * pilots.size, 1e-3 * pilots.tolerance) : 0.03 * pilots.tolerance;
      else if (strain_known)
        break;
    }
    pilots.time.max_steps = usual;
    const double accuracy = pilots.parameters.accuracy;
    n.mesh.tolerance = strain * own.mesh_tolerance.value_or(std::min(accuracy / indicator_factor, tighter * resolved));
    // Method bdf restarts with each mesh, unlike one-step methods; but where the stretch collapses it is faster.
    if (pilots.parameters.time.step_control == StepControl::adaptive && pilots.last.stretch.min.value > emptied)
      n.integrator = "radau 5";
  }

  namespace
  {
    /// Meshes are doubled until the displacement settles, which it does in proportion to the cell size, with tolerances
    /// that fall in the same proportion; limits on cells, and on cells times steps.
    constexpr unsigned int last_moving_cells = 2048;
    constexpr double max_moving_work         = 1e7;
    /// Smallest number of steps of a period for each cell.
    constexpr double moving_steps = 4.;
    /// Factors on the last change, which is the remaining error of a first-order method: the first one counts more.
    constexpr double moving_factor = 1.5, moving_factor_of_first = 4.;
  } // namespace

  void
  choose_mesh_for_moving_jumps(Pilots &pilots, NumericsChoice &choice)
  {
    const double accuracy = pilots.parameters.accuracy, end = pilots.scene.end_time;
    Numerics &n  = choice.numerics;
    n.jumps_move = true;
    n.degree     = pilots.parameters.discretization.degree.value_or(moving_degree);
    n.integrator = "radau 5";
    if (pilots.cycles)
      pilots.cycles->accuracy = 0.01 * accuracy; // the displacements are compared here
    const double period = std::min(pilots.scene.active_stress->period().value_or(end), end);
    double change       = std::numeric_limits<double>::infinity();
    for (n.n_cells = first_moving_cells;; n.n_cells *= 2)
    {
      // Steps that pass over many cells at once miss the motion in between, and their errors look small.
      n.step_limits        = {{0., period / (moving_steps * n.n_cells)}};
      n.tolerance          = moving_tolerance * pilots.scale / n.n_cells;
      pilots.tolerance     = n.tolerance;
      const double before  = pilots.last.displacement;
      const bool is_second = pilots.finished();
      pilots.count(pilots.run(n, n.degree, n.n_cells, ResolutionWish::size));
      const bool finished = pilots.finished();
      if (!finished && (n.n_cells > first_moving_cells || pilots.last.time.reason == "inverted_at_end"))
        return; // the run will report the reason
      // Meshes double their cells and take up to twice the steps.
      unsigned int last = n.n_cells;
      for (double work = 4. * n.n_cells * pilots.last.time.steps;
           2 * last <= last_moving_cells && work < max_moving_work;
           work *= 4.)
        last *= 2;
      if (finished && is_second)
      {
        const double change_before = change;
        change                     = std::abs(pilots.last.displacement - before);
        // Changes may be small by chance if there is only one.
        const bool is_first = !std::isfinite(change_before);
        const double error =
          is_first ? moving_factor_of_first * change : moving_factor * std::max(change, 0.5 * change_before);
        const double wanted   = accuracy * pilots.size;
        choice.measured_error = error;
        choice.space_share    = 0.9; // the tolerance is small
        choice.advice         = "the active stress jumps at places that move through the cells, where the error falls "
                                "only like the size of a cell, and works and energies are known only to within some per "
                                "cent: fronts of finite width (a smoothed square profile) cost far less";
        const bool hopeless   = !is_first && error > wanted * last / n.n_cells;
        if (error <= 0.9 * wanted || hopeless) // the end of cycles has an error, too
          return;
      }
      if (n.n_cells == last)
        return;
    }
  }

  namespace
  {
    /// Cells of the coarsest mesh, cells for each length in which the active stress changes, and the time tolerance
    /// relative to the strain, as a multiple of Accuracy and at most.
    constexpr unsigned int first_family_cells = 25;
    constexpr double cells_of_length = 4., family_tolerance = 10., largest_family_tolerance = 1e-3;
    /// Layers: layer_lengths times k/max|m_s| thick, at most this part of the body.
    constexpr double layer_lengths = 1., largest_layer = 0.02;
  } // namespace

  void
  choose_stretch_form(const Pilots &pilots, NumericsChoice &choice)
  {
    const RunParameters &own = pilots.parameters;
    const Scene &scene       = pilots.scene;
    const double L = scene.body.length, length = pilots.scales.length;
    const double m_s = pilots.scales.stress / length, a = std::max(1., std::abs(scene.friction_exponent()));
    const auto &user_cells = own.discretization.n_cells;
    Numerics &n            = choice.numerics;
    n.formulation          = Formulation::stretch;
    n.degree               = 1;
    n.mesh                 = {};
    n.layer =
      m_s > 0. ? std::min(largest_layer * L, layer_lengths / a * scene.body.elastic_modulus / m_s) : largest_layer * L;
    if (own.discretization.mesh == MeshKind::uniform)
      n.layer = 0.;
    n.integrator       = "radau 5";
    choice.strain      = std::min(pilots.scale / std::min(L, length), 0.3);
    const double first = std::clamp(std::ceil(cells_of_length * L / length), 1. * first_family_cells, 0.25 * max_cells);
    n.n_cells          = user_cells.value_or(static_cast<unsigned int>(first));
    n.tolerance        = own.time.tolerance.value_or(
      std::max(std::min(family_tolerance * own.accuracy, largest_family_tolerance) * choice.strain * L, 1e-13 * L));
    if (!own.time.initial_step)
      n.initial_step = 1e-4 * scene.end_time;
    choice.is_family = !user_cells;
    choice.is_users  = !choice.is_family;
    choice.explanation =
      choice.is_family
        ? fmt::format("for Accuracy {:g}: the stretch form, on ever finer meshes until the displacement settles",
                      own.accuracy)
        : "stretch form, with cells as set by the user";
  }
} // namespace crawler
