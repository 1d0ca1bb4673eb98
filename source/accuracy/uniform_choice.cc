// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/mesh_choices.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    using namespace mesh_choice;

    /// Thickness, in distances between the unknowns, below which layers may look resolved when they are not.
    constexpr double widest_hidden_layer = 1.;
    /// Factor on `unresolved` of the mesh: a bound of the relative error of the displacement in space.
    constexpr double space_factor = 6.;

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
        const bool resolves = are_users || pilots.last.unresolved <= std::max(resolved, accuracy) || n_cells >= most;
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
     * it is at least half of that.
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
      double unresolved = last.unresolved, indicator = last.largest_indicator;
      double rate = sees_layers(pilots, degree, n_cells) ? full_rate : 0., indicator_rate = rate;
      const auto unbalanced = [&]() {
        return may_be_steep && indicator_factor * indicator > accuracy * last.strain &&
               indicator_rate < 0.5 * full_rate;
      };
      while ((rate < 0.5 * full_rate || unbalanced()) && 2 * n_cells <= max_cells / 4)
      {
        if (may_be_steep && 2 * n_cells > max_uniform_cells)
          return std::nullopt;
        const SimulationResult finer = pilots.run(choice.numerics, degree, 2 * n_cells, ResolutionWish::all, 0.01);
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
      // Layers thinner than the cells do not show in the stretch, but the balance of forces shows them; its rate, too,
      // must be that of a smooth solution.
      const double gain      = std::pow(std::max(1., cells / n_cells), full_rate);
      const double too_large = indicator_factor * indicator / (accuracy * gain * last.strain);
      if (may_be_steep && too_large > 1.)
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
    if (!pilots.finished() || pilots.last.unresolved > std::max(resolved, parameters.accuracy))
      return most == max_cells ? std::optional(nothing_predicted) : std::nullopt; // nothing else is left
    if (most < max_cells && pilots.stiffness() < very_soft)
      return std::nullopt; // a pilot may pass over these layers by luck
    return user_cells ? nothing_predicted : extrapolate_cells(pilots, choice, degree, n_cells, may_be_steep);
  }
} // namespace crawler
