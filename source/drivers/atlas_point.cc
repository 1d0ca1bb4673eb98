// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/drivers/atlas_point.h>
#include <crawler/drivers/compute.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>

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
      std::array<double, 2> m{};
      for (unsigned int i = 0; i <= n_times; ++i)
      {
        const double t = scene.end_time * i / n_times;
        ends->values(t, m);
        if (1. - std::max(m[0], m[1]) / scene.body.elastic_modulus < level)
          return t;
      }
      return std::numeric_limits<double>::infinity();
    }

    InversionFacts
    inversion_facts(const Scene &scene)
    {
      return {.end_time        = scene.end_time,
              .possible_inside = scene.body.friction_exponent() > -1.,
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
    with_formulation(const Parameters &parameters, const std::string &formulation)
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
      run.status         = result.time.status;
      run.reason         = result.time.reason;
      run.message        = result.time.message;
      run.promised_error = computed.choice.promised_error;
      run.min_stretch    = result.min_stretch.value;
      run.steps          = result.time.steps;
      run.is_log_stretch = computed.choice.numerics.formulation == FormulationChoice::log_stretch;
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

    /// One run. A whole scene or form that is inadmissible is "refused"; an error of the program itself is a failure.
    AtlasRun
    compute_run(const Parameters &parameters, const std::function<bool()> &interrupted)
    {
      using Clock      = std::chrono::steady_clock;
      const auto start = Clock::now();
      const auto age   = [start]()
      {
        return std::chrono::duration<double>(Clock::now() - start).count();
      };
      const double limit = parameters.atlas.time_limit;
      AtlasRun run;
      try
      {
        const Scene scene = parameters.create_scene();
        run               = summary_of(compute(parameters,
                                 scene,
                                 [&]()
                                 {
                                   return age() <= limit && !interrupted();
                                 }));
        if (run.status == "stopped" && run.reason.empty())
        {
          run.reason  = "time_limit";
          run.message = fmt::format("stopped after {:g} s", limit);
        }
      }
      catch (const InputError &error)
      {
        run = not_computed("refused", "inadmissible", error.what());
      }
      catch (const std::bad_alloc &)
      {
        run = not_computed("failed", "out_of_memory", "out of memory");
      }
      catch (const std::exception &error)
      {
        run = not_computed("failed", "exception", error.what());
      }
      run.seconds = age();
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
      for (const auto which : {P::automatic, P::position, P::log_stretch})
        point.runs[which].measured_error = std::abs(point.runs[which].displacement - reference.displacement);
      const bool is_own_check = same_run(point.runs[P::automatic], reference);
      if (is_own_check) // nothing is known of its error
        point.runs[P::automatic].measured_error = AtlasRun::unknown;
      if (point.runs[P::automatic].status != "refused" && !is_own_check)
        point.verdict =
          cross_check({claim_of(point, P::automatic), claim_of(point, P::position), claim_of(point, P::log_stretch)},
                      claim_of(point, P::refined),
                      inversion_facts(parameters.create_scene()));
      point.outcome = outcome_of(point);
    }
  } // namespace

  std::optional<AtlasPoint>
  compute_point(const Parameters &parameters, const std::function<bool()> &interrupted)
  {
    AtlasPoint point;
    const auto add = [&](const AtlasPoint::Run which, const Parameters &own)
    {
      if (!interrupted())
        point.runs[which] = compute_run(own, interrupted);
    };
    add(AtlasPoint::automatic, parameters);
    if (parameters.discretization.formulation == "automatic")
    {
      add(AtlasPoint::position, with_formulation(parameters, "position"));
      // The log-stretch form is for a < 0 (doc/numerics.md).
      if (point.runs[AtlasPoint::automatic].is_log_stretch) // the automatic choice was this very run
        point.runs[AtlasPoint::log_stretch] = point.runs[AtlasPoint::automatic];
      else if (parameters.body.friction_exponent() < 0.)
        add(AtlasPoint::log_stretch, with_formulation(parameters, "log stretch"));
    }
    // Where the choice of mesh and steps does not depend on it, Accuracy is divided once more: a run is no check of
    // itself.
    Parameters refined = parameters;
    for (int i = 0; i < 2; ++i)
    {
      refined = refined_parameters(refined);
      add(AtlasPoint::refined, refined);
      if (!same_run(point.runs[AtlasPoint::automatic], point.runs[AtlasPoint::refined]))
        break;
    }
    if (interrupted())
      return std::nullopt;
    judge(point, parameters);
    return point;
  }
} // namespace crawler
