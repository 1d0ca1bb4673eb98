// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/choose_numerics.h>
#include <crawler/accuracy/pilots.h>
#include <crawler/accuracy/shared_choice.h>
#include <crawler/accuracy/stress_scales.h>
#include <crawler/run/batch.h>
#include <crawler/run/step_limiter.h>
#include <crawler/time/integrators.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    // Constants measured by tests/verification/shared_numerics_test.cc; doc/numerics.md, "Sweeps".
    /// Smallest number of cells, and factor on the first step, that are tried.
    constexpr unsigned int min_cells   = 2;
    constexpr double longer_first_step = 5.;
    /// Parts of the wanted error by which space and time may each change the displacement of an example, and by which
    /// the extrapolation of cycles may.
    constexpr double part = 0.12, part_of_cycles = 0.1;
    /// Tolerances tried, relative to the displacement: from the loosest, smaller by next_tolerance each time.
    constexpr double loosest_tolerance = 3e-2, next_tolerance = 0.316;

    /// True if an answer of shared numerics can have a bound that is comparable with the wanted error.
    bool
    may_share(const NumericsChoice &choice, const Problem &one)
    {
      return !one.scene.keeps_its_centre() && // displacements of 0 tell nothing
             !choice.is_of_several_runs() && choice.follows_rule() &&
             batch_method(one.scene, one.parameters.time, choice.numerics);
    }

    class Search
    {
    public:
      explicit Search(const std::span<const Problem> examples)
        : examples_(examples)
      {
        for (const Problem &one : examples)
          accuracy_ = std::min(accuracy_, one.parameters.accuracy);
      }

      std::optional<SharedChoice>
      find()
      {
        if (!begin_by_rule())
          return std::nullopt;
        const Numerics &n    = found_.choice.numerics;
        const Runs reference = run(n, found_.relative_tolerance);
        if (!reference.finished)
          return std::nullopt;
        if (n.grading.levels == 0)
          make_cheaper(reference);
        return found_;
      }

    private:
      /// Runs of all examples with the same numerics.
      struct Runs
      {
        bool finished = false;
        std::vector<double> displacements;
        double cost = std::numeric_limits<double>::infinity(); ///< cost of the time integration
      };

      /// Begins with the finest of the choices for all examples, with the tolerance relative to the displacement.
      bool
      begin_by_rule()
      {
        found_.relative_tolerance = std::numeric_limits<double>::infinity();
        for (const Problem &one : examples_)
        {
          const auto choice = choose_numerics(one);
          if (!choice || !may_share(*choice, one))
            return false;
          const double size         = choice->wanted_error / one.parameters.accuracy; // not 0 where D nearly is
          found_.relative_tolerance = std::min(found_.relative_tolerance, choice->numerics.tolerance / size);
          found_.sizes.push_back(size);
          if (found_.sizes.size() == 1)
          {
            found_.choice = *choice;
            continue;
          }
          const Numerics a = found_.choice.numerics, &b = choice->numerics;
          Numerics &n            = found_.choice.numerics;
          n                      = b.n_cells * b.degree > a.n_cells * a.degree ? b : a;
          n.integrator           = a.integrator == b.integrator ? a.integrator : "radau 9";
          n.initial_step         = std::min(a.initial_step, b.initial_step);
          n.min_event            = std::min(a.min_event, b.min_event);
          found_.choice.is_rough = found_.choice.is_rough || choice->is_rough;
          found_.choice.is_steep = found_.choice.is_steep || choice->is_steep;
        }
        return true;
      }

      Runs
      run(const Numerics &numerics, const double relative_tolerance)
      {
        SharedChoice settings       = found_;
        settings.choice.numerics    = numerics;
        settings.relative_tolerance = relative_tolerance;
        std::vector<NumericsChoice> choices;
        for (std::size_t i = 0; i < examples_.size(); ++i)
          choices.push_back(settings.choice_for(examples_[i].scene, found_.sizes[i]));
        std::vector<BatchRun> runs;
        for (std::size_t i = 0; i < examples_.size(); ++i)
        {
          const TimeParameters &time = examples_[i].parameters.time;
          if (!batch_method(examples_[i].scene, time, choices[i].numerics))
            return {};
          auto cycles = cycle_wish(examples_[i].parameters, examples_[i].scene, /*has_pictures=*/false);
          if (cycles)
            cycles->accuracy = part_of_cycles * accuracy_;
          runs.push_back({&examples_[i].scene, &time, &choices[i].numerics, cycles});
        }
        Runs result{true, {}, 0.};
        for (const auto &one : run_batch(runs, {.energy_balance = false}, examples_.front().keep_going))
        {
          if (!one || one->time.status != Status::finished)
            return {};
          result.displacements.push_back(one->displacement);
          result.cost += static_cast<double>(one->time.newton_iterations);
        }
        result.cost *= integrator(numerics.integrator).n_stages;
        return result;
      }

      /// True if the displacements differ negligibly.
      bool
      are_near(const Runs &some, const Runs &others) const
      {
        if (!some.finished || !others.finished)
          return false;
        for (std::size_t i = 0; i < examples_.size(); ++i)
          if (!(std::abs(some.displacements[i] - others.displacements[i]) <= part * accuracy_ * found_.sizes[i]))
            return false;
        return true;
      }

      void
      make_cheaper(const Runs &reference)
      {
        Numerics &best = found_.choice.numerics;
        Runs on_mesh   = reference; // exact in time, as far as it matters
        for (unsigned int n = min_cells; n < best.n_cells; ++n)
        {
          Numerics fewer   = best;
          fewer.n_cells    = n;
          const Runs tried = run(fewer, found_.relative_tolerance);
          if (!are_near(tried, reference))
            continue;
          best    = fewer;
          on_mesh = tried;
          break;
        }
        double min_cost     = on_mesh.cost;
        const Numerics mesh = best;
        const bool is_free  = examples_.front().parameters.time.integrator == "automatic";
        for (const char *name : {"radau 9", "radau 5"})
        {
          if (!is_free && mesh.integrator != name)
            continue;
          Numerics other   = mesh;
          other.integrator = name;
          // Differences may be small by chance.
          Runs looser;
          for (double tolerance = loosest_tolerance; tolerance > found_.relative_tolerance; tolerance *= next_tolerance)
          {
            const Runs tried = run(other, tolerance);
            if (are_near(tried, on_mesh) && are_near(looser, on_mesh))
            {
              if (looser.cost < min_cost)
              {
                best                      = other;
                min_cost                  = looser.cost;
                found_.relative_tolerance = tolerance / next_tolerance;
              }
              break;
            }
            if (tried.cost > 2. * min_cost && tried.finished)
              break;
            looser = tried;
          }
        }
        try_longer_first_step(on_mesh, min_cost);
      }

      void
      try_longer_first_step(const Runs &reference, const double cost)
      {
        if (examples_.front().parameters.time.initial_step)
          return;
        Numerics other = found_.choice.numerics;
        other.initial_step *= longer_first_step;
        const Runs tried = run(other, found_.relative_tolerance);
        if (tried.cost < cost && are_near(tried, reference))
          found_.choice.numerics = other;
      }

      const std::span<const Problem> examples_;
      double accuracy_ = std::numeric_limits<double>::infinity();
      SharedChoice found_;
    };
  } // namespace

  NumericsChoice
  SharedChoice::choice_for(const Scene &scene, const double size) const
  {
    NumericsChoice own     = choice;
    own.numerics.tolerance = std::max(relative_tolerance * size, mesh_choice::min_error * scene.body.length);
    // Stress events differ from scene to scene.
    own.numerics.step_limits =
      similar_step_limits(scene, choice.numerics.step_limits, choice.numerics.min_event / min_event);
    return own;
  }

  std::optional<SharedChoice>
  shared_choice(const std::span<const Problem> examples)
  {
    return Search(examples).find();
  }
} // namespace crawler
