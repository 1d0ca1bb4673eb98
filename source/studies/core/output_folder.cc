// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/parameters/axis.h>
#include <crawler/parameters/plain_text.h>
#include <crawler/parameters/slips.h>
#include <crawler/studies/core/crash_file.h>
#include <crawler/studies/core/output_folder.h>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <regex>
#include <thread>
#include <unistd.h>

namespace crawler
{
  namespace fs = std::filesystem;

  namespace
  {
    /// File that is locked (base/file_lock.h) while a run or study writes to the folder.
    const std::string study_lock_name = "study.lock";
    /// Page that `crawler report` makes.
    const std::string report_name = "report.html";
    /// Files of runs and studies, except those that a run writes as it proceeds.
    const std::vector<std::string> own_names =
      split_parts("original.prm, parameters.prm, log.txt, summary.json, restart.dat, restart.dat.new, restart.old.dat, "
                  "stop, segments.csv, segment_switching.csv, kymograph.png, sensitivity_body.csv, "
                  "sensitivity_stress.csv, sensitivity.png, results.csv, results.h5, results.h5.part, results.png, "
                  "results.svg, tradeoff.csv, tradeoff.h5, tradeoff.h5.part, tradeoff.png, tradeoff.svg, "
                  "recommendations.prm, scaling.png, starts.csv, starts.h5, starts.h5.part, optimum.prm, optima.csv, "
                  "optimize.png, reference.json, " +
                    crash_file + ", " + report_name,
                  ',');
    /// Files that a run writes as it proceeds: the fields and the statistics.
    const std::vector<std::string> names_of_fields =
      split_parts("statistics.csv, solution.pvd, line.pvd, solution.xdmf, line.xdmf, solution.h5, solution.h5.part, "
                  "kymograph.vts",
                  ',');

    /// Refuses links, which would redirect writing and removal to other places.
    void
    require_no_links(const fs::path &folder)
    {
      std::error_code error;
      for (const auto &entry : fs::directory_iterator(folder, error))
      {
        if (!entry.is_symlink(error))
          continue;
        const std::string name = entry.path().filename().string();
        const bool is_folder =
          name == "solution" || name == "points" || name == "starts" || name == "rows" || name.starts_with("best");
        const auto has_it = [&](const auto &names) {
          return std::find(names.begin(), names.end(), name) != names.end();
        };
        if (is_folder || name == study_lock_name || has_it(own_names) || has_it(names_of_fields))
          throw FileError(fmt::format("\"{}\" is a link, but a {} of the program's own is expected",
                                      entry.path().string(),
                                      is_folder ? "folder" : "file"));
      }
    }

    /// True if the writer was killed (its lock or its state remains) or stopped in an orderly way.
    bool
    is_broken_off(const fs::path &folder)
    {
      std::error_code error;
      if (fs::exists(folder / study_lock_name, error))
        return FileLock(folder / study_lock_name).lock() == FileLock::State::mine; // otherwise it is still running
      return fs::exists(folder / "restart.dat", error) || status_in(folder) == "stopped";
    }

    /// The folder, which is made now unless it exists.
    const fs::path &
    made(const fs::path &folder)
    {
      std::error_code error;
      fs::create_directories(folder, error);
      if (error)
        throw FileError("cannot make the output folder \"" + folder.string() + "\": " + error.message());
      return folder;
    }

    /// Removes the file FILE-1-NUMBER.lock that MPI leaves beside a table where the only process of a study is killed.
    void
    remove_locks_of_mpi(const fs::path &folder)
    {
      const auto is_lock = [](const std::string &name) {
        return name.ends_with(".lock") && (name.find(".h5-") != name.npos || name.find(".h5.part-") != name.npos);
      };
      std::vector<fs::path> locks;
      for (const auto &file : fs::directory_iterator(folder))
        if (is_lock(file.path().filename().string()))
          locks.push_back(file.path());
      std::error_code ignored; // remaining locks are harmless
      for (const auto &file : locks)
        fs::remove(file, ignored);
    }
  } // namespace

  fs::path
  output_folder(const std::string &option, const std::string &parameter_file)
  {
    if (const std::string sign = home_sign(option); !sign.empty())
      throw InputError("--output: " + sign);
    if (!option.empty())
      return option;
    return "output-" + (parameter_file == "-" ? std::string("stdin") : fs::path(parameter_file).stem().string());
  }

  void
  require_usable(const fs::path &folder, const bool overwrite)
  {
    std::error_code error;
    if (!fs::exists(folder, error))
    {
      // Missing folders are made in the nearest one that exists, which must be writable.
      fs::path parent = fs::absolute(folder).parent_path();
      while (!fs::exists(parent, error) && parent.has_relative_path())
        parent = parent.parent_path();
      if (!fs::is_directory(parent, error))
        throw FileError("cannot make the output folder \"" + folder.string() + "\": \"" + parent.string() +
                        "\" is not a folder");
      if (::access(parent.c_str(), W_OK) != 0)
        throw FileError("cannot make the output folder \"" + folder.string() + "\": " + std::strerror(errno));
      return;
    }
    if (!fs::is_directory(folder, error))
      throw FileError("the output folder \"" + folder.string() + "\" exists and is not a folder");
    if (::access(folder.c_str(), W_OK) != 0)
      throw FileError("cannot write to the output folder \"" + folder.string() + "\": " + std::strerror(errno));
    if (fs::exists(folder / "solution", error) && !fs::is_directory(folder / "solution", error))
      throw FileError("\"" + (folder / "solution").string() +
                      "\" is not a folder, but one for the snapshots is expected");
    require_no_links(folder);
    if (overwrite || fs::is_empty(folder, error))
      return;
    if (is_broken_off(folder))
      throw InputError("the output folder \"" + folder.string() +
                       "\" has a run or study that was interrupted; the same command with --resume continues it "
                       "(--overwrite starts over, --output gives another folder)");
    throw InputError("the output folder \"" + folder.string() +
                     "\" is not empty; give another one with --output, or --overwrite to replace the results in it");
  }

  bool
  has_just_begun(const fs::path &folder, std::set<std::string> others)
  {
    others.insert({study_lock_name,
                   report_name,
                   "original.prm",
                   "original.prm.part",
                   "parameters.prm",
                   "parameters.prm.part",
                   "log.txt"});
    return std::ranges::all_of(fs::directory_iterator(folder), [&](const fs::directory_entry &file) {
      return others.contains(file.path().filename().string());
    });
  }

  void
  require_unchanged(const std::string &kind,
                    const fs::path &folder,
                    const std::vector<std::string> &changes,
                    const std::vector<std::string> &free_entries)
  {
    if (!changes.empty())
      throw InputError(fmt::format("the {} in \"{}\" was made with other parameters: {}; it can only be resumed with "
                                   "the same ones (except for {})",
                                   kind,
                                   folder.string(),
                                   fmt::join(changes, ", "),
                                   fmt::join(free_entries, " and ")));
  }

  std::string
  status_in(const fs::path &folder)
  {
    std::ifstream in(folder / "summary.json");
    const auto summary = nlohmann::json::parse(in, nullptr, /*allow_exceptions=*/false);
    const auto status  = summary.is_object() ? summary.value("status", nlohmann::json()) : nlohmann::json();
    return status.is_string() ? status.get<std::string>() : "";
  }

  bool
  is_free(const fs::path &folder)
  {
    std::error_code error;
    const fs::directory_iterator files(folder, error), end;
    return std::all_of(begin(files), end, [](const auto &file) { return file.path().filename() == study_lock_name; });
  }

  FolderLock::FolderLock(const fs::path &folder, Log &log)
    : FileLock(made(folder) / study_lock_name)
  {
    constexpr std::chrono::milliseconds longest_wait(5000), pause(100);
    State state = lock();
    if (state == State::of_another_process)
      log.line(fmt::format("A run or study is writing to \"{}\"; it may be about to end: waiting for at most {} s",
                           folder.string(),
                           longest_wait.count() / 1000));
    for (auto waited = pause; state == State::of_another_process && waited < longest_wait; waited += pause)
    {
      std::this_thread::sleep_for(pause);
      state = lock();
    }
    if (state == State::of_another_process)
      throw InputError(fmt::format("a run or study is writing to \"{}\"; wait for it to end, or give another folder "
                                   "with --output",
                                   folder.string()));
    if (state == State::not_offered)
      log.warn(fmt::format("warning: this file system has no locks, so nothing keeps another run or study from writing "
                           "to \"{}\"",
                           folder.string()));
  }

  void
  prepare(const fs::path &folder)
  {
    std::error_code error;
    for (const std::string &name : own_names)
      fs::remove(folder / name, error);
    remove_fields(folder);
  }

  void
  remove_runs(const fs::path &folder, const std::string &names)
  {
    const std::regex own_name(names);
    std::error_code error;
    std::vector<fs::path> own;
    for (const auto &entry : fs::directory_iterator(folder, error))
      if (entry.is_directory(error) != entry.path().has_extension() &&
          std::regex_match(entry.path().filename().string(), own_name))
        own.push_back(entry.path());
    for (const fs::path &path : own)
    {
      prepare(path);
      for (const fs::path &rest : {path / "active_stress.csv", path / "solution", path}) // folders only if empty
        fs::remove(rest, error);
    }
    fs::remove(folder, error);
  }

  void
  remove_fields(const fs::path &folder)
  {
    std::error_code error;
    for (const std::string &name : names_of_fields)
      fs::remove(folder / name, error);
    if (fs::is_directory(folder / "solution", error))
      for (const auto &file : fs::directory_iterator(folder / "solution"))
        if (file.path().extension() == ".vtu" || file.path().extension() == ".part")
          fs::remove(file.path(), error);
  }

  StudyFolder::StudyFolder(StudyKind its_kind, const CommandOptions &its_options, Log &its_log)
    : kind(std::move(its_kind))
    , options(its_options)
    , path(output_folder(options.output, options.file))
    , log(its_log)
  {
  }

  bool
  StudyFolder::has_results() const
  {
    std::error_code error;
    return fs::exists(path / kind.results, error);
  }

  bool
  StudyFolder::is_foreign() const
  {
    std::error_code error;
    if (!fs::is_directory(path, error) || fs::is_empty(path, error) || has_results())
      return false;
    return !fs::exists(path / study_lock_name, error) || !has_just_begun(path, {kind.results + ".part"});
  }

  void
  StudyFolder::leaving_if_refused(const std::function<void()> &work)
  {
    try
    {
      work();
    }
    catch (...)
    {
      leave();
      throw;
    }
  }

  bool
  StudyFolder::begin(const std::string &original, const std::string &effective)
  {
    const auto require_own = [&]() {
      if (options.resume && is_foreign())
        throw InputError(
          fmt::format("\"{}\" has no {} that can be resumed; another folder is expected for --output, or --overwrite",
                      path.string(),
                      kind.name));
    };
    require_own();
    require_usable(path, options.resume || options.overwrite);
    lock_.emplace(path, log);
    remove_locks_of_mpi(path);
    leaving_if_refused(require_own); // the previous owner of the lock may have changed it
    if (options.resume && has_results())
      return true;
    prepare(path);
    write_file(path / "original.prm", original);
    write_file(path / "parameters.prm", effective);
    log.open(path / "log.txt");
    return false;
  }

  void
  StudyFolder::resume(const std::function<std::vector<std::string>()> &find_changes)
  {
    leaving_if_refused([&]() { require_unchanged(kind.name, path, find_changes(), kind.free_entries); });
    log.open(path / "log.txt", /*append=*/true);
  }

  void
  StudyFolder::leave()
  {
    if (lock_)
      lock_->remove();
    lock_.reset();
    log.require_written();
  }
} // namespace crawler
