// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/answer.h>
#include <crawler/base/grid_samples.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/equation/general_laws.h>
#include <crawler/studies/sweep/cross_check.h>
#include <crawler/studies/sweep/point_table.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace crawler
{
  namespace
  {
    bool
    finished(const Claim &claim)
    {
      return claim.status == "finished";
    }

    bool
    is_answer(const Claim &claim)
    {
      return finished(claim) || claim.status == "inverted";
    }

    /// Time until which the body is certainly not inverted.
    double
    uninverted_until(const Claim &claim, const InversionFacts &facts)
    {
      return finished(claim) ? facts.end_time : claim.inversion_time;
    }

    std::string
    in_words(const Claim &claim)
    {
      return finished(claim) ? fmt::format("{} finished", claim.run)
                             : fmt::format("{} inverted at t = {:.6g}", claim.run, claim.inversion_time);
    }

    /// Reason why one claim cannot be right; empty if it can.
    std::string
    against_theory(const Claim &claim, const InversionFacts &facts)
    {
      const double tolerance = inversion_time_tolerance * facts.end_time;
      const double until     = uninverted_until(claim, facts);
      if (!(until <= facts.latest_at_end + tolerance))
        return fmt::format("{}, but an end inverts at t = {:.6g}", in_words(claim), facts.latest_at_end);
      if (!finished(claim) && !facts.possible_inside && until < facts.earliest_at_end - tolerance)
        return in_words(claim) + ", but the body cannot invert inside (a <= -1) and its ends do not";
      return "";
    }

    /// Reason why two answers cannot both be right, empty if they can; nothing if they cannot be compared.
    std::optional<std::string>
    compare(const Claim &a, const Claim &b, const InversionFacts &facts)
    {
      if (!is_answer(a) || !is_answer(b))
        return std::nullopt;
      if (finished(a) && finished(b))
      {
        const double promised = a.promised_error + b.promised_error;
        if (std::isnan(promised))
          return std::nullopt;
        const double difference = std::abs(a.displacement - b.displacement);
        if (difference <= promised)
          return "";
        return fmt::format(
          "the displacements of {} and {}, {:.8g} and {:.8g}, differ by {:.3g}, but {:.3g} is promised",
          a.run,
          b.run,
          a.displacement,
          b.displacement,
          difference,
          promised);
      }
      const double difference = std::abs(uninverted_until(a, facts) - uninverted_until(b, facts));
      if (difference <= inversion_time_tolerance * facts.end_time)
        return "";
      return fmt::format("{}, but {}", in_words(a), in_words(b));
    }
  } // namespace

  Verdict
  cross_check(const std::vector<Claim> &runs, const Claim &refined, const InversionFacts &facts)
  {
    std::vector<Claim> all = runs;
    all.push_back(refined);
    for (const Claim &claim : all)
      if (is_answer(claim))
        if (const std::string why = against_theory(claim, facts); !why.empty())
          return {Verdict::silent_wrong_answer, why};

    bool compared           = false;
    const auto look_at_pair = [&](const Claim &a, const Claim &b) {
      const auto contradiction = compare(a, b, facts);
      compared                 = compared || contradiction;
      return contradiction.value_or("");
    };
    for (std::size_t i = 0; i < runs.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j)
        if (!is_answer(refined) || j == runs.size())
          if (const std::string why = look_at_pair(runs[i], all[j]); !why.empty())
            return {Verdict::silent_wrong_answer, why};
    return {compared ? Verdict::agree : Verdict::unchecked, ""};
  }

  namespace
  {
    /// True if the answers at this point can be compared.
    bool
    is_checkable(const Task &task)
    {
      return !task.error && task.scene && task.parameters.model == Model::nonlinear &&
             task.scene->active_stress->feedback() == nullptr;
    }

    bool
    has_both_forms(const Task &main)
    {
      return main.parameters.discretization.formulation == FormulationEntry::automatic;
    }

    bool
    is_stretch(const Task &main)
    {
      return main.computed.choice.numerics.formulation == Formulation::stretch;
    }

    /// Point with its other runs.
    struct Checked
    {
      enum Run
      {
        position,
        stretch,
        refined,
        n_runs
      };
      static constexpr std::array<const char *, n_runs> names = {{"position", "stretch", "refined"}};

      const Task *main;
      std::array<std::optional<Task>, n_runs> own = {};

      /// Null if it was not requested. The automatic choice may be the stretch form.
      const Task *
      run(const Run which) const
      {
        if (which == stretch && is_checkable(*main) && has_both_forms(*main) && is_stretch(*main))
          return main;
        return own[which] ? &*own[which] : nullptr;
      }
    };

    constexpr unsigned int explanation_width = 256;
    const char *const ratio_meaning =
      "difference between the displacement and that of the refined run, over the sum of both promised errors";
    /// Numbers of a sweep that the table has of each run.
    constexpr const char *numbers_of_run[] = {
      "displacement", "inversion.s", "inversion.t", "min_stretch.value", "steps"};

    Claim
    claim_of(const char *name, const Task &task)
    {
      const SimulationResult &result = task.computed.result;
      const PointStatus status       = status_of(task);
      Claim claim{.run = name, .status = status.status, .promised_error = task.computed.choice.wanted_error};
      if (result.error && claim.promised_error < result.error->total)
        claim.promised_error = result.error->total;
      // Answers with a large error are answers: they claim that error.
      if (status.reason == accuracy_not_met && std::isfinite(claim.promised_error))
        claim.status = "finished";
      if (claim.status == "finished")
        claim.displacement = result.displacement;
      if (result.inversion)
        claim.inversion_time = result.inversion->t;
      return claim;
    }

    /// True if both runs are the same: a run is no check of itself.
    bool
    same_run(const Task &a, const Task &b)
    {
      return status_of(a).status == "finished" && status_of(b).status == "finished" &&
             a.computed.result.displacement == b.computed.result.displacement &&
             a.computed.result.time.steps == b.computed.result.time.steps;
    }

    /// Parameters of the refined run.
    Parameters
    refined_parameters(const Parameters &parameters)
    {
      Parameters finer                 = parameters.with_free_numerics();
      finer.accuracy                   = std::max(1e-12, parameters.accuracy / parameters.sweep.refinement);
      finer.discretization.formulation = parameters.discretization.formulation;
      return finer;
    }

    using Wish = std::optional<Parameters>;

    Wish
    with_formulation(Parameters parameters, const FormulationEntry formulation)
    {
      parameters.discretization.formulation = formulation;
      return parameters;
    }

    /// Parameters of the run @p which of a point; nothing if it is not requested.
    Wish
    wish(const Checked &point, const Checked::Run which)
    {
      const Task &main = *point.main;
      if (which == Checked::refined)
      {
        // Accuracy is divided once more where the choice of mesh and steps does not depend on it.
        const Task *const before = point.run(which);
        return before == nullptr         ? refined_parameters(main.parameters)
               : same_run(main, *before) ? refined_parameters(before->parameters)
                                         : Wish();
      }
      if (!has_both_forms(main))
        return std::nullopt;
      if (which == Checked::position)
        return with_formulation(main.parameters, FormulationEntry::position);
      // Inversions are located less well by the stretch form than by the position form for a >= 0.
      if (is_stretch(main) || main.parameters.body.friction_exponent() >= 0.)
        return std::nullopt;
      return with_formulation(main.parameters, FormulationEntry::stretch);
    }

    /// Adds the runs of one kind at all points that need them.
    void
    add_runs(std::vector<Checked> &points, const Checked::Run which, const std::function<bool()> &interrupted)
    {
      std::vector<Task> tasks;
      std::vector<Checked *> places;
      for (Checked &point : points)
        if (auto parameters = is_checkable(*point.main) ? wish(point, which) : std::nullopt)
        {
          tasks.emplace_back().parameters = std::move(*parameters);
          tasks.back().gait               = point.main->gait;
          places.push_back(&point);
        }
      if (tasks.empty() || interrupted())
        return;
      compute_all(tasks, tasks[0].parameters.sweep.point_time_limit.value_or(HUGE_VAL), interrupted);
      for (std::size_t i = 0; i < tasks.size(); ++i)
        places[i]->own[which] = std::move(tasks[i]);
    }

    /// Distance from 0 within which a stretch is not called positive or negative before the run.
    constexpr double clear_stretch = 1e-3;

    /// First time at which the stretch of an end, 1 - m/k, is below @p level.
    double
    end_below(const Scene &scene, const double level)
    {
      constexpr unsigned int n_times = 10000;
      EndStretches ends(scene);
      for (const double t : equal_parts(0., scene.end_time, n_times))
        if (ends.smallest(t) < level)
          return t;
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

    /// Name of a point in the picture: the sweep's own answer, unless something is wrong.
    std::string
    outcome_of(const Task &main, const Verdict &verdict)
    {
      const PointStatus status = status_of(main);
      if (verdict.kind == Verdict::silent_wrong_answer)
        return word_of(verdict.kind);
      if (status.status == "inverted")
        return status.reason == "inverted_at_end" ? "inverted at end" : "inverted inside";
      if (status.reason == "refused")
        return status.reason;
      if (status.status == "finished" || claim_of("", main).status == "finished")
        return "finished";
      return status.status + ": " + status.reason;
    }

    RowFile::Row
    values_of(const Checked &point)
    {
      const Task &main     = *point.main;
      const auto its_claim = [&](const Checked::Run run) {
        const Task *const task = point.run(run);
        return task != nullptr ? claim_of(Checked::names[run], *task) : Claim{.run = Checked::names[run], .status = ""};
      };
      const Claim claim = claim_of("run", main), finer = its_claim(Checked::refined);
      const auto ratio = [&](const Claim &its) {
        return std::abs(its.displacement - finer.displacement) / (its.promised_error + finer.promised_error);
      };
      const Task *const reference = point.run(Checked::refined);
      const bool is_own_check     = reference != nullptr && same_run(main, *reference);
      Verdict verdict;
      if (reference != nullptr && !is_own_check)
        verdict = cross_check(
          {claim, its_claim(Checked::position), its_claim(Checked::stretch)}, finer, inversion_facts(*main.scene));
      RowFile::Row row = {outcome_of(main, verdict),
                          word_of(verdict.kind),
                          shortened(verdict.explanation, explanation_width),
                          claim.promised_error,
                          is_own_check ? NAN : ratio(claim)};
      for (const auto run : {Checked::position, Checked::stretch, Checked::refined})
      {
        const Task *const task   = point.run(run);
        const Claim its          = its_claim(run);
        const PointStatus status = task != nullptr ? status_of(*task) : PointStatus();
        row.insert(row.end(), {status.status, status.reason});
        for (const char *key : numbers_of_run)
          row.push_back(task != nullptr ? value_in_row(*task, entry_of(key)) : NAN);
        row.insert(row.end(), {its.promised_error, task != nullptr ? task->seconds : NAN});
        if (run != Checked::refined)
          row.push_back(ratio(its));
      }
      return row;
    }
  } // namespace

  std::vector<RowFile::Column>
  checked_columns()
  {
    std::vector<RowFile::Column> columns = {
      {"outcome", "", "what became of the point, or that an answer is wrong", 48},
      {"verdict", "", "agree, unchecked or silent wrong answer", 24},
      {"explanation", "", "why an answer is wrong", explanation_width},
      {"promised error", "length", "error of the displacement that Accuracy promises", 0},
      {"error ratio", "1", ratio_meaning, 0}};
    for (const auto run : {Checked::position, Checked::stretch, Checked::refined})
    {
      const std::string name = std::string(Checked::names[run]) + " ";
      columns.push_back({name + "status", "", "status of this run; empty if it was not requested", 24});
      columns.push_back({name + "reason", "", "name of what went wrong", 32});
      for (const char *key : numbers_of_run)
        columns.push_back({name + key, entry_of(key).unit, entry_of(key).meaning, 0});
      columns.push_back({name + columns[3].name, columns[3].unit, columns[3].description, 0});
      columns.push_back({name + "seconds", "s", "wall time", 0});
      if (run != Checked::refined)
        columns.push_back({name + "error ratio", "1", ratio_meaning, 0});
    }
    return columns;
  }

  std::vector<RowFile::Row>
  checked_values(const std::vector<const Task *> &points, const std::function<bool()> &interrupted)
  {
    std::vector<Checked> all;
    for (const Task *main : points)
      all.push_back({main});
    for (const auto run : {Checked::position, Checked::stretch, Checked::refined, Checked::refined})
      add_runs(all, run, interrupted);
    std::vector<RowFile::Row> rows;
    for (const Checked &point : all)
      rows.push_back(values_of(point));
    return rows;
  }
} // namespace crawler
