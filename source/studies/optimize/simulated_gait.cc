// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/adjoint/break_map.h>
#include <crawler/adjoint/run_gradient.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/grid_samples.h>
#include <crawler/output/kymograph_writer.h>
#include <crawler/run/result_table.h>
#include <crawler/run/simulation.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/core/sensitivities.h>
#include <crawler/studies/optimize/extremes_in_boxes.h>
#include <crawler/studies/optimize/scene_family.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    double
    strides_of(const Scene &scene)
    {
      return scene.end_time / scene.active_stress->period().value_or(scene.end_time);
    }

    /// True if states between the steps can be observed with the numerics of the answer.
    bool
    has_pictures(const Task &task)
    {
      return task.computed.result.process.model != Model::kinematic && !task.computed.choice.has_fronts;
    }

    /**
     * Gaits of the levels that are simulated: answers of `crawler run` for the values of the variables, and derivatives
     * by the adjoint of a run with the same numerics (adjoint/run_gradient.h). Where there is no adjoint they are
     * differences of answers, which are computed together.
     */
    class SimulatedGait : public GaitModel
    {
    public:
      SimulatedGait(SceneFamily &its_family, std::function<bool()> interrupted)
        : GaitModel(its_family)
        , interrupted_(std::move(interrupted))
      {
        if (wishes.numbers[GaitNumber::mean_square])
          throw InputError(
            "the mean-square strain is limited at the kinematic level only; Model = kinematic, or another "
            "limit, is expected",
            "Optimize/Mean-square strain");
      }

      /// Steps see extremes at their stages only; a thousand pictures of each stride show those between.
      std::pair<double, double>
      extreme_strains(const std::vector<double> &x) override
      {
        constexpr double pictures_of_stride = 1000., max_pictures = 20000.;
        evaluate(x, /*with_gradients=*/false, {});
        const Task &task = latest_.front();
        std::pair<double, double> extremes{task.computed.result.stretch.min.value - 1.,
                                           task.computed.result.stretch.max.value - 1.};
        if (has_pictures(task))
          repeat(
            task,
            [&](const Snapshot &snapshot) {
              extremes.first  = std::min(extremes.first, snapshot.stretch.min.value - 1.);
              extremes.second = std::max(extremes.second, snapshot.stretch.max.value - 1.);
            },
            equal_parts(0.,
                        1.,
                        static_cast<unsigned int>(
                          std::min(pictures_of_stride * std::max(strides_of(*task.scene), 1.), max_pictures))));
        return extremes;
      }

      double
      noise() const override
      {
        return family.form.parameters.accuracy;
      }
      std::string
      description() const override
      {
        return "simulations, with derivatives by the adjoint, or by differences where it does not cover an entry";
      }

    private:
      void
      compute(const std::vector<double> &x,
              const bool with_gradients,
              const std::vector<std::size_t> &places,
              GaitValues &values) override
      {
        if (latest_.empty() || latest_x_ != x)
        {
          latest_   = answers({x});
          latest_x_ = x;
          latest_extremes_.clear();
        }
        const Task &task = latest_.front();
        if (const std::string problem = problem_at(task); !problem.empty())
          throw InputError(problem);
        values.numbers = numbers(task);
        if (wishes.strain && latest_extremes_.empty())
          latest_extremes_ = extremes(task);
        for (const StretchPlace &one : latest_extremes_)
          values.strain.values.push_back(one.value - 1.);
        if (!with_gradients)
          return;
        values.by_differences.assign(x.size(), true);
        values.strain_by_differences.assign(x.size(), wishes.strain);
        values.strain.gradients.assign(x.size(), std::vector<double>(latest_extremes_.size()));
        add_adjoint_gradients(x, task, wishes.strain ? with_extremes(places) : places, values);
        const auto times = family.differences(
          x,
          [](const Parameters &there) {
            return std::vector<double>(1, there.time.end_time / (there.body.friction_coefficient * there.body.length));
          },
          1e-3);
        for (std::size_t i = 0; i < x.size(); ++i)
          values.gradients[GaitNumber::friction_time][i] = times[i][0];
        add_differences(x, values);
      }

      std::vector<Task>
      answers(const std::vector<std::vector<double>> &places)
      {
        std::vector<Task> tasks;
        for (const auto &x : places)
        {
          tasks.emplace_back();
          tasks.back().parameters = family.parameters(x);
          tasks.back().gait       = wishes.numbers[GaitNumber::speed];
        }
        compute_all(tasks, HUGE_VAL, interrupted_);
        if (interrupted_())
          throw Interrupted();
        return tasks;
      }

      /// Problem of a gait that lacks a wanted number; empty if it has all.
      std::string
      problem_at(const Task &task) const
      {
        if (const std::string problem = problem_of(task); !problem.empty())
          return problem;
        const auto list = numbers(task);
        for (std::size_t i = 0; i < list.size(); ++i)
          if (wishes.numbers[i] && !std::isfinite(list[i]))
            return i == GaitNumber::speed ? "the speed is not known, since the active stress has no stride, or the run "
                                            "is shorter than two of them"
                                          : "a work is not known there";
        return "";
      }

      ByGaitNumber<double>
      numbers(const Task &task) const
      {
        const SimulationResult &result = task.computed.result;
        const Scene &scene             = *task.scene;
        ByGaitNumber<double> list;
        list.fill(NAN);
        for (std::size_t i = 0; i < list.size(); ++i)
          if (const auto &quantity = gait_numbers[i].quantity)
            list[i] = entry_of(differentiated_numbers[static_cast<std::size_t>(*quantity)]).number_in(result);
        list[GaitNumber::efficiency]    = result.gait_efficiency.value_or(NAN);
        list[GaitNumber::friction_time] = scene.end_time / (scene.body.friction_coefficient * scene.body.length);
        return list;
      }

      /// Repeats the run of a task to see its states at some times, parts of the duration.
      void
      repeat(const Task &task, const std::function<void(const Snapshot &)> &see, const std::vector<double> &times) const
      {
        const Scene &scene = *task.scene;
        std::vector<double> rows;
        for (const double part : times)
          rows.push_back(scene.end_time * part);
        TimeParameters time = task.parameters.time;
        time.cycle_stop     = CycleStopMode::off;
        Simulation(MPI_COMM_SELF, scene, time, task.computed.choice.numerics)
          .run(PictureTimes({}, rows, scene.end_time), {.energy_balance = false}, watched_by(see), [&]() {
            return !interrupted_();
          });
        if (interrupted_())
          throw Interrupted();
      }

      std::vector<StretchPlace>
      extremes(const Task &task)
      {
        const Scene &scene = *task.scene;
        if (!n_boxes_in_time_)
          n_boxes_in_time_ = ExtremesInBoxes::boxes_in_time(strides_of(scene));
        const ExtremesInBoxes boxes(
          *n_boxes_in_time_, strides_of(scene), {breaks_in_space_of(scene), breaks_in_time_of(scene)});
        if (has_pictures(task))
        {
          Kymograph seen(boxes.points);
          repeat(
            task, [&](const Snapshot &snapshot) { seen.observe(snapshot); }, boxes.times);
          const std::vector<double> &stretch = seen.rows().stretch;
          if (stretch.size() == boxes.points.size() * boxes.times.size())
            return boxes.find(stretch);
        }
        const SimulationResult &result = task.computed.result;
        const auto place_of            = [&](const Extreme &one) {
          return StretchPlace{one.s / scene.body.length, one.t / scene.end_time, one.value};
        };
        return boxes.place(place_of(result.stretch.min), place_of(result.stretch.max));
      }

      /// Adds the smallest and the largest of the latest extremes to @p places, no others: each derivative costs a
      /// sweep.
      std::vector<std::size_t>
      with_extremes(std::vector<std::size_t> places) const
      {
        const auto of_value      = [](const StretchPlace &a, const StretchPlace &b) { return a.value < b.value; };
        const auto [least, most] = std::ranges::minmax_element(latest_extremes_, of_value);
        places.push_back(static_cast<std::size_t>(least - latest_extremes_.begin()));
        places.push_back(static_cast<std::size_t>(most - latest_extremes_.begin()));
        std::ranges::sort(places);
        places.erase(std::unique(places.begin(), places.end()), places.end());
        return places;
      }

      std::vector<StretchPlace>
      extremes_at(const std::vector<std::size_t> &indices) const
      {
        std::vector<StretchPlace> places;
        for (const std::size_t e : indices)
          places.push_back(latest_extremes_[e]);
        return places;
      }

      std::vector<Quantity>
      wanted_quantities() const
      {
        std::vector<Quantity> wanted;
        for (std::size_t k = 0; k < gait_numbers.size(); ++k)
          if (wishes.numbers[k] && gait_numbers[k].quantity && *gait_numbers[k].quantity != Quantity::speed)
            wanted.push_back(*gait_numbers[k].quantity);
        if (wishes.numbers[GaitNumber::speed])
          wanted.push_back(Quantity::stride); // the speed comes with it
        return wanted;
      }

      /// Adds gradients by the adjoint, of the strains those of @p near, for the variables for which all wanted numbers
      /// have derivatives.
      void
      add_adjoint_gradients(const std::vector<double> &x,
                            const Task &task,
                            const std::vector<std::size_t> &near,
                            GaitValues &values)
      {
        const NumericsChoice &choice = task.computed.choice;
        if (task.computed.result.process.model == Model::kinematic || choice.is_of_several_runs() ||
            !RecordedRun::is_possible(*task.scene, task.parameters.time, choice.numerics))
          return;
        std::vector<std::vector<Scene>> scenes(x.size());
        std::vector<Variation> variations;
        std::vector<std::size_t> own;
        for (std::size_t i = 0; i < x.size(); ++i)
        {
          const auto around = family.stencil(x, i, /*relative_step=*/1e-3);
          for (const auto &point : around)
            if (point.offset != 0.)
              scenes[i].push_back(family.parameters(point.x).create_scene());
          if (!std::ranges::all_of(scenes[i], [&](const Scene &s) { return have_similar_breaks(*task.scene, s); }))
            continue;
          const bool is_one_sided = around[0].offset == 0.;
          variations.push_back({scenes[i], around[is_one_sided ? 1 : 2].offset, is_one_sided});
          own.push_back(i);
        }
        try
        {
          const RecordedRun run(*task.scene, task.parameters.time, choice.numerics, [&]() { return !interrupted_(); });
          const RunGradient gradient = gradient_of(run, variations, wanted_quantities(), extremes_at(near));
          for (std::size_t v = 0; v < own.size(); ++v)
          {
            const std::size_t i = own[v];
            bool is_known       = true;
            for (std::size_t k = 0; k < gait_numbers.size(); ++k)
              if (wishes.numbers[k] && gait_numbers[k].quantity)
              {
                const auto &value      = gradient.quantities[v][static_cast<std::size_t>(*gait_numbers[k].quantity)];
                is_known               = is_known && value.has_value();
                values.gradients[k][i] = value.value_or(0.);
              }
            values.by_differences[i] = !is_known;
            const auto &strains      = gradient.stretches[v];
            if (!wishes.strain || !std::ranges::all_of(strains, [](const auto &one) { return one.has_value(); }))
              continue;
            for (std::size_t e = 0; e < strains.size(); ++e)
              values.strain.gradients[i][near[e]] = *strains[e];
            values.strain_by_differences[i] = false;
          }
        }
        catch (const std::exception &) // e.g. the engine gave up a step
        {
          if (interrupted_())
            throw Interrupted();
          values.by_differences.assign(x.size(), true);
          values.strain_by_differences.assign(x.size(), wishes.strain);
        }
      }

      void
      add_differences(const std::vector<double> &x, GaitValues &values)
      {
        const double step = step_of_differences(latest_.front().parameters.accuracy);
        std::vector<std::vector<double>> places;
        std::vector<std::pair<std::size_t, double>> weights; // variable and weight of each place
        for (std::size_t i = 0; i < x.size(); ++i)
          if (values.by_differences[i] || values.strain_by_differences[i])
            for (const auto &point : family.stencil(x, i, step))
            {
              places.push_back(point.x);
              weights.emplace_back(i, point.weight);
            }
        if (places.empty())
          return;
        const std::vector<Task> tasks = answers(places);
        // Gaits on one side may be impossible, e.g. near inversion: those on the other side give a derivative of first
        // order.
        std::vector<std::size_t> nearest(x.size(), tasks.size());
        std::vector<std::string> problems(x.size());
        const auto distance = [&](const std::size_t j) {
          return std::abs(places[j][weights[j].first] - x[weights[j].first]);
        };
        for (std::size_t j = 0; j < tasks.size(); ++j)
        {
          const std::size_t i = weights[j].first;
          if (const std::string problem = problem_at(tasks[j]); !problem.empty())
            problems[i] = problem;
          else if (distance(j) > 0. && (nearest[i] == tasks.size() || distance(j) < distance(nearest[i])))
            nearest[i] = j;
        }
        for (std::size_t i = 0; i < x.size(); ++i)
        {
          if (values.by_differences[i])
            for (auto &gradient : values.gradients)
              gradient[i] = 0.;
          if (!problems[i].empty() && nearest[i] == tasks.size())
            values.problem_of_gradients = "beside it: " + problems[i];
        }
        for (std::size_t j = 0; j < tasks.size(); ++j)
        {
          const std::size_t i     = weights[j].first;
          const bool is_one_sided = !problems[i].empty();
          if (is_one_sided && j != nearest[i])
            continue;
          const double weight = is_one_sided ? 1. / (places[j][i] - x[i]) : weights[j].second;
          const auto there    = numbers(tasks[j]);
          const auto change   = [&](const double value, const double at_x) {
            return weight * (is_one_sided ? value - at_x : value);
          };
          if (values.by_differences[i])
            for (std::size_t k = 0; k < gait_numbers.size(); ++k)
              values.gradients[k][i] += change(there[k], values.numbers[k]);
          if (!values.strain_by_differences[i])
            continue;
          const std::vector<StretchPlace> extremes_there = extremes(tasks[j]);
          for (std::size_t e = 0; e < latest_extremes_.size(); ++e)
            values.strain.gradients[i][e] += change(extremes_there[e].value, latest_extremes_[e].value);
        }
      }

      const std::function<bool()> interrupted_;
      std::optional<std::size_t> n_boxes_in_time_; ///< where strains are limited
      std::vector<double> latest_x_;               ///< variables of the following members
      std::vector<Task> latest_;                   ///< single task, with the answer there
      std::vector<StretchPlace> latest_extremes_;  ///< extremes in the boxes, if strains are limited
    };
  } // namespace

  std::unique_ptr<GaitModel>
  simulated_gait(SceneFamily &family, std::function<bool()> interrupted)
  {
    return std::make_unique<SimulatedGait>(family, std::move(interrupted));
  }
} // namespace crawler
