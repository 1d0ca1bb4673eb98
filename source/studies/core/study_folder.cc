// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/study_folder.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>

namespace crawler
{
  namespace fs = std::filesystem;

  StudyFolder::StudyFolder(StudyKind its_kind, fs::path its_path, const CommandOptions &options, Log &its_log)
    : kind(std::move(its_kind))
    , path(std::move(its_path))
    , log(its_log)
    , options_(options)
  {
    if (options_.resume && options_.overwrite)
      throw InputError("--resume and --overwrite contradict each other; one of them is expected");
  }

  bool
  StudyFolder::has_results() const
  {
    return std::ranges::any_of(kind.results, [&](const std::string &name) {
      std::error_code error;
      return fs::exists(path / name, error);
    });
  }

  bool
  StudyFolder::is_foreign() const
  {
    std::error_code error;
    if (!fs::is_directory(path, error) || fs::is_empty(path, error) || has_results())
      return false;
    std::set<std::string> unfinished;
    for (const std::string &name : kind.results)
      unfinished.insert(name + ".part");
    return !fs::exists(path / study_lock_name, error) || !has_just_begun(path, unfinished);
  }

  void
  StudyFolder::remove_locks_of_mpi() const
  {
    const auto is_lock = [](const std::string &name) {
      return name.ends_with(".lock") && (name.find(".h5-") != name.npos || name.find(".h5.part-") != name.npos);
    };
    std::vector<fs::path> locks;
    for (const auto &file : fs::directory_iterator(path))
      if (is_lock(file.path().filename().string()))
        locks.push_back(file.path());
    std::error_code ignored; // remaining locks are harmless
    for (const auto &file : locks)
      fs::remove(file, ignored);
  }

  void
  StudyFolder::lock()
  {
    constexpr std::chrono::milliseconds longest_wait(5000), pause(100);
    lock_.emplace(path / study_lock_name);
    FileLock::State state = lock_->lock();
    if (state == FileLock::State::of_another_process)
      log.line(fmt::format("Another study is writing to \"{}\"; it may be about to end: waiting for at most {} s",
                           path.string(),
                           longest_wait.count() / 1000));
    for (auto waited = pause; state == FileLock::State::of_another_process && waited < longest_wait; waited += pause)
    {
      std::this_thread::sleep_for(pause);
      state = lock_->lock();
    }
    if (state == FileLock::State::of_another_process)
      throw InputError(fmt::format(
        "another study is writing to \"{}\"; wait for it to end, or give another folder with --output", path.string()));
    if (state == FileLock::State::not_offered)
      log.warn(fmt::format("warning: this file system has no locks, so nothing keeps another study from writing to "
                           "\"{}\"",
                           path.string()));
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
      if (options_.resume && is_foreign())
        throw InputError(
          fmt::format("\"{}\" has no {} that can be resumed; another folder is expected for --output, or --overwrite",
                      path.string(),
                      kind.name));
    };
    require_own();
    require_usable(path, options_.resume || options_.overwrite);
    make_folder(path);
    lock();
    remove_locks_of_mpi();
    leaving_if_refused(require_own); // the previous owner of the lock may have changed it
    if (options_.resume && has_results())
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
