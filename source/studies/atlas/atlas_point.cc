// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/run_as_promised.h>
#include <crawler/base/exceptions.h>
#include <crawler/studies/atlas/atlas_point.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/core/crash_file.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// A stretch this close to 0 is not called positive or negative before the run.
    constexpr double clear_stretch = 1e-3;

    /// The first time at which the stretch of an end, 1 - m/k, is below @p level.
    double
    end_below(const Scene &scene, const double level)
    {
      constexpr unsigned int n_times = 10000;
      const auto ends                = scene.active_stress->at({0., scene.body.length});
      const auto [left, right]       = scene.end_moduli();
      std::array<double, 2> m{};
      for (unsigned int i = 0; i <= n_times; ++i)
      {
        const double t = scene.end_time * i / n_times;
        ends->values(t, m);
        if (std::min(1. - m[0] / left, 1. - m[1] / right) < level)
          return t;
      }
      return std::numeric_limits<double>::infinity();
    }

    InversionFacts
    inversion_facts(const Scene &scene)
    {
      return {.end_time        = scene.end_time,
              .possible_inside = scene.friction_exponent() > -1.,
              .earliest_at_end = end_below(scene, clear_stretch),
              .latest_at_end   = end_below(scene, -clear_stretch)};
    }

    /// Mesh and time steps chosen by the program, for a smaller Accuracy; the formulation is that of the user.
    Parameters
    refined_parameters(const Parameters &parameters)
    {
      Parameters refined                 = parameters;
      refined.accuracy                   = std::max(1e-12, parameters.accuracy / parameters.atlas.refinement);
      refined.discretization             = {};
      refined.discretization.formulation = parameters.discretization.formulation;
      refined.time                       = {};
      refined.time.end_time              = parameters.time.end_time;
      refined.time.max_steps             = parameters.time.max_steps;
      return refined;
    }

    Parameters
    with_formulation(const Parameters &parameters, const FormulationEntry formulation)
    {
      Parameters result                 = parameters;
      result.discretization.formulation = formulation;
      return result;
    }

    AtlasRun
    summary_of(const Computed &computed)
    {
      const SimulationResult &result = computed.result;
      AtlasRun run;
      run.status         = word_of(result.time.status);
      run.reason         = result.time.reason;
      run.message        = result.time.message;
      run.promised_error = computed.choice.promised_error; // not a number if nothing is promised
      if (result.error && run.promised_error < result.error->total)
        run.promised_error = result.error->total;
      // An answer with a large error is an answer: what it claims is that error.
      if (run.reason == accuracy_not_met && std::isfinite(run.promised_error))
      {
        run.status = "finished";
        run.reason.clear();
        run.message.clear();
      }
      run.min_stretch = result.min_stretch.value;
      run.steps       = result.time.steps;
      run.is_stretch  = computed.choice.numerics.formulation == Formulation::stretch;
      if (run.status == "finished")
        run.displacement = result.displacement;
      if (result.inversion)
      {
        run.inversion_s = result.inversion->s;
        run.inversion_t = result.inversion->t;
      }
      return run;
    }

    AtlasRun
    not_computed(const std::string &status, const std::string &reason, const std::string &message)
    {
      AtlasRun run;
      run.status  = status;
      run.reason  = reason;
      run.message = message;
      return run;
    }

    /// What came of a task. A whole scene or form that is inadmissible is "refused"; an error of the program itself is
    /// a failure.
    AtlasRun
    run_of(const Task &task)
    {
      AtlasRun run;
      try
      {
        if (task.error)
          std::rethrow_exception(task.error);
        run = summary_of(task.computed);
        if (run.status == "stopped" && run.reason.empty() && task.is_out_of_time)
        {
          run.reason  = "time_limit";
          run.message = fmt::format("stopped after {:g} s", task.parameters.atlas.time_limit);
        }
      }
      catch (const InputError &error)
      {
        run = not_computed("refused", "inadmissible", error.what());
      }
      catch (const FileError &error)
      {
        run = not_computed("failed", "exception", error.what());
      }
      run.seconds = task.seconds;
      return run;
    }

    Claim
    claim_of(const AtlasPoint &point, const AtlasPoint::Run which)
    {
      const AtlasRun &run = point.runs[which];
      return {AtlasPoint::run_names[which], run.status, run.displacement, run.promised_error, run.inversion_t};
    }

    bool
    same_run(const AtlasRun &a, const AtlasRun &b)
    {
      return a.status == "finished" && b.status == "finished" && a.displacement == b.displacement && a.steps == b.steps;
    }

    /// The name that a point has in the picture: that of the answer of `crawler run`, unless something is wrong.
    std::string
    outcome_of(const AtlasPoint &point)
    {
      const AtlasRun &run = point.runs[AtlasPoint::automatic];
      if (point.verdict.kind == Verdict::silent_wrong_answer)
        return point.verdict.in_words();
      if (run.status == "inverted")
        return run.reason == "inverted_at_end" ? "inverted at end" : "inverted inside";
      if (run.status == "failed" || run.status == "stopped")
        return run.status + ": " + run.reason;
      return run.status;
    }

    void
    judge(AtlasPoint &point, const Parameters &parameters)
    {
      using P               = AtlasPoint;
      const auto &reference = point.runs[P::refined];
      for (const auto which : {P::automatic, P::position, P::stretch})
        point.runs[which].measured_error = std::abs(point.runs[which].displacement - reference.displacement);
      const bool is_own_check = same_run(point.runs[P::automatic], reference);
      if (is_own_check) // nothing is known of its error
        point.runs[P::automatic].measured_error = AtlasRun::unknown;
      if (point.runs[P::automatic].status != "refused" && !is_own_check)
        point.verdict =
          cross_check({claim_of(point, P::automatic), claim_of(point, P::position), claim_of(point, P::stretch)},
                      claim_of(point, P::refined),
                      inversion_facts(parameters.create_scene()));
      point.outcome = outcome_of(point);
    }
  } // namespace

  namespace
  {
    /// The runs of one kind at those points for which @p own gives parameters.
    void
    add_runs(std::vector<AtlasPoint> &points,
             const AtlasPoint::Run which,
             const std::function<std::optional<Parameters>(std::size_t)> &own,
             const std::function<bool()> &interrupted)
    {
      std::vector<Task> tasks;
      std::vector<std::size_t> numbers;
      for (std::size_t i = 0; i < points.size() && !interrupted(); ++i)
        if (const auto parameters = own(i))
        {
          tasks.emplace_back().parameters = *parameters;
          numbers.push_back(i);
        }
      if (tasks.empty())
        return;
      compute_all(tasks, tasks[0].parameters.atlas.time_limit, interrupted);
      for (std::size_t i = 0; i < tasks.size(); ++i)
        points[numbers[i]].runs[which] = run_of(tasks[i]);
    }
  } // namespace

  AtlasPoint
  crashed_point()
  {
    AtlasPoint point;
    point.runs[AtlasPoint::automatic].status  = "failed";
    point.runs[AtlasPoint::automatic].reason  = "crashed";
    point.runs[AtlasPoint::automatic].message = crash_message;
    point.outcome                             = outcome_of(point);
    return point;
  }

  std::optional<std::vector<AtlasPoint>>
  compute_points(const std::vector<Parameters> &parameters, const std::function<bool()> &interrupted)
  {
    std::vector<AtlasPoint> points(parameters.size());
    const auto add = [&](const AtlasPoint::Run which,
                         const std::function<std::optional<Parameters>(std::size_t)> &own) {
      add_runs(points, which, own, interrupted);
    };
    const auto both_forms = [&](const std::size_t i) {
      return parameters[i].discretization.formulation == FormulationEntry::automatic;
    };
    add(AtlasPoint::automatic, [&](const std::size_t i) { return parameters[i]; });
    add(AtlasPoint::position, [&](const std::size_t i) -> std::optional<Parameters> {
      if (!both_forms(i))
        return std::nullopt;
      return with_formulation(parameters[i], FormulationEntry::position);
    });
    add(AtlasPoint::stretch, [&](const std::size_t i) -> std::optional<Parameters> {
      // For a >= 0 its inversions are located less well than those of the position form.
      if (!both_forms(i) || points[i].runs[AtlasPoint::automatic].is_stretch ||
          parameters[i].body.friction_exponent() >= 0.)
        return std::nullopt;
      return with_formulation(parameters[i], FormulationEntry::stretch);
    });
    for (std::size_t i = 0; i < points.size(); ++i)
      if (both_forms(i) && points[i].runs[AtlasPoint::automatic].is_stretch) // the automatic choice was this very run
        points[i].runs[AtlasPoint::stretch] = points[i].runs[AtlasPoint::automatic];
    // Where the choice of mesh and steps does not depend on it, Accuracy is divided once more: a run is no check of
    // itself.
    std::vector<Parameters> refined = parameters;
    for (int round = 0; round < 2; ++round)
      add(AtlasPoint::refined, [&](const std::size_t i) -> std::optional<Parameters> {
        if (round > 0 && !same_run(points[i].runs[AtlasPoint::automatic], points[i].runs[AtlasPoint::refined]))
          return std::nullopt;
        refined[i] = refined_parameters(refined[i]);
        return refined[i];
      });
    if (interrupted())
      return std::nullopt;
    for (std::size_t i = 0; i < points.size(); ++i)
      judge(points[i], parameters[i]);
    return points;
  }
} // namespace crawler
