// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/sweep/sweep_folder.h>
#include <crawler/studies/sweep/sweep_inputs.h>
#include <crawler/studies/sweep/sweep_rows.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <thread>

namespace crawler
{
  const std::string sweep_group = "results";

  namespace
  {
    namespace fs = std::filesystem;


    /// How a value of the table is shown.
    std::string
    text_of(const Column &column, const unsigned long row)
    {
      if (const auto *texts = std::get_if<std::vector<std::string>>(&column.values))
        return (*texts)[row];
      return to_text(std::get<std::vector<double>>(column.values)[row]);
    }

    /// The first point whose value on an axis is not that of the table, in words; nothing if there is none.
    std::string
    changed_value(const RowReader &table, const std::vector<RowFile::Column> &columns, const SweepDesign &design)
    {
      constexpr unsigned long together = 1 << 16;
      const RowFile::Known known       = known_columns(columns, design);
      for (std::size_t i = 1; i < known.n_columns; ++i)
        for (unsigned long first = 0; first < table.n_rows(); first += together)
        {
          const unsigned long n = std::min(together, table.n_rows() - first);
          const Column column   = table.read(table.index_of(columns[i].name), first, n);
          for (unsigned long row = 0; row < n; ++row)
          {
            const std::string was = text_of(column, row);
            std::string is        = design.value(i - 1, first + row);
            if (columns[i].width == 0)
              is = to_text(*to_number(is));
            // A text that is longer than its column was cut.
            if (was != is && !(columns[i].width > 0 && is.size() > columns[i].width && is.starts_with(was)))
              return fmt::format("{} of point {} was \"{}\" and is \"{}\"", columns[i].name, first + row, was, is);
          }
        }
      return "";
    }
    /// The folders of points, but for files that are not the program's.
    void
    remove_kept_fields(const fs::path &points)
    {
      std::error_code error;
      if (!fs::is_directory(points, error))
        return;
      std::vector<fs::path> folders;
      for (const auto &entry : fs::directory_iterator(points))
        if (entry.is_directory() && to_number(entry.path().filename().string()))
          folders.push_back(entry.path());
      for (const fs::path &folder : folders)
      {
        prepare(folder);
        fs::remove(folder / "solution", error); // these if they are empty
        fs::remove(folder, error);
      }
      fs::remove(points, error);
    }
  } // namespace

  SweepFolder::SweepFolder(fs::path path, const CommandOptions &options, Log &log)
    : path_(std::move(path))
    , options_(options)
    , log_(log)
  {
  }

  SweepFolder::State
  SweepFolder::state() const
  {
    static const std::set<std::string> early = {sweep_lock_name,
                                                "original.prm",
                                                "original.prm.part",
                                                "parameters.prm",
                                                "parameters.prm.part",
                                                "log.txt",
                                                "results.h5.part"};
    std::error_code error;
    if (!fs::is_directory(path_, error) || fs::is_empty(path_, error))
      return State::empty;
    if (fs::exists(path_ / "results.h5", error))
      return State::computed;
    bool is_begun = fs::exists(path_ / sweep_lock_name, error);
    for (const auto &file : fs::directory_iterator(path_))
      is_begun = is_begun && early.contains(file.path().filename().string());
    return is_begun ? State::begun : State::foreign;
  }

  void
  SweepFolder::lock()
  {
    constexpr std::chrono::milliseconds longest_wait(5000), pause(100);
    lock_.emplace(path_ / sweep_lock_name);
    FileLock::State state = lock_->lock();
    if (state == FileLock::State::of_another_process)
      log_.line(fmt::format("Another sweep writes to \"{}\"; it may be about to end: waiting for {} s at most",
                            path_.string(),
                            longest_wait.count() / 1000));
    for (auto waited = pause; state == FileLock::State::of_another_process && waited < longest_wait; waited += pause)
    {
      std::this_thread::sleep_for(pause);
      state = lock_->lock();
    }
    if (state == FileLock::State::of_another_process)
      throw InputError(fmt::format("another sweep writes to \"{}\"; another folder is expected for --output, or that "
                                   "the other sweep has ended",
                                   path_.string()));
    if (state == FileLock::State::not_offered)
      log_.warn(fmt::format("warning: this file system has no locks, so nothing keeps another sweep from writing to "
                            "\"{}\"",
                            path_.string()));
  }

  std::vector<bool>
  SweepFolder::begin_or_resume(const ParameterFile &file,
                               const SweepPoints &points,
                               const std::vector<RowFile::Column> &columns)
  {
    const auto require_own = [&]() {
      if (options_.resume && state() == State::foreign)
        throw InputError("\"" + path_.string() +
                         "\" has no sweep that could be resumed; another folder is expected for --output, or "
                         "--overwrite");
    };
    require_own();
    require_usable(path_, options_.resume || options_.overwrite);
    const SweepInputs inputs = sweep_inputs(points);
    std::error_code error;
    fs::create_directories(path_, error);
    if (error)
      throw FileError("cannot make the output folder \"" + path_.string() + "\": " + error.message());
    lock();
    require_own(); // the one that had the lock may have changed it
    if (options_.resume && state() == State::computed)
    {
      const auto done = rows_that_are_there(points, columns);
      log_.open(path_ / "log.txt", /*append=*/true);
      return done;
    }
    prepare(path_);
    remove_kept_fields(path_ / "points"); // of an earlier sweep
    write_file(path_ / "original.prm", file.text());
    write_file(path_ / "parameters.prm", points.effective());
    log_.open(path_ / "log.txt");
    auto attributes         = provenance(points.effective(), options_.command_line);
    attributes["not known"] = "NaN in numbers, an empty text in texts; an empty status: not computed yet";
    attributes.merge(inputs.attributes());
    const unsigned long n = points.design().n_points();
    RowFile::create(path_ / "results.h5", sweep_group, columns, n, attributes, known_columns(columns, points.design()));
    return std::vector<bool>(n, false);
  }

  std::vector<bool>
  SweepFolder::rows_that_are_there(const SweepPoints &points, const std::vector<RowFile::Column> &columns)
  {
    const fs::path path = path_ / "results.h5";
    const auto inputs   = sweep_inputs(points);
    std::map<std::string, std::string> attributes;
    for (const auto &[name, text] : inputs.attributes())
      attributes.emplace(name, read_attribute(path, sweep_group, name));
    auto changes = differences(SweepInputs::from_attributes(attributes), inputs);
    const RowReader table(MPI_COMM_SELF, path, sweep_group);
    if (const unsigned long n = points.design().n_points(); changes.empty() && table.n_rows() != n)
      changes.push_back(fmt::format("the number of points was {} and is {}", table.n_rows(), n));
    if (changes.empty())
      if (const std::string changed = changed_value(table, columns, points.design()); !changed.empty())
        changes.push_back(changed);
    if (!changes.empty())
      throw InputError(fmt::format("the sweep in \"{}\" was made with other parameters: {}; it can be resumed with the "
                                   "same ones only (but for {})",
                                   path_.string(),
                                   fmt::join(changes, ", "),
                                   fmt::join(free_sweep_entries, " and ")));
    for (const auto &[name, version] : provenance(points.effective(), ""))
      if (name.starts_with("version of "))
        if (const std::string was = read_attribute(path, sweep_group, name); was != version)
          log_.warn(fmt::format("warning: the {} was {} when the sweep began and is {}: new rows may differ from old "
                                "ones by round-off or more",
                                name,
                                was,
                                version));

    // What ran out of a time limit that is larger now is computed again.
    constexpr double larger          = 1.2;
    constexpr unsigned long together = 1 << 16;
    const double limit               = points.sweep().point_time_limit.value_or(HUGE_VAL);
    std::vector<bool> done;
    for (unsigned long first = 0; first < table.n_rows(); first += together)
    {
      const unsigned long n = std::min(together, table.n_rows() - first);
      const Column status   = table.read(table.index_of("status"), first, n),
                   reason   = table.read(table.index_of("reason"), first, n),
                   seconds  = table.read(table.index_of("seconds"), first, n);
      for (unsigned long i = 0; i < n; ++i)
        done.push_back(!text_of(status, i).empty() &&
                       !(text_of(reason, i) == time_limit_reason &&
                         limit > larger * std::get<std::vector<double>>(seconds.values)[i]));
    }
    return done;
  }

  void
  SweepFolder::leave()
  {
    if (lock_)
      lock_->remove();
  }
} // namespace crawler
