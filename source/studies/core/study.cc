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

  namespace
  {
    /// Progress of a study of many runs: a bar, or a line every few seconds, with parts done, speed, and time left.
    class StudyProgress
    {
    public:
      /// @p parts names the @p n_parts parts, as "points".
      StudyProgress(Log &log, const unsigned long n_parts, std::string parts)
        : log_(log)
        , n_parts_(n_parts)
        , parts_(std::move(parts))
        , bar_(log)
      {
      }

      bool
      is_due() const
      {
        return bar_.is_due() || is_line_due();
      }

      /// @p remark stands at the end of the line. @p state describes the part in progress; if there is a single part,
      /// it is the whole report.
      void
      report(const unsigned long done, const std::string &remark, const std::string &state)
      {
        const bool is_single = n_parts_ == 1 && !state.empty();
        const double seconds = bar_.seconds(), rate = done / seconds;
        const std::string words =
          is_single ? state : fmt::format("{} of {} {}, {:.3g} {}/s", done, n_parts_, parts_, rate, parts_);
        const std::string end = remark + (is_single || state.empty() ? "" : "; this one: " + state);
        if (is_line_due())
        {
          last_line_ = now();
          log_.progress(is_single ? fmt::format("  {}, {}", words, duration_in_words(seconds))
                                  : fmt::format("  {:3.0f} %  {}, {}{}",
                                                100. * done / n_parts_,
                                                words,
                                                done > 0 ? duration_in_words((n_parts_ - done) / rate) + " left"
                                                         : "time left not known yet",
                                                end));
        }
        if (bar_.is_due())
          bar_.show(is_single ? std::nullopt : std::optional(static_cast<double>(done) / n_parts_), words + end);
      }

    private:
      bool
      is_line_due() const
      {
        constexpr double between_lines = 5.; // [s]
        return now() >= last_line_ + between_lines;
      }

      Log &log_;
      const unsigned long n_parts_;
      const std::string parts_;
      ProgressBar bar_;
      double last_line_ = now();
    };
  } // namespace

  bool
  share_work(MPI_Comm communicator, const SharedWork &work, Log &log)
  {
    bool is_whole = true;
    std::string problem;
    {
      WorkQueue queue(communicator, work.n_parts, work.besides);
      StudyProgress progress(log, work.n_points, work.points);
      const auto show_progress = [&]() {
        if (rank_of(communicator) != 0 || !progress.is_due())
          return;
        const auto all = queue.so_far();
        progress.report(
          all.done, all.failed > 0 ? fmt::format(", {} not finished", all.failed) : "", work.state ? work.state() : "");
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
