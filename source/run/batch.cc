// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/lanes/host_laws.h>
#include <crawler/run/batch.h>
#include <crawler/run/lane_extremes.h>
#include <crawler/run/lane_sampler.h>
#include <crawler/run/recorder.h>
#include <crawler/time/radau_tableau.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace crawler
{
  std::optional<LaneMethod>
  batch_method(const Scene &scene, const TimeParameters &time, const Numerics &numerics)
  {
    return numerics.formulation == Formulation::position && !scene.profiles.initial_stretch
             ? lane_method(scene, time, numerics)
             : std::nullopt;
  }

  namespace
  {
    /// Hands the runs of one method out to the lanes and makes results of their data.
    class Batch : private LaneHost
    {
    public:
      using Results = std::vector<std::optional<SimulationResult>>;

      Batch(const LaneMethod &method,
            const std::span<const BatchRun> runs,
            const std::vector<std::size_t> &members,
            const RecordOptions &options,
            const std::function<bool()> &keep_going,
            Results &results)
        : tables_(lane_tables(method))
        , tableau_(radau_tableau(method.n_stages))
        , runs_(runs)
        , members_(members)
        , options_(options)
        , keep_going_(keep_going)
        , results_(results)
        , sampler_(tables_->setup, Recorder::n_pieces)
      {
        look_inside = options.energy_balance;
      }

      /// Computes the runs; returns false if interrupted.
      bool
      compute(const LaneEngine &engine)
      {
        lanes_.resize(engine.lanes);
        LaneStorage memory(engine.memory(tables_->setup));
        engine.start(tables_->setup, *this, memory.data());
        while (engine.advance(tables_->setup, memory.data()))
          ;
        return !interrupted_;
      }

    private:
      struct Lane
      {
        std::size_t run         = 0;
        bool given_up           = false;
        double stretch_at_start = 1.; ///< smallest stretch of the ends
        Units units;
        TimeSegments segments;
        std::optional<Scene> scene; ///< in natural units, as all that follows
        std::pair<double, double> end_moduli;
        std::optional<HostLaws> laws;
        std::unique_ptr<FeedbackAtPoints> end_feedback; ///< feedback at the ends of the body, if there is one
        std::vector<double> output_times;               ///< ends of the segments, and those that the record needs
        std::vector<unsigned char> restarts;            ///< flags of those at which a new segment starts
        std::vector<StepLimit> limits;
        std::optional<Recorder> recorder;
        std::unique_ptr<ActiveStressAtPoints> stress; ///< stress at the quadrature points and the ends of the body
        std::optional<StressWatch> watch;
        std::vector<double> breaks; ///< breaks in space
        std::vector<double> m;
        std::vector<std::array<double, 2>> end_stress; ///< m at the ends, in the stages of the step that is tried
        std::size_t n_stress_calls = 0;
      };

      bool
      take(const unsigned int l, LaneJob &job) override
      {
        if (next_ == members_.size() || interrupted_)
          return false;
        lanes_[l]      = std::make_unique<Lane>();
        lanes_[l]->run = members_[next_++];
        start(*lanes_[l], job);
        return true;
      }

      void
      start(Lane &lane, LaneJob &job) const
      {
        const BatchRun &run = runs_[lane.run];
        lane.units          = natural_units(*run.scene);
        lane.segments       = TimeSegments(*run.scene->active_stress, run.scene->end_time);
        lane.scene.emplace(in_units(*run.scene, lane.units, &lane.segments));
        const Scene &scene      = *lane.scene;
        const Numerics numerics = in_units(*run.numerics, lane.units);
        lane.limits             = numerics.step_limits;
        start_record(lane, numerics.tolerance);
        std::vector<double> points = tables_->points;
        points.insert(points.end(), {0., 1.});
        lane.stress = scene.active_stress->at(points);
        lane.watch.emplace(*scene.active_stress, 1., numerics.min_event > 0. ? numerics.min_event : HUGE_VAL);
        lane.breaks = scene.breaks_in_space();
        lane.m.resize(points.size());
        lane.end_stress.resize(tableau_.n);
        lane.end_moduli = scene.end_moduli();
        if (!scene.is_plain())
          lane.laws.emplace(scene, tables_->points);
        if (const StretchFeedback *feedback = scene.active_stress->feedback())
          lane.end_feedback = feedback->at({0., 1.});
        job = {.body           = lane_body(scene, lane.laws ? &*lane.laws : nullptr),
               .tolerance      = numerics.tolerance,
               .initial_step   = numerics.initial_step,
               .limits         = lane.limits.data(),
               .n_limits       = static_cast<unsigned int>(lane.limits.size()),
               .max_steps      = run.time->max_steps,
               .least_stretch  = small_stretch,
               .start_time     = 0.,
               .start          = nullptr,
               .output_times   = lane.output_times.data(),
               .n_output_times = static_cast<unsigned int>(lane.output_times.size()),
               .restarts       = lane.restarts.data()};
      }

      bool
      laws(const unsigned int l, const LanePoints &points) override
      {
        return lanes_[l]->laws->evaluate(points);
      }

      /// Starts the record of a run from rest.
      void
      start_record(Lane &lane, const double tolerance) const
      {
        RecordOptions options = options_;
        const BatchRun &run   = runs_[lane.run];
        if (run.cycles)
          options.cycles = run.cycles;
        lane.recorder.emplace(*run.scene, lane.units, options, tolerance, /*may_search=*/false);
        lane.recorder->set_smallest_cell(tables_->smallest_size());
        lane.output_times = lane.segments.breaks();
        lane.output_times.push_back(1.);
        lane.restarts.assign(lane.output_times.size(), 1);
        lane.restarts.back() = 0;
        for (const double time : lane.recorder->step_ends())
        {
          const auto place = std::lower_bound(lane.output_times.begin(), lane.output_times.end(), time - 1e-12);
          if (*place > time + 1e-12)
          {
            lane.restarts.insert(lane.restarts.begin() + (place - lane.output_times.begin()), 0);
            lane.output_times.insert(place, time);
          }
        }
        lane.recorder->see_stretch({}, {});
        static const std::vector<double> rest(Recorder::n_pieces + 1, 0.);
        lane.recorder->see_step(0., false, 1., 1., [](double) { return Recorder::BodySample{rest, 0.}; });
      }

      /// Supplies m, asked for at the start of a run or segment, and then in all stages of each step that is tried.
      void
      stress(const unsigned int l, const double t, double *m) override
      {
        Lane &lane          = *lanes_[l];
        const std::size_t n = tables_->points.size(), stages = tableau_.n;
        lane.stress->values(t, lane.m);
        std::copy_n(lane.m.begin(), n, m);
        const std::array<double, 2> ends{{lane.m[n], lane.m[n + 1]}};
        if (lane.n_stress_calls == 0)
          lane.stretch_at_start = end_stretch(lane, ends);
        else
          lane.end_stress[(lane.n_stress_calls - 1) % stages] = ends;
        ++lane.n_stress_calls;
      }

      /// Smaller of the stretches that the end conditions prescribe, 1 - m/k.
      static double
      end_stretch(const Lane &lane, const std::array<double, 2> &m)
      {
        return 1. - std::max(m[0] / lane.end_moduli.first, m[1] / lane.end_moduli.second);
      }

      /// True if an end inverts (Simulation::end_inverts): a coarse mesh may not have followed it. The ends are
      /// examined in the stages and between them, by the watch.
      static bool
      end_inverts(const Lane &lane)
      {
        if (lane.scene->active_stress->feedback() != nullptr) // see Assembler::has_known_ends()
          return false;
        double smallest = lane.stretch_at_start;
        for (const auto &m : lane.end_stress)
          smallest = std::min(smallest, end_stretch(lane, m));
        if (!(smallest > 0.))
          return true;
        return std::ranges::any_of(lane.watch->inside(), [&](const StressWatch::Values &m) {
          return !(end_stretch(lane, {{m[0], m[1]}}) > 0.);
        });
      }

      bool
      accepted(const unsigned int l, const LaneStep &step) override
      {
        Lane &lane = *lanes_[l];
        if (!interrupted_ && keep_going_ && !keep_going_())
          interrupted_ = true;
        // A run that is stopped in its last step is finished to the engine.
        lane.given_up = interrupted_ || !look_at_step(lane, step);
        return !lane.given_up && !lane.recorder->cycles_repeat();
      }

      /// Examines a step; returns false if the run is for a Simulation.
      bool
      look_at_step(Lane &lane, const LaneStep &step)
      {
        if (!step.is_settled || !lane.watch->is_calm(step.time - step.size, step.time) || end_inverts(lane))
          return false;
        const unsigned int n = tableau_.n;
        for (unsigned int i = options_.energy_balance ? 0 : n - 1; i < n; ++i)
        {
          if (!(step.stages[i].min_stretch > small_stretch))
            return false;
          const auto [smallest, largest] = lane_extremes(*tables_,
                                                         step,
                                                         i,
                                                         lane.recorder->result.min_stretch.value,
                                                         lane.recorder->result.max_stretch.value,
                                                         lane.breaks);
          lane.recorder->see_stretch(smallest, largest);
          if (options_.energy_balance)
            add_rates(lane, step, i);
        }
        if (options_.energy_balance)
          lane.recorder->result.energy_balance->elastic_energy = step.elastic_energy;
        const auto sample    = [&](const double time) { return sampler_.sample(step, time); };
        const LaneStage &end = step.stages[n - 1];
        lane.recorder->see_step(step.time, step.is_output_time, end.min_stretch, end.max_stretch, sample);
        if (step.is_output_time && !lane.segments.is_last() && step.time == lane.segments.end())
        {
          lane.segments.go_on();
          lane.watch->restart();
          lane.recorder->interrupt();
          lane.n_stress_calls = 0;
        }
        return true;
      }

      void
      add_rates(Lane &lane, const LaneStep &step, const unsigned int i) const
      {
        const LaneStage &stage  = step.stages[i];
        std::array<double, 2> m = lane.end_stress[i];
        if (lane.end_feedback)
          lane.end_feedback->values(
            step.time - (1. - tableau_.c[i]) * step.size, {stage.end_stretch, stage.end_rate, {}, {}}, {m, {}, {}, {}});
        Rates works = rates_of(stage, m[1] * stage.right_velocity - m[0] * stage.left_velocity);
        for (double &work : works)
          work *= step.size * tableau_.b[i];
        lane.recorder->result.energy_balance->add_works(works);
        if (i + 1 == tableau_.n) // the velocity balances all forces there
          lane.recorder->see_friction(step.size, stage.abs_friction, std::abs(stage.net_friction));
      }

      void
      done(const unsigned int l, const LaneOutcome &outcome) override
      {
        Lane &lane = *lanes_[l];
        if ((outcome.status == LaneOutcome::finished || lane.recorder->cycles_repeat()) && !lane.given_up)
          results_[lane.run] = result_of(lane, outcome);
      }

      SimulationResult
      result_of(Lane &lane, const LaneOutcome &outcome) const
      {
        SimulationResult &result      = lane.recorder->result;
        result.time.status            = Status::finished;
        result.time.step_size         = outcome.progress->next;
        result.time.steps             = outcome.progress->steps;
        result.time.rejected_steps    = outcome.progress->rejected;
        result.time.newton_iterations = outcome.progress->newton;
        result.displacement           = outcome.displacement;
        const unsigned int n_cells = tables_->setup.n_cells, degree = tables_->setup.degree;
        result.mesh = {.n_cells = n_cells, .degree = degree, .n_unknowns = n_cells * degree + 1, .most_cells = n_cells};
        result.integrator = runs_[lane.run].time->integrator == "automatic" ? runs_[lane.run].numerics->integrator
                                                                            : runs_[lane.run].time->integrator;
        result.engine     = "fused";
        return lane.recorder->finish();
      }

      const std::shared_ptr<const LaneTables> tables_;
      const RadauTableau &tableau_;
      const std::span<const BatchRun> runs_;
      const std::vector<std::size_t> &members_; ///< numbers of the runs
      const RecordOptions options_;
      const std::function<bool()> &keep_going_;
      Results &results_;
      LaneSampler sampler_;
      std::vector<std::unique_ptr<Lane>> lanes_;
      std::size_t next_ = 0;
      bool interrupted_ = false;
    };
  } // namespace

  std::vector<std::optional<SimulationResult>>
  run_batch(const std::span<const BatchRun> runs,
            const RecordOptions &options,
            const std::function<bool()> &keep_going,
            const LaneEngine &engine)
  {
    std::map<LaneMethod, std::vector<std::size_t>> members;
    for (std::size_t i = 0; i < runs.size(); ++i)
      members[batch_method(*runs[i].scene, *runs[i].time, *runs[i].numerics).value()].push_back(i);
    std::vector<std::optional<SimulationResult>> results(runs.size());
    for (const auto &[method, own] : members)
      if (!Batch(method, runs, own, options, keep_going, results).compute(engine))
        break;
    return results;
  }
} // namespace crawler
