// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/crash_file.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/optimize/optimize_results.h>
#include <crawler/studies/optimize/optimize_searches.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Start in the notes on crashes.
    std::string
    mark(const StartName &start)
    {
      return fmt::format("{}/{}/{}", start.number_of_case, start.start, start.neighbour);
    }

    /// Gait @p x in a case, if it is within all limits and is better than @p own by more than the optimiser's
    /// tolerance.
    std::optional<GaitRecord>
    better_gait(OptimizeCases &cases, const StartResult &own, const std::vector<double> &x)
    {
      constexpr double more = 10.;
      const auto family     = cases.family(own.number_of_case);
      const auto &variables = family->variables;
      for (std::size_t i = 0; i < x.size(); ++i)
        if (x[i] < variables[i].from || x[i] > variables[i].to)
          return std::nullopt;
      const OptimizeParameters wishes = family->form.parameters.optimize;
      try
      {
        const auto model = make_gait_model(*family, x);
        GaitProblem problem(*model, wishes, x);
        const GaitRecord record = problem.record(problem.to_y(x));
        if (!record.problem.empty() || record.violation > problem.admissible())
          return std::nullopt;
        const std::vector<GaitRecord> both = {own.best, record};
        const bool is_better = &GaitProblem::best_of(both, objective_of(wishes), problem.admissible()) == &both[1] &&
                               (!own.is_admissible() || std::abs(record.objective - own.best.objective) >
                                                          more * problem.admissible() * std::abs(own.best.objective));
        return is_better ? std::optional(record) : std::nullopt;
      }
      catch (const InputError &) // no gait in this case
      {
        return std::nullopt;
      }
    }

    /// Start of a case: its own, or the best gait of a neighbour of the case.
    struct Part : StartName
    {
      std::vector<double> x = {}; ///< gait of the neighbour

      void
      exchange(Archive &archive)
      {
        archive(number_of_case, start, neighbour, x);
      }
    };

    class OptimizeSearches
    {
    public:
      OptimizeSearches(MPI_Comm communicator,
                       OptimizeCases &cases,
                       OptimizeMemory *memory,
                       const StudyFolder &folder,
                       std::function<bool()> interrupted)
        : communicator_(communicator)
        , cases_(cases)
        , memory_(memory)
        , interrupted_(std::move(interrupted))
        , log_(folder.log)
        , note_(folder.path)
      {
        for (unsigned long number = 0; number < cases.size(); ++number)
          for (unsigned long start = 0; start < cases.parameters().optimize.n_starts; ++start)
            parts_.push_back({{number, start}});
      }

      /// Returns false if it was interrupted.
      bool
      go_on()
      {
        bool is_whole = search_all(parts_);
        for (unsigned long round = 0; is_whole && round < cases_.size(); ++round)
        {
          Archive archive(on_first_rank(communicator_, [&]() {
            auto more = parts_from_neighbours();
            return archived(more);
          }));
          std::vector<Part> more;
          archive(more);
          if (more.empty())
            break;
          parts_.insert(parts_.end(), more.begin(), more.end());
          is_whole = search_all(more);
        }
        return is_whole;
      }

      /// Starts of all searches, in the order of the cases.
      std::vector<StartName>
      names_in_order() const
      {
        std::vector<StartName> names(parts_.begin(), parts_.end());
        std::ranges::stable_sort(names, {}, &StartName::number_of_case);
        return names;
      }

    private:
      bool
      search_all(const std::vector<Part> &some)
      {
        const std::vector<bool> done = points_done(communicator_, [&]() {
          std::vector<bool> list;
          for (const Part &part : some)
          {
            const StartResult *const found = memory_->find(part);
            list.push_back(found != nullptr && !found->was_interrupted);
          }
          return list;
        });
        const auto compute           = [&](const unsigned long number, const auto &stops, const auto &see) {
          if (done[number])
            return true;
          const Part &part             = some[number];
          const auto family            = cases_.family(part.number_of_case);
          const auto x                 = part.neighbour > 0 ? part.x : family->start(part.start);
          const std::string crash_mark = mark(part);
          note_.at_work_on(crash_mark);
          StartResult result = note_.is_given_up(crash_mark) ? without_gait(part, x, crash_message)
                                                                       : search(*family, part, x, state_, stops);
          if (rank_of(communicator_) == 0)
            keep(result);
          else
            send_to_first_rank(archived(result), communicator_);
          note_.at_work_on({});
          see(1, result.has_converged ? 0 : 1);
          return !result.was_interrupted;
        };
        const auto in_words = [&]() {
          const std::string evaluations = counted(state_.evaluations, "evaluation");
          return std::isnan(state_.best)
                   ? evaluations + ", no gait within the limits yet"
                   : fmt::format(
                       "{}, best {} {:.6g}", evaluations, cases_.parameters().optimize.objective, state_.best);
        };
        const auto take = [&]() {
          take_from_others(communicator_, [&](const std::string &text) {
            Archive archive(text);
            StartResult start;
            archive(start);
            keep(std::move(start));
          });
        };
        const bool is_whole = share_work(communicator_,
                                         {some.size(),
                                          static_cast<unsigned long>(std::ranges::count(done, false)),
                                          "starts",
                                          [&]() { return interrupted_() || !problem_.empty(); },
                                          compute,
                                          in_words,
                                          take},
                                         log_);
        throw_on_all_ranks(communicator_, problem_);
        return is_whole;
      }

      OptimizeResults
      results_so_far() const
      {
        std::vector<StartResult> starts;
        for (const StartName &name : names_in_order())
          if (const StartResult *const start = memory_->find(name))
            starts.push_back(*start);
        return {cases_.names(), std::move(starts)};
      }

      /// New starts: for each case whose best gait is beaten by that of a neighbour, the best one of these.
      std::vector<Part>
      parts_from_neighbours()
      {
        const OptimizeResults results = results_so_far();
        const auto best_of            = [&](const unsigned long number) -> const StartResult            *{
          for (const std::size_t i : results.best)
            if (results.starts[i].number_of_case == number)
              return &results.starts[i];
          return nullptr;
        };
        std::vector<Part> more;
        for (unsigned long number = 0; number < cases_.size(); ++number)
        {
          const StartResult *const own = best_of(number);
          if (own == nullptr)
            continue;
          StartResult leader = *own;
          std::optional<Part> found;
          for (const unsigned long neighbour : cases_.points().design().neighbours(number))
          {
            const StartResult *const other = best_of(neighbour);
            if (other == nullptr || cases_.names().cases[neighbour].paths != cases_.names().cases[number].paths)
              continue;
            const std::vector<double> &x = other->best.x;
            const bool is_known          = std::ranges::any_of(
              parts_, [&](const Part &part) { return part.number_of_case == number && part.x == x; });
            const auto record = is_known ? std::nullopt : better_gait(cases_, leader, x);
            if (!record)
              continue;
            leader.best = *record;
            const auto n_own =
              std::ranges::count_if(parts_, [&](const Part &part) { return part.number_of_case == number; });
            found = {{number, static_cast<unsigned long>(n_own), neighbour + 1}, x};
          }
          if (!found)
            continue;
          log_.line(
            fmt::format("With {} the gait of {} is better ({:.6g}) than its own ({:.6g}): the search continues there.",
                        cases_.in_words(number),
                        cases_.in_words(found->neighbour - 1),
                        leader.best.objective,
                        own->best.objective));
          more.push_back(*found);
        }
        return more;
      }

      void
      keep(StartResult start)
      {
        if (!problem_.empty())
          return;
        try
        {
          memory_->keep(std::move(start));
        }
        catch (const FileError &error)
        {
          problem_ = error.what();
        }
      }

      const MPI_Comm communicator_;
      OptimizeCases &cases_;
      OptimizeMemory *const memory_;
      const std::function<bool()> interrupted_;
      Log &log_;
      std::vector<Part> parts_;
      SearchState state_;
      CrashNote note_;
      std::string problem_; ///< problem with the files
    };
  } // namespace

  SearchesMade
  make_searches(MPI_Comm communicator,
                OptimizeCases &cases,
                OptimizeMemory *const memory,
                const StudyFolder &folder,
                std::function<bool()> interrupted)
  {
    OptimizeSearches searches(communicator, cases, memory, folder, std::move(interrupted));
    const bool is_whole = searches.go_on();
    return {is_whole, searches.names_in_order()};
  }
} // namespace crawler
