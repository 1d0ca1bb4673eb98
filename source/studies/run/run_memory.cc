// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/stop_place.h>
#include <crawler/output/active_stress_table.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/run/run_memory.h>

#include <fmt/format.h>

namespace crawler
{
  namespace
  {
    void
    report(Log &log, const Resumption &resumption, const std::filesystem::path &folder)
    {
      for (const std::string &note : resumption.notes)
        log.warn("warning: " + note);
      log.line(
        resumption.kind == Resumption::begins
          ? fmt::format("There is no state in \"{}\" from which the run can resume: it starts from the beginning.",
                        folder.string())
        : resumption.kind == Resumption::goes_on
          ? "The run resumes from the state in restart.dat."
          : fmt::format("The run in \"{}\" is complete; nothing was computed.", folder.string()));
    }
  } // namespace

  RunMemory::RunMemory(MPI_Comm communicator, const Input &input, const CommandOptions &options)
    : communicator_(communicator)
    , input_(input)
    , options_(options)
    , folder_(output_folder(options.output, options.file))
    , journal_(input.parameters.time.checkpoint_interval,
               rank_of(communicator) == 0 ? [this](const std::string &states) { return keep(states); }
                                          : RunJournal::Write())
  {
  }

  RunMemory::~RunMemory()
  {
    if (lock_)
      lock_->remove();
  }

  bool
  RunMemory::begin(Log &log)
  {
    Archive known(on_first_rank(communicator_, [&]() {
      require_usable(folder_, options_.overwrite || options_.resume);
      checkpoint_ = checkpoint_of(input_, options_);
      if (!options_.resume)
        return std::string();
      lock_.emplace(folder_, log);
      Resumption found = resumption_of(folder_, checkpoint_);
      return archived(found);
    }));
    if (!options_.resume)
      return true;
    Resumption resumption;
    known(resumption);
    report(log, resumption, folder_);
    goes_on_ = resumption.kind == Resumption::goes_on;
    if (goes_on_)
      journal_.load(resumption.journal);
    return resumption.kind != Resumption::is_whole;
  }

  void
  RunMemory::begin_files(Log &log)
  {
    if (!lock_)
    {
      lock_.emplace(folder_, log);
      require_usable(folder_, options_.overwrite || is_free(folder_)); // the previous owner may have written
    }
    if (!goes_on_)
      prepare(folder_);
    const OutputParameters &output = input_.parameters.output;
    if (output.has_snapshots() && output.snapshot_format == SnapshotFormat::vtu)
      std::filesystem::create_directories(folder_ / "solution");
    write_file(folder_ / "original.prm", input_.file.text());
    write_file(folder_ / "parameters.prm", input_.effective);
    std::error_code error;
    std::filesystem::remove(folder_ / stop_file_name, error);
    log.open(folder_ / "log.txt", /*append=*/goes_on_);
    if (output.segment_table > 0)
      write_segment_tables(
        folder_, *input_.scene.active_stress, input_.scene.end_time, output.segment_table, input_.parameters.units);
    if (const std::vector<double> &size = output.active_stress_table; !size.empty())
      if (const std::string problem = write_active_stress_table(folder_ / "active_stress.csv",
                                                                *input_.scene.active_stress,
                                                                input_.scene.body.length,
                                                                input_.scene.end_time,
                                                                static_cast<unsigned int>(size[0]),
                                                                static_cast<unsigned int>(size[1]));
          !problem.empty())
        log.warn("warning: active_stress.csv is not written: " + problem);
    has_files_ = true;
  }

  void
  RunMemory::forget_fields()
  {
    if (journal_.was_written()) // older states need the files that are about to be removed
    {
      remove_checkpoints(folder_);
      journal_.write();
    }
    remove_fields(folder_);
  }

  void
  RunMemory::leave(Log &log, const bool is_complete)
  {
    if (is_complete)
      remove_checkpoints(folder_);
    else if (journal_.was_written())
      log.line("The state of the run is in restart.dat: the same command with --resume continues it.");
  }

  bool
  RunMemory::keep(const std::string &states)
  {
    if (!has_files_)
      return false;
    lock_->require_in_place();
    checkpoint_.journal = states;
    write_checkpoint(folder_, checkpoint_);
    reach(StopPlace::state);
    return true;
  }
} // namespace crawler
