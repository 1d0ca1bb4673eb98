// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/mesh_choices.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    // Constants measured by tests/verification/jump_study.cc; doc/numerics.md, "Jumps".
    /// Degrees: the higher one below Accuracy accurate_graded.
    constexpr unsigned int graded_degree = 6, accurate_graded_degree = 8;
    constexpr double accurate_graded = 3e-7;
    /// Change of the displacement, as a part of the wanted error, below which a refinement was not needed.
    constexpr double graded_change = 0.25;
    /// Accuracy below which runs are by radau 9, since starts take many steps that are short for any method.
    constexpr double radau_9_accuracy_if_graded = 3e-5;
    /// First tolerances, relative to the wanted error.
    constexpr double graded_radau_5 = 4., graded_radau_9 = 10., graded_others = 0.1;
    constexpr double coarse_ratio = 0.25, fine_ratio = 0.4;
    /// Gain of a level: it reduces the error at a discontinuity at least by this factor over the square of the ratio.
    constexpr double part_of_gain = 0.5;
    /// Accuracy from which on the coarse ratio has never mattered.
    constexpr double coarse_ratio_is_enough = 1e-5;
    /// Largest tolerance, relative to the expected displacement, and its relative change that counts.
    constexpr double largest_tolerance = 1e-3, same_size = 0.1;
    /// Ratio of two successive changes by more cells above which they may be errors of the time steps, not of the mesh.
    constexpr double falling = 0.35;
    /// Cycles of each run where the stiffness of a cycle is at least this: starts from rest are forgotten in one.
    constexpr unsigned int first_cycles   = 2;
    constexpr double forgetting_stiffness = 0.3;
    /// Limits at which the search is given up.
    constexpr unsigned int max_runs = 40, max_cells = 96, max_cells_of_piece = 12;
    /// Factor on max_cells while cells times steps stay below max_work; the last change by more cells may then be
    /// last_part of the wanted error.
    constexpr unsigned int cheap_mesh_factor = 4;
    constexpr double max_work = 3e5, last_part = 0.5;
    constexpr double smallest_cell = 1e-7, emptied = 1e-3;
    /// Thickness of layers, relative to the length, below which they do not count.
    constexpr double smallest_layer = 1e-6;
    /// Number of times the search begins anew, with twice the cells, if its first mesh loses a stretch.
    constexpr unsigned int max_beginnings = 3;
    constexpr double more_cells = 1.5, finer_tolerance = 0.1;
    constexpr double longest_first_step = 1e-2, shortest_first_step = 1e-16;

    /// Size of the smallest cell, relative to the length.
    double
    smallest_size(const Scene &scene, const Numerics &numerics)
    {
      const std::vector<double> ends = first_cell_ends(scene, numerics);
      double smallest                = ends.empty() ? 1. / numerics.n_cells : 1.;
      for (std::size_t i = 1; i < ends.size(); ++i)
        smallest = std::min(smallest, ends[i] - ends[i - 1]);
      return smallest;
    }

    Grading
    finer(const Grading &grading)
    {
      // Levels for the same smallest size, with a larger ratio.
      const double levels = grading.levels * std::log(grading.ratio) / std::log(fine_ratio);
      return {static_cast<unsigned int>(std::ceil(levels)), fine_ratio};
    }

    /// Thickness, relative to the length, of the layer in which velocities after a sudden stress, which fall with time
    /// to the power -1/2, are above the one at which friction switches its direction. No refinement shows this layer to
    /// a mesh that is much coarser.
    double
    fast_layer(const Pilots &pilots)
    {
      const auto &direction = pilots.scene.ground.direction;
      const Body &body      = pilots.scene.body;
      return direction.is_uneven() ? pilots.scales.sudden * pilots.scales.stress /
                                       (body.friction_coefficient * direction.switching_velocity * body.length)
                                   : 0.;
    }

    class Search
    {
    public:
      Search(Pilots &pilots, const Numerics &start)
        : pilots_(pilots)
        , now_(start)
        , n_pieces_(static_cast<unsigned int>(pilots.scene.breaks_in_space().size()) + 1)
      {
      }

      std::optional<double>
      find(NumericsChoice &choice)
      {
        const double layer           = fast_layer(pilots_);
        const bool chooses_tolerance = !pilots_.parameters.time.tolerance;
        now_.grading                 = {0, coarse_ratio};
        now_.n_cells = std::max(now_.n_cells, min_graded_cells(n_pieces_ - 1, now_.grading)); // fewer are the same mesh
        while (layer > 0. && smallest_size(pilots_.scene, now_) > std::max(layer, smallest_layer))
          ++now_.grading.levels;
        // Coarse meshes or steps can lose a stretch that is not lost, also where many cycles make the displacement
        // large.
        double largest = largest_tolerance * pilots_.scale;
        if (chooses_tolerance)
          now_.tolerance = largest;
        for (unsigned int beginnings = 1; !run(now_, result_); ++beginnings)
        {
          if (beginnings == max_beginnings)
            return std::nullopt;
          possible_ = true;
          now_.n_cells *= 2;
          if (chooses_tolerance)
            largest = now_.tolerance *= finer_tolerance;
        }
        // Tolerance relative to a size that the runs tell.
        for (unsigned int i = 0; i < 2; ++i)
        {
          const double before = now_.tolerance;
          if (!measure())
            return std::nullopt;
          if (chooses_tolerance)
            now_.tolerance = std::min(largest, first_tolerance() * wanted_);
          if (std::abs(now_.tolerance - before) <= same_size * before)
            break;
          if (!run(now_, result_))
            return std::nullopt;
        }
        const auto with_finer_steps = [](Numerics &n) { n.tolerance *= finer_tolerance; };
        while (chooses_tolerance && try_one(time_change_, with_finer_steps))
        {
        }
        const auto one_more_level   = [](Numerics &n) { ++n.grading.levels; };
        const auto with_finer_ratio = [](Numerics &n) { n.grading = finer(n.grading); };
        const auto with_more_cells  = [this](Numerics &n) {
          n.n_cells = finer_n_cells(more_cells, n.n_cells, n_pieces_ - 1, n.grading);
        };
        bool again               = true;
        double last              = std::numeric_limits<double>::infinity(); // change by more cells
        const auto is_ratio_fine = [this]() {
          return pilots_.parameters.accuracy >= coarse_ratio_is_enough || now_.grading.ratio > fine_ratio * 0.99;
        };
        do
        {
          double levels_change = 0., cells_change = std::numeric_limits<double>::infinity(), ratio_change = 0.;
          climb(levels_change, one_more_level);
          if (is_ratio_fine() || try_one(ratio_change, with_finer_ratio))
            ratio_change = 0.;
          again = false;
          for (; try_one(cells_change, with_more_cells); last = cells_change)
          {
            again = true;
            if (chooses_tolerance && cells_change > falling * last)
              try_one(time_change_, with_finer_steps);
          }
          if (is_too_fine_ && cells_change <= last_part * wanted_)
          {
            rest_     = cells_change;
            possible_ = true;
            again     = false;
          }
          space_change_ = levels_change / gain_of_level() + ratio_change + cells_change;
        } while (again && possible_);
        if (!possible_)
          return std::nullopt;
        choice.numerics  = first_step(now_);
        choice.min_error = rest_;
        pilots_.count(result_);
        return std::max(space_change_, 1e-3 * wanted_) / std::max(time_change_, 1e-3 * wanted_);
      }

    private:
      /// First time tolerance, relative to the wanted error.
      double
      first_tolerance() const
      {
        const std::string &name = integrator_of(pilots_.parameters.time, now_);
        return name == "radau 9" ? graded_radau_9 : name == "radau 5" ? graded_radau_5 : graded_others;
      }

      Numerics
      first_step(Numerics numerics) const
      {
        if (!pilots_.parameters.time.initial_step)
          numerics.initial_step = first_step_on_graded_mesh(pilots_.scene, numerics);
        return numerics;
      }

      bool
      run(const Numerics &numerics, SimulationResult &result)
      {
        const unsigned int many = std::max(max_cells, max_cells_of_piece * n_pieces_);
        is_too_fine_ = numerics.n_cells > (result_.time.steps * many > max_work ? many : cheap_mesh_factor * many);
        possible_    = possible_ && ++n_runs_ <= max_runs && !is_too_fine_ &&
                    smallest_size(pilots_.scene, numerics) >= smallest_cell;
        if (!possible_)
          return false;
        result    = pilots_.run(first_step(numerics), ResolutionWish::size);
        possible_ = result.time.status == Status::finished && result.stretch.min.value > emptied;
        return possible_;
      }

      /// Tries a refinement, which changes the displacement by @p change, and keeps it if that matters, or @p
      /// in_any_case; false if it is not kept.
      bool
      try_one(double &change, const auto &refinement, const bool in_any_case = false)
      {
        Numerics next = now_;
        refinement(next);
        SimulationResult result;
        if (!run(next, result))
          return false;
        change = std::abs(result.displacement - result_.displacement);
        if (!in_any_case && !(change > graded_change * wanted_))
          return false;
        now_    = next;
        result_ = result;
        return true;
      }

      /// Sets the wanted error of a displacement like the last one; false if that is 0.
      bool
      measure()
      {
        pilots_.count(result_);
        wanted_ = pilots_.parameters.accuracy * pilots_.size;
        return wanted_ > 0.;
      }

      /// Factor by which a level reduces the error at a discontinuity, at least.
      double
      gain_of_level() const
      {
        return part_of_gain / (now_.grading.ratio * now_.grading.ratio);
      }

      /// Adds one level after the other. The last change tells the remaining error.
      void
      climb(double &change, const auto &one_more_level)
      {
        do
          if (!try_one(change, one_more_level, /*in_any_case=*/true))
            return;
        while (measure() && change > gain_of_level() * graded_change * wanted_);
      }

      Pilots &pilots_;
      Numerics now_;
      const unsigned int n_pieces_; ///< number of pieces of the body, between breaks
      SimulationResult result_;
      double wanted_ = 0., time_change_ = 0., space_change_ = 0.;
      double rest_         = 0.; ///< last change by more cells, if no more are admitted
      unsigned int n_runs_ = 0;
      bool possible_       = true;
      bool is_too_fine_    = false; ///< property of the last mesh that was tried
    };
  } // namespace

  /// First step from the rate of the smallest cell's highest modes, about k q^4/(gamma h^2).
  double
  first_step_on_graded_mesh(const Scene &scene, const Numerics &numerics)
  {
    const double h = smallest_size(scene, numerics), k = stiffness(scene);
    const double size = h * h / k / std::pow(numerics.degree, 4.);
    return std::clamp(size, shortest_first_step, longest_first_step) * scene.end_time;
  }

  Numerics
  with_finer_grading(const Scene &scene, const Numerics &numerics)
  {
    Numerics result = numerics;
    if (result.grading.ratio < fine_ratio)
      result.grading = finer(result.grading);
    ++result.grading.levels;
    result.initial_step = std::min(result.initial_step, first_step_on_graded_mesh(scene, result));
    return result;
  }

  std::optional<double>
  choose_graded_mesh(Pilots &pilots, NumericsChoice &choice)
  {
    const double accuracy = pilots.parameters.accuracy;
    Numerics start        = choice.numerics;
    start.degree = pilots.parameters.discretization.degree.value_or(accuracy < accurate_graded ? accurate_graded_degree
                                                                                               : graded_degree);
    start.n_cells =
      static_cast<unsigned int>(std::clamp(std::ceil(0.25 * pilots.scene.body.length / pilots.scales.length),
                                           1. * mesh_choice::min_cells,
                                           1. * mesh_choice::max_cells));
    // Pieces between breaks have a cell at least.
    start.n_cells     = std::max(start.n_cells, static_cast<unsigned int>(pilots.scales.in_space) + 1);
    start.integrator  = accuracy < radau_9_accuracy_if_graded ? "radau 9" : "radau 5";
    start.tolerance   = pilots.parameters.time.tolerance.value_or(0.);
    const auto cycles = pilots.cycles;
    if (pilots.cycles)
    {
      pilots.cycles->accuracy = accuracy; // the displacements are compared here
      if (stiffness(pilots.scene) * pilots.cycles->period / pilots.scene.end_time > forgetting_stiffness)
        pilots.cycles->computed = first_cycles;
    }
    const auto space_over_time = Search(pilots, start).find(choice);
    pilots.cycles              = cycles;
    if (!space_over_time)
      pilots.size = 0.;
    return space_over_time;
  }
} // namespace crawler
