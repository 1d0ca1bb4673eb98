// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/versions.h>
#include <crawler/base/work_queue.h>
#include <crawler/studies/core/form.h>
#include <crawler/studies/core/progress.h>
#include <crawler/studies/core/study.h>

#include <fmt/format.h>
#include <petscsys.h>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace crawler
{
  std::string
  without_comments(const std::string &parameters)
  {
    std::string bare;
    std::istringstream lines(parameters);
    for (std::string line; std::getline(lines, line);)
      if (const std::string text = trimmed(line); !text.empty() && text[0] != '#')
        bare += line + "\n";
    return bare;
  }

  std::map<std::string, std::string>
  provenance(const std::string &effective, const std::string &command_line)
  {
    // Comments are left out: HDF5 allows 64 KB for an attribute.
    std::map<std::string, std::string> attributes = {{"parameters.prm", without_comments(effective)},
                                                     {"command line", command_line}};
    for (const auto &[name, version] : versions())
      attributes["version of " + name] = version;
    return attributes;
  }

  std::vector<std::string>
  differences(const std::string &before, const std::string &after, const std::vector<std::string> &others)
  {
    const auto values = [](const std::string &text) {
      const Form form(ParameterFile::from_text(text, "parameters.prm"));
      std::map<std::string, std::string> list;
      for (unsigned int i = 0; i < form.declarations.entries().size(); ++i)
        list.emplace(form.declarations.entries()[i].path, "\"" + form.declarations.value(i) + "\"");
      return list;
    };
    const auto are_same_number = [](const std::string &a, const std::string &b) {
      const auto number = [](const std::string &quoted) {
        return quoted.size() < 2 ? std::nullopt : to_number(quoted.substr(1, quoted.size() - 2));
      };
      return number(a) && number(a) == number(b);
    };
    std::vector<std::string> list;
    add_differences(
      values(before), values(after), "{}", "not there", list, [&](const auto &entry, const auto &was, const auto &is) {
        return are_same_number(was, is) || std::ranges::find(others, entry) != others.end();
      });
    return list;
  }

  void
  add_differences(
    const std::map<std::string, std::string> &before,
    const std::map<std::string, std::string> &after,
    const std::string &what,
    const std::string &otherwise,
    std::vector<std::string> &list,
    const std::function<bool(const std::string &name, const std::string &was, const std::string &is)> &does_not_count)
  {
    const auto text_in = [&](const auto &texts, const std::string &name) {
      const auto found = texts.find(name);
      return found == texts.end() ? otherwise : found->second;
    };
    auto all = before;
    all.insert(after.begin(), after.end());
    for (const auto &[name, ignored] : all)
      if (const std::string was = text_in(before, name), is = text_in(after, name);
          was != is && !(does_not_count && does_not_count(name, was, is)))
        list.push_back(fmt::format(fmt::runtime(what), name) + fmt::format(" was {} and is {}", was, is));
  }

  bool
  StudyClock::is_over()
  {
    constexpr double between_looks = 0.5; // [s]
    if (!reason_.empty())
      return true;
    if (signal_.arrived())
      reason_ = "signal";
    else if (limit_ && seconds() >= *limit_)
      reason_ = "time_limit";
    else if (!stop_file_.empty() && now() >= last_look_ + between_looks)
    {
      std::error_code ignored;
      if (std::filesystem::exists(stop_file_, ignored))
        reason_ = "stop_file";
      last_look_ = now();
    }
    return !reason_.empty();
  }

  std::string
  StudyClock::in_words(const std::string &reason) const
  {
    return "stopped by " + (reason == "signal"      ? "a signal"
                            : reason == "stop_file" ? "the file \"" + stop_file_.string() + "\""
                                                    : limit_in_words_);
  }

  namespace
  {
    /// Shows how many of the points are done, the speed, and the time left. If there is a single point, its @p state is
    /// the whole report.
    void
    show_points(ProgressBar &bar, const SharedWork &work, const WorkQueue::Done &so_far)
    {
      const std::string state = work.state ? work.state() : "";
      const bool is_single    = work.n_points == 1 && !state.empty();
      const double seconds = bar.seconds(), rate = so_far.done / seconds;
      const std::string words =
        is_single ? state
                  : fmt::format("{} of {} {}, {:.3g} {}/s", so_far.done, work.n_points, work.points, rate, work.points);
      const std::string end = (so_far.failed > 0 ? fmt::format(", {} not finished", so_far.failed) : "") +
                              (is_single || state.empty() ? "" : "; this one: " + state);
      const double done = static_cast<double>(so_far.done) / work.n_points;
      bar.show(is_single ? std::nullopt : std::optional(done),
               words + end,
               is_single
                 ? fmt::format("  {}, {}", words, duration_in_words(seconds))
                 : fmt::format("  {:3.0f} %  {}, {}{}",
                               100. * done,
                               words,
                               so_far.done > 0 ? duration_in_words((work.n_points - so_far.done) / rate) + " left"
                                               : "time left not known yet",
                               end));
    }
  } // namespace

  bool
  share_work(MPI_Comm communicator, const SharedWork &work, Log &log)
  {
    bool is_whole = true;
    std::string problem;
    {
      WorkQueue queue(communicator, work.n_parts, work.besides);
      ProgressBar bar(log, /*between_lines=*/5.);
      const auto show_progress = [&]() {
        if (rank_of(communicator) == 0 && bar.is_due())
          show_points(bar, work, queue.so_far());
      };
      const auto stops = [&]() {
        queue.serve();
        show_progress();
        return work.interrupted();
      };
      const auto see = [&](const unsigned long n, const unsigned long failed) {
        queue.done(n, failed);
        show_progress();
      };
      try
      {
        while (const auto number = queue.next())
          if (!work.compute(*number, stops, see))
          {
            is_whole = false;
            break;
          }
      }
      catch (const FileError &error)
      {
        problem = error.what();
      }
      if (!is_whole || !problem.empty())
        queue.close();
    }
    throw_on_all_ranks(communicator, problem);
    return !is_true_anywhere(!is_whole, communicator);
  }

  void
  throw_on_all_ranks(MPI_Comm communicator, const std::string &problem)
  {
    const std::string first = first_text(problem, communicator);
    if (!first.empty())
      throw FileError(first + "; the rows written so far are kept, and --resume computes the rest");
  }

  void
  announce_petsc_options(const CommandOptions &options, Log &log)
  {
    if (!options.petsc_options.empty())
      log.line("PETSc options (override the settings): " + options.petsc_options);
  }

  void
  warn_of_unused_petsc_options(MPI_Comm communicator, const CommandOptions &options, Log &log)
  {
    std::istringstream words(options.petsc_options);
    for (std::string word; words >> word;)
    {
      if (word.size() < 2 || word[0] != '-' || std::isalpha(static_cast<unsigned char>(word[1])) == 0)
        continue; // value of an option
      PetscBool is_used = PETSC_FALSE;
      PetscOptionsUsed(nullptr, word.c_str() + 1, &is_used);
      if (!is_true_anywhere(is_used == PETSC_TRUE, communicator))
        log.warn("warning: nothing used the PETSc option " + word);
    }
  }
} // namespace crawler
