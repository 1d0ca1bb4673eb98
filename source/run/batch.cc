// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/general_laws.h>
#include <crawler/lanes/host_laws.h>
#include <crawler/lanes/lane_stepper.h>
#include <crawler/run/batch.h>
#include <crawler/run/lane_extremes.h>
#include <crawler/run/lane_sampler.h>
#include <crawler/run/recorder.h>

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
    /// Watch over the ends of a body in a lane, where the end conditions prescribe the stretch 1 - m/k: there a coarse
    /// mesh may not follow an inversion (Simulation::end_inverts).
    class EndWatch
    {
    public:
      /// Stress m at both ends.
      using Stress = std::array<double, 2>;

      EndWatch(const Scene &scene, const double min_event, const unsigned int n_stages)
        : ends_(scene)
        , watch_(*scene.active_stress, min_event > 0. ? min_event : HUGE_VAL)
        , in_stages_(n_stages)
      {
        if (const StretchFeedback *feedback = scene.active_stress->feedback())
          feedback_ = feedback->at({0., 1.});
      }

      /// Restarts after a jump of the active stress.
      void
      restart()
      {
        watch_.restart();
        n_seen_ = 0;
      }

      /// Observes the stress at the start of a run or segment, and then in all stages of each step that is tried.
      void
      see_stress(const Stress &m)
      {
        if (n_seen_ == 0)
          stretch_at_start_ = stretch(m);
        else
          in_stages_[(n_seen_ - 1) % in_stages_.size()] = m;
        ++n_seen_;
      }

      /// True if the step was calm, and no end inverted in its stages or at the times between them.
      bool
      is_good(const LaneStep &step)
      {
        if (!watch_.is_calm(step.time - step.size, step.time))
          return false;
        if (feedback_) // at the times of Simulation::end_inverts
          return !ends_.are_known() ||
                 std::ranges::all_of(std::array<double, 4>{{0.75, 0.5, 0.25, 0.}}, [&](const double part) {
                   return ends_.smallest(step.time - part * step.size) > 0.;
                 });
        double smallest = stretch_at_start_;
        for (const Stress &m : in_stages_)
          smallest = std::min(smallest, stretch(m));
        return smallest > 0. && std::ranges::all_of(watch_.inside(), [this](const StressWatch::Values &m) {
                 return stretch({{m[0], m[1]}}) > 0.;
               });
      }

      /// Power that leaves through the ends in stage @p i, at the time @p t.
      double
      power(const unsigned int i, const double t, const LaneStage &stage) const
      {
        Stress m = in_stages_[i];
        if (feedback_)
          feedback_->values(t, {stage.end_stretch, stage.end_rate, {}, {}}, {m, {}, {}, {}});
        return m[1] * stage.right_velocity - m[0] * stage.left_velocity;
      }

    private:
      /// Smaller of the stretches at the ends.
      double
      stretch(const Stress &m) const
      {
        return 1. - std::max(m[0] / ends_.moduli()[0], m[1] / ends_.moduli()[1]);
      }

      EndStretches ends_;
      StressWatch watch_;
      std::unique_ptr<FeedbackAtPoints> feedback_; ///< feedback at the ends, if there is one
      double stretch_at_start_ = 1.;
      std::vector<Stress> in_stages_; ///< of the step that is tried
      std::size_t n_seen_ = 0;
    };

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
        m_.resize(tables_->points.size() + 2);
        LaneStorage memory(engine.memory(tables_->setup));
        engine.start(tables_->setup, *this, memory.data());
        while (engine.advance(tables_->setup, memory.data()))
          ;
        return !interrupted_;
      }

    private:
      struct Lane
      {
        std::size_t run = 0;
        bool given_up   = false;
        TimeSegments segments;
        std::optional<Scene> scene; ///< in natural units, as all that follows
        std::vector<double> breaks; ///< breaks in space
        std::optional<HostLaws> laws;
        std::vector<double> output_times;    ///< ends of the segments, and those that the record needs
        std::vector<unsigned char> restarts; ///< flags of those at which a new segment starts
        std::vector<StepLimit> limits;
        std::optional<Recorder> recorder;
        std::unique_ptr<ActiveStressAtPoints> stress; ///< stress at the quadrature points and the ends of the body
        std::optional<EndWatch> ends;
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
        const BatchRun &run     = runs_[lane.run];
        const Units units       = natural_units(*run.scene);
        lane.segments           = TimeSegments(*run.scene->active_stress, run.scene->end_time);
        const Scene &scene      = lane.scene.emplace(in_units(*run.scene, units, &lane.segments));
        const Numerics numerics = in_units(*run.numerics, units);
        lane.limits             = numerics.step_limits;
        start_record(lane, units, numerics.tolerance);
        std::vector<double> points = tables_->points;
        points.insert(points.end(), {0., 1.});
        lane.stress = scene.active_stress->at(points);
        lane.ends.emplace(scene, numerics.min_event, tables_->setup.n_stages);
        lane.breaks = scene.breaks_in_space();
        if (!scene.is_plain())
          lane.laws.emplace(scene, tables_->points);
        job = {.body           = lane_body(scene, lane.laws ? &*lane.laws : nullptr),
               .tolerance      = numerics.tolerance,
               .initial_step   = numerics.initial_step,
               .limits         = lane.limits.data(),
               .n_limits       = static_cast<unsigned int>(lane.limits.size()),
               .max_steps      = run.time->max_steps,
               .least_stretch  = small_stretch,
               .progress       = {.next = numerics.initial_step},
               .output_times   = lane.output_times.data(),
               .n_output_times = static_cast<unsigned int>(lane.output_times.size()),
               .restarts       = lane.restarts.data()};
      }

      /// Starts the record of a run from rest.
      void
      start_record(Lane &lane, const Units &units, const double tolerance) const
      {
        RecordOptions options = options_;
        const BatchRun &run   = runs_[lane.run];
        if (run.cycles)
          options.cycles = run.cycles;
        lane.recorder.emplace(*run.scene, units, options, tolerance, /*may_search=*/false);
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
        const std::size_t n = tables_->points.size();
        lane.stress->values(t, m_);
        std::copy_n(m_.begin(), n, m);
        lane.ends->see_stress({{m_[n], m_[n + 1]}});
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
        if (!step.is_settled || !lane.ends->is_good(step))
          return false;
        const unsigned int n = tables_->setup.n_stages;
        const LaneStage &end = step.stages[n - 1];
        for (unsigned int i = options_.energy_balance ? 0 : n - 1; i < n; ++i)
        {
          if (!(step.stages[i].min_stretch > small_stretch))
            return false;
          const auto [smallest, largest] = lane_extremes(*tables_, step, i, lane.recorder->result, lane.breaks);
          lane.recorder->see_stretch(smallest, largest);
          if (options_.energy_balance)
            add_rates(lane, step, i);
        }
        const auto sample = [&](const double time) { return sampler_.sample(step, time); };
        if (lane.recorder->see_step(step.time, step.is_output_time, end.min_stretch, end.max_stretch, sample) ||
            step.time == lane.output_times.back())
          lane.recorder->result.displacement = sample(step.time).displacement;
        if (step.is_output_time && !lane.segments.is_last() && step.time == lane.segments.end())
        {
          lane.segments.go_on();
          lane.ends->restart();
          lane.recorder->interrupt();
        }
        return true;
      }

      void
      add_rates(Lane &lane, const LaneStep &step, const unsigned int i) const
      {
        const LaneTableau &method = tables_->setup.method;
        const LaneStage &stage    = step.stages[i];
        const double t            = step.time - (1. - method.c[i]) * step.size;
        Rates works               = rates_of(stage, lane.ends->power(i, t, stage));
        for (double &work : works)
          work *= step.size * method.b[i];
        if (i + 1 == tables_->setup.n_stages) // the velocity balances all forces there
          lane.recorder->see_works(step.size, works, stage);
        else
          lane.recorder->result.energy_balance->add_works(works);
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
        SimulationResult &result   = lane.recorder->result;
        result.time                = outcome_at(*outcome.progress);
        result.time.status         = Status::finished;
        const unsigned int n_cells = tables_->setup.n_cells, degree = tables_->setup.degree;
        result.process.mesh = {
          .n_cells = n_cells, .degree = degree, .n_unknowns = n_cells * degree + 1, .most_cells = n_cells};
        result.process.integrator = integrator_of(*runs_[lane.run].time, *runs_[lane.run].numerics);
        result.process.engine     = "fused";
        return lane.recorder->finish();
      }

      const std::shared_ptr<const LaneTables> tables_;
      const std::span<const BatchRun> runs_;
      const std::vector<std::size_t> &members_; ///< numbers of the runs
      const RecordOptions options_;
      const std::function<bool()> &keep_going_;
      Results &results_;
      LaneSampler sampler_;
      std::vector<std::unique_ptr<Lane>> lanes_;
      std::vector<double> m_; ///< stress at the points and the ends of one body
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
