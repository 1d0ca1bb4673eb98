// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/graded_choice.h>
#include <crawler/run/accuracy_rule.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    using namespace accuracy_rule::graded;

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

    class Search
    {
    public:
      explicit Search(const GradedTask &task)
        : task_(task)
        , now_(task.start)
        , n_pieces_(static_cast<unsigned int>(task.scene.breaks_in_space().size()) + 1)
      {
      }

      std::optional<GradedChoice>
      find()
      {
        now_.grading = {0, coarse_ratio};
        now_.n_cells = std::max(now_.n_cells, min_graded_cells(n_pieces_ - 1, now_.grading)); // fewer are the same mesh
        while (smallest_size(task_.scene, now_) > std::max(task_.layer, smallest_layer) && task_.layer > 0.)
          ++now_.grading.levels;
        if (task_.choose_tolerance)
          now_.tolerance = 1e-3 * task_.scale;
        // Coarse meshes or steps can lose a stretch that is not lost.
        double largest = 1e-2 * task_.scale; // tolerance
        for (unsigned int beginnings = 1; !run(now_, result_); ++beginnings)
        {
          if (beginnings == max_beginnings)
            return std::nullopt;
          possible_ = true;
          now_.n_cells *= 2;
          if (task_.choose_tolerance)
            largest = now_.tolerance *= finer_tolerance;
        }
        // Tolerance relative to a size that the runs tell.
        for (unsigned int i = 0; i < 2; ++i)
        {
          const double before = wanted_;
          if (!measure())
            return std::nullopt;
          if (std::abs(wanted_ - before) < same_size * wanted_)
            break;
          if (task_.choose_tolerance)
            now_.tolerance = std::min(largest, task_.tolerance_factor * wanted_);
          if (!run(now_, result_))
            return std::nullopt;
        }
        if (task_.choose_tolerance)
          refine(time_change_, [](Numerics &n) { n.tolerance *= finer_tolerance; });
        const auto one_more_level   = [](Numerics &n) { ++n.grading.levels; };
        const auto with_finer_ratio = [](Numerics &n) { n.grading = finer(n.grading); };
        const auto with_more_cells  = [this](Numerics &n) {
          n.n_cells = finer_n_cells(more_cells, n.n_cells, n_pieces_ - 1, n.grading);
        };
        bool again               = true;
        const auto is_ratio_fine = [this]() {
          return task_.accuracy >= coarse_ratio_is_enough || now_.grading.ratio > fine_ratio * 0.99;
        };
        do
        {
          double levels_change = 0., cells_change = std::numeric_limits<double>::infinity(), ratio_change = 0.;
          climb(levels_change, one_more_level);
          if (is_ratio_fine() || try_one(ratio_change, with_finer_ratio))
            ratio_change = 0.;
          again = refine(cells_change, with_more_cells);
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
        return GradedChoice{first_step(now_),
                            result_,
                            std::max(space_change_, 1e-3 * wanted_) / std::max(time_change_, 1e-3 * wanted_),
                            rest_};
      }

    private:
      Numerics
      first_step(Numerics numerics) const
      {
        if (task_.choose_first_step)
          numerics.initial_step = first_step_on_graded_mesh(task_.scene, numerics);
        return numerics;
      }

      bool
      run(const Numerics &numerics, SimulationResult &result)
      {
        const unsigned int many = std::max(max_cells, max_cells_of_piece * n_pieces_);
        is_too_fine_ = numerics.n_cells > (result_.time.steps * many > max_work ? many : cheap_mesh_factor * many);
        possible_ =
          possible_ && ++n_runs_ <= max_runs && !is_too_fine_ && smallest_size(task_.scene, numerics) >= smallest_cell;
        if (!possible_)
          return false;
        result    = task_.run(first_step(numerics));
        possible_ = result.time.status == Status::finished && result.min_stretch.value > emptied;
        return possible_;
      }

      /// True if the displacement with numerics @p next differs; @p change is the difference.
      bool
      matters(const Numerics &next, SimulationResult &result, double &change)
      {
        if (!run(next, result))
          return false;
        change = std::abs(result.displacement - result_.displacement);
        return change > part * wanted_;
      }

      /// Makes one refinement if it matters.
      template <typename Refinement>
      bool
      try_one(double &change, const Refinement &refinement)
      {
        Numerics next = now_;
        refinement(next);
        SimulationResult result;
        if (!matters(next, result, change))
          return false;
        now_    = next;
        result_ = result;
        return true;
      }

      /// Repeats a refinement while it matters; returns true if there has been one.
      template <typename Refinement>
      bool
      refine(double &change, const Refinement &refinement)
      {
        bool any = false;
        while (try_one(change, refinement))
          any = true;
        return any;
      }

      /// Sets the wanted error of a displacement like the last one; false if that is 0.
      bool
      measure()
      {
        wanted_ = task_.accuracy * task_.size(result_);
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
        {
          Numerics next = now_;
          one_more_level(next);
          SimulationResult result;
          if (!run(next, result))
            return;
          change  = std::abs(result.displacement - result_.displacement);
          now_    = next;
          result_ = result;
        } while (measure() && change > gain_of_level() * part * wanted_);
      }

      const GradedTask &task_;
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
    const double h = smallest_size(scene, numerics), k = scene.body.elastic_modulus / natural_units(scene).force;
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

  std::optional<GradedChoice>
  find_graded_mesh(const GradedTask &task)
  {
    return Search(task).find();
  }
} // namespace crawler
