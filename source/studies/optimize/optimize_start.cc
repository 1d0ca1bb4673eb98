// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/model_choice.h>
#include <crawler/base/clock.h>
#include <crawler/base/exceptions.h>
#include <crawler/studies/optimize/optimize_start.h>
#include <crawler/studies/optimize/rol_optimizer.h>
#include <crawler/studies/optimize/scene_family.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace crawler
{
  namespace
  {
    /// Limit of a quantity at many places, and its extreme, also between the places that the optimiser uses.
    struct LimitedExtreme
    {
      std::optional<double> OptimizeParameters::*limit;
      double value;

      /// Excess over the wanted limit, relative to it.
      double
      excess(const OptimizeParameters &wanted) const
      {
        const double own = *(wanted.*limit);
        return own != 0. && value * own > 0. ? std::abs(value / own) - 1. : 0.;
      }
    };

    std::vector<LimitedExtreme>
    limited_extremes(const OptimizeParameters &wanted, GaitModel &model, const std::vector<double> &x)
    {
      std::vector<LimitedExtreme> list;
      const auto add = [&](std::optional<double> OptimizeParameters::*limit, const double value) {
        if (wanted.*limit)
          list.push_back({limit, value});
      };
      if (wanted.smallest_strain || wanted.largest_strain)
      {
        const auto [smallest, largest] = model.extreme_strains(x);
        add(&OptimizeParameters::smallest_strain, smallest);
        add(&OptimizeParameters::largest_strain, largest);
      }
      if (wanted.largest_stress)
        add(&OptimizeParameters::largest_stress, model.family.largest_stress(x, /*rate=*/false));
      if (wanted.largest_stress_rate)
        add(&OptimizeParameters::largest_stress_rate, model.family.largest_stress(x, /*rate=*/true));
      return list;
    }

    /// Tightens limits that were exceeded by more than @p exact. Returns true if there was one.
    bool
    tighten(OptimizeParameters &parameters,
            const OptimizeParameters &wanted,
            const std::vector<LimitedExtreme> &extremes,
            const double exact)
    {
      constexpr double margin = 0.02, most = 0.5;
      bool is_closer = false;
      for (const LimitedExtreme &one : extremes)
        if (const double excess = one.excess(wanted); excess > exact)
        {
          double &limit = *(parameters.*one.limit);
          limit         = std::copysign(
            std::max(std::abs(limit) * (1. - margin * excess) / (1. + excess), most * std::abs(*(wanted.*one.limit))),
            limit);
          is_closer = true;
        }
      return is_closer;
    }

    /// Rounds of one start. Each is an optimisation; the next one has better places for the limits.
    class Search
    {
    public:
      Search(SceneFamily &family,
             const StartName &start,
             const std::vector<double> &x,
             SearchState &state,
             const std::function<bool()> &stops)
        : family_(family)
        , state_(state)
        , stops_(stops)
        , wanted_(family.form.parameters.optimize)
        , parameters_(wanted_)
        , objective_(objective_of(wanted_))
        , start_(x)
        , x_(x)
      {
        static_cast<StartName &>(result_) = start;
      }

      StartResult
      make()
      {
        const double begin = now();
        try
        {
          go_on();
        }
        catch (const InputError &error) // no gait from this start
        {
          const bool may_invert  = !result_.records.empty() && !wanted_.smallest_strain;
          const StartResult none = without_gait(
            result_,
            x_,
            error.what() + std::string(may_invert ? "; Optimize/Smallest strain keeps gaits away from inversion" : ""));
          result_.best = none.best;
          result_.records.push_back(none.best);
          result_.has_converged = false;
          result_.message       = none.message;
        }
        catch (const GaitModel::Interrupted &)
        {
          result_.was_interrupted = true;
          result_.has_converged   = false;
          result_.message         = "stopped";
        }
        judge();
        result_.seconds = now() - begin;
        return std::move(result_);
      }

    private:
      void
      go_on()
      {
        constexpr unsigned int max_rounds = 12;
        constexpr double above_noise = 10., promised = 1e-5;
        const auto model  = make_gait_model(family_, x_, stops_);
        wanted_.tolerance = std::max(wanted_.tolerance, above_noise * model->noise());
        parameters_       = wanted_;
        bool is_rough     = model->noise() == 0.; // with simulations all is known after the first round
        bool is_fine      = false;
        for (unsigned int round = 0; round < max_rounds; ++round)
        {
          improve(*model, is_rough);
          if (round == 0 && result_.has_converged && !moves() && result_.records.front().violation > 0.)
          {
            x_ = as_near_as_limits_admit(*model);
            multipliers_.clear();
            improve(*model, is_rough);
          }
          if (!result_.best.problem.empty())
            return;
          x_      = result_.best.x;
          is_fine = !model->refine(x_);
          if (!is_fine) // limits at new places
          {
            parameters_ = wanted_;
            comparable_ = result_.records.size();
            if (!model->evaluate(x_, /*with_gradients=*/false).problem.empty()) // problem between the former places
            {
              x_ = start_;
              multipliers_.clear();
            }
          }
          if (is_fine && !is_rough && !result_.is_admissible())
            return; // tighter limits would not help
          if (is_fine && !is_rough)
          {
            const auto extremes = limited_extremes(wanted_, *model, x_);
            if (!tighten(parameters_, wanted_, extremes, std::min(promised, result_.admissible)))
            {
              for (const LimitedExtreme &one : extremes)
                result_.best.violation = std::max(result_.best.violation, one.excess(wanted_));
              return;
            }
          }
          is_rough = is_rough && !is_fine;
        }
        result_.has_converged = false;
        result_.message = is_fine ? "strain or stress exceed their limits between the points where they are checked"
                                  : "the grid had to be refined again and again";
      }

      /// Optimises from x on; @p is_rough: the grid may be too coarse, so that a rough optimum is enough.
      void
      improve(GaitModel &model, const bool is_rough)
      {
        constexpr double roughly = 1e-3, max_unused = 0.01;
        const auto stops = [&](const GaitProblem &so_far) {
          see(so_far);
          return stops_();
        };
        GaitProblem problem(model, wanted_, x_, stops, &parameters_);
        const auto keep = [&](const GaitRecord *const optimum) {
          result_.records.insert(result_.records.end(), problem.records().begin(), problem.records().end());
          result_.best =
            optimum != nullptr
              ? *optimum
              : GaitProblem::best_of(std::span(result_.records).subspan(comparable_), objective_, problem.admissible());
        };
        if (multipliers_.size() != problem.lower().size())
          multipliers_.clear();
        for (double &one : multipliers_)
          one *= scale_ / problem.scale();
        const double tolerance = parameters_.tolerance;
        result_.admissible     = problem.admissible();
        try
        {
          const OptimizerEnd end   = minimise(problem,
                                            problem.to_y(x_),
                                            multipliers_,
                                            is_rough ? std::max(roughly, tolerance) : tolerance,
                                            parameters_.max_iterations);
          multipliers_             = end.multipliers;
          scale_                   = problem.scale();
          const std::string at_end = end.has_converged ? problem.at(end.y, /*with_gradients=*/true).problem : "";
          result_.has_converged    = end.has_converged && at_end.empty();
          result_.message = at_end.empty() ? end.message : "the gait it ended at has no derivatives, " + at_end;
          keep(result_.has_converged ? &problem.record(end.y) : nullptr);
          if (result_.has_converged && problem.unused_limits(end.y, end.multipliers) > max_unused)
          {
            result_.has_converged = false;
            result_.message = "a limit that holds the gait back is not reached, so better ones are near; a smaller "
                              "Tolerance, with an Accuracy of a tenth of it, is needed";
          }
          result_.iterations += end.iterations;
          result_.limits = problem.limits(end.multipliers);
        }
        catch (const GaitModel::Interrupted &)
        {
          if (!problem.records().empty())
            keep(nullptr);
          throw;
        }
      }

      bool
      moves() const
      {
        constexpr double min_motion = 1e-12;
        return objective_.turned(result_.best.objective) > min_motion;
      }

      /// Finds the point nearest to the start that the limits admit, between the start and the result. A start far
      /// beyond the limits may end at a point without motion, where all derivatives vanish.
      std::vector<double>
      as_near_as_limits_admit(GaitModel &model)
      {
        constexpr unsigned int n_bisections = 12;
        GaitProblem problem(model, wanted_, start_, [&](const GaitProblem &) { return stops_(); });
        const auto at = [&, end = result_.best.x](const double part) {
          std::vector<double> x(end.size());
          for (std::size_t i = 0; i < x.size(); ++i)
            x[i] = std::lerp(end[i], start_[i], part);
          return x;
        };
        double admitted = 0., beyond = 1.;
        for (unsigned int i = 0; i < n_bisections; ++i)
        {
          const double part        = 0.5 * (admitted + beyond);
          const GaitRecord &record = problem.record(problem.to_y(at(part)));
          (record.problem.empty() && record.violation <= 0. ? admitted : beyond) = part;
        }
        result_.records.insert(result_.records.end(), problem.records().begin(), problem.records().end());
        return at(admitted);
      }

      void
      see(const GaitProblem &problem)
      {
        state_.evaluations = result_.records.size() + problem.records().size();
        if (!problem.records().empty())
          state_.best = GaitProblem::best_of(problem.records(), objective_, problem.admissible()).objective;
      }

      bool
      is_unforced() const
      {
        const Scene scene = family_.parameters(result_.best.x).create_scene();
        return scene.is_plain() && scene.body.friction_exponent() == 0.;
      }

      /// Decides whether the result is an optimum, and sets the multipliers of the limits.
      void
      judge()
      {
        if (result_.has_converged && !moves())
        {
          result_.has_converged = false;
          result_.message =
            is_unforced()
              ? "friction does not depend on the stretch here (Anchoring exponent 1), so that no gait moves the body"
              : "the gait that was found does not move the body in the wanted direction; another start is needed";
        }
        constexpr double far = 10.;
        if (!result_.has_converged && !result_.records.empty() && result_.records.front().violation > far)
          result_.message +=
            fmt::format("; the start exceeds a limit by a factor of {:.2g}, and one nearer to it is needed",
                        1. + result_.records.front().violation);
        for (GaitLimit &limit : result_.limits)
        {
          if (!result_.is_admissible()) // multipliers are meaningless then
            limit.multiplier = NAN;
          if (objective_.is_inverse) // the multiplier is that of D/W
            limit.multiplier *= -result_.best.objective * result_.best.objective;
        }
      }

      SceneFamily &family_;
      SearchState &state_;
      const std::function<bool()> &stops_;
      OptimizeParameters wanted_;
      OptimizeParameters parameters_; ///< with limits that may be tightened
      const GaitObjective objective_;
      const std::vector<double> start_;
      std::vector<double> x_, multipliers_;
      double scale_           = 1.; ///< scale of the objective, for the multipliers
      std::size_t comparable_ = 0;  ///< first record with the present places of the limits
      StartResult result_;
    };
  } // namespace

  StartResult
  without_gait(const StartName &start, const std::vector<double> &x, const std::string &problem)
  {
    StartResult result;
    static_cast<StartName &>(result) = start;
    result.best                      = {x, NAN, {}, NAN, problem};
    result.message                   = "no gait";
    result.records                   = {result.best};
    return result;
  }

  std::unique_ptr<GaitModel>
  make_gait_model(SceneFamily &family, const std::vector<double> &start, const std::function<bool()> &stops)
  {
    const Parameters parameters = family.parameters(start);
    const ModelChoice model     = choose_model(parameters, parameters.create_scene());
    if (model.model == Model::perturbation)
      throw InputError("the perturbation level gives the leading order only, which has no best gait; kinematic, "
                       "nonlinear or linear is expected",
                       "Model");
    if (model.model == Model::kinematic)
      return kinematic_gait(family, start);
    return simulated_gait(family, stops);
  }

  StartResult
  search(SceneFamily &family,
         const StartName &start,
         const std::vector<double> &x,
         SearchState &state,
         const std::function<bool()> &stops)
  {
    state = {};
    return Search(family, start, x, state, stops).make();
  }
} // namespace crawler
