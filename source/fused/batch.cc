// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/fused/batch.h>
#include <crawler/time/radau_tableau.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <new>

namespace crawler
{
  namespace
  {
    std::vector<double>
    interleaved(const std::vector<std::complex<double>> &values)
    {
      std::vector<double> result;
      for (const auto &value : values)
      {
        result.push_back(value.real());
        result.push_back(value.imag());
      }
      return result;
    }
  } // namespace

  FusedTables::FusedTables(const FusedMethod &method)
    : method_(method)
    , element_(method.degree)
    , sample_places_(element_.points)
  {
    sample_places_.insert(sample_places_.begin(), 0.);
    sample_places_.push_back(1.);
    samples_                    = interpolation_matrix(element_.nodes, sample_places_, 1);
    const RadauTableau &tableau = radau_tableau(method.n_stages);
    eigenvalues_                = interleaved(tableau.eigenvalues);
    vectors_                    = interleaved(tableau.vectors);
    rows_                       = interleaved(tableau.rows);
    for (unsigned int c = 0; c < method.n_cells; ++c)
      for (const double place : element_.points)
        points.push_back((c + place) / method.n_cells);
    setup = {method.degree,
             method.n_cells,
             method.n_stages,
             element_.values.data(),
             element_.derivatives.data(),
             element_.weights.data(),
             element_.stiffness.data(),
             static_cast<unsigned int>(sample_places_.size()),
             samples_.data(),
             tableau.c.data(),
             tableau.inverse.data(),
             tableau.error_weights.data(),
             tableau.real_eigenvalue,
             eigenvalues_.data(),
             vectors_.data(),
             rows_.data()};
  }

  double
  FusedTables::place_of_sample(const unsigned int number) const
  {
    return (number / setup.n_samples + sample_places_[number % setup.n_samples]) / method_.n_cells;
  }

  const FusedTables &
  fused_tables(const FusedMethod &method)
  {
    static std::map<FusedMethod, std::unique_ptr<FusedTables>> known;
    auto &tables = known[method];
    if (!tables)
      tables = std::make_unique<FusedTables>(method);
    return *tables;
  }

  void
  FusedMemoryFree::operator()(double *memory) const
  {
    std::free(memory);
  }

  FusedMemory
  fused_memory(const std::size_t n)
  {
    const std::size_t bytes = (n * sizeof(double) + 63) / 64 * 64;
    FusedMemory memory(static_cast<double *>(std::aligned_alloc(64, bytes)));
    if (!memory)
      throw std::bad_alloc();
    std::fill_n(memory.get(), bytes / sizeof(double), 0.);
    return memory;
  }

  bool
  fits_fused(const Scene &scene)
  {
    return dynamic_cast<const PowerFriction *>(scene.friction.get()) != nullptr;
  }

  namespace
  {
    /// Hands the runs out to the lanes and keeps what they give.
    class Batch
    {
    public:
      Batch(const FusedTables &tables, const std::span<const FusedRun> runs, const unsigned int lanes)
        : tables_(tables)
        , runs_(runs)
        , results_(runs.size())
        , lanes_(lanes)
      {
      }

      std::vector<FusedResult>
      compute(const LaneEngine &engine)
      {
        const LaneHost host = {this, next, stress, accepted, done};
        const auto memory   = fused_memory(engine.memory(tables_.setup));
        engine.run(tables_.setup, host, memory.get());
        return std::move(results_);
      }

    private:
      struct Lane
      {
        std::size_t run = 0;
        Units units;
        std::unique_ptr<ActiveStressAtPoints> stress;
      };

      static Batch &
      self(void *context)
      {
        return *static_cast<Batch *>(context);
      }

      static bool
      next(void *context, const unsigned int l, LaneJob &job)
      {
        static constexpr double end = 1.;
        Batch &batch                = self(context);
        if (batch.next_ == batch.runs_.size())
          return false;
        Lane &lane          = batch.lanes_[l];
        lane.run            = batch.next_++;
        const FusedRun &run = batch.runs_[lane.run];
        const Scene &scene  = *run.scene;
        lane.units          = natural_units(scene);
        std::vector<double> points(batch.tables_.points);
        for (double &s : points)
          s *= lane.units.length;
        lane.stress         = scene.active_stress->at(points);
        job                 = {.k             = scene.body.elastic_modulus / lane.units.force,
                               .a             = scene.body.friction_exponent(),
                               .tolerance     = run.tolerance / lane.units.length,
                               .initial_step  = run.initial_step / lane.units.time,
                               .largest_step  = run.largest_step / lane.units.time,
                               .most_steps    = run.most_steps,
                               .least_stretch = small_stretch,
                               .start_time    = 0.,
                               .start         = nullptr,
                               .frames        = &end,
                               .n_frames      = 1};
        FusedResult &result = batch.results_[lane.run];
        result              = {};
        result.min_stretch = result.max_stretch = 1.;
        return true;
      }

      static void
      stress(void *context, const unsigned int l, const double t, double *m)
      {
        Batch &batch        = self(context);
        Lane &lane          = batch.lanes_[l];
        const std::size_t n = batch.tables_.points.size();
        lane.stress->values(t * lane.units.time, {m, n});
        if (lane.units.force != 1.)
          for (std::size_t i = 0; i < n; ++i)
            m[i] /= lane.units.force;
      }

      static bool
      accepted(void *context, const unsigned int l, const LaneStep &step)
      {
        Batch &batch        = self(context);
        const Lane &lane    = batch.lanes_[l];
        FusedResult &result = batch.results_[lane.run];
        if (step.min_stretch < result.min_stretch)
        {
          result.min_stretch   = step.min_stretch;
          result.min_stretch_s = batch.tables_.place_of_sample(step.min_sample) * lane.units.length;
          result.min_stretch_t = step.time * lane.units.time;
        }
        if (step.max_stretch > result.max_stretch)
        {
          result.max_stretch   = step.max_stretch;
          result.max_stretch_s = batch.tables_.place_of_sample(step.max_sample) * lane.units.length;
          result.max_stretch_t = step.time * lane.units.time;
        }
        return true;
      }

      static void
      done(void *context, const unsigned int l, const LaneOutcome &outcome)
      {
        Batch &batch             = self(context);
        const Lane &lane         = batch.lanes_[l];
        FusedResult &result      = batch.results_[lane.run];
        result.finished          = outcome.status == LaneOutcome::finished;
        result.displacement      = outcome.displacement * lane.units.length;
        result.steps             = outcome.steps;
        result.rejected_steps    = outcome.rejected;
        result.newton_iterations = outcome.newton_iterations;
      }

      const FusedTables &tables_;
      const std::span<const FusedRun> runs_;
      std::vector<FusedResult> results_;
      std::vector<Lane> lanes_;
      std::size_t next_ = 0;
    };
  } // namespace

  std::vector<FusedResult>
  run_batch(const FusedMethod &method, const std::span<const FusedRun> runs, const LaneEngine &engine)
  {
    return Batch(fused_tables(method), runs, engine.lanes).compute(engine);
  }
} // namespace crawler
