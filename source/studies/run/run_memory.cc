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
    : folder(output_folder(options.output, options.file))
    , journal(input.parameters.time.checkpoint_interval,
              rank_of(communicator) == 0 ? [this](const std::string &states) { return keep(states); }
                                         : RunJournal::Write())
    , communicator_(communicator)
    , input_(input)
    , options_(options)
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
      require_usable(folder, options_.overwrite || options_.resume);
      checkpoint_ = checkpoint_of(input_, options_);
      if (!options_.resume)
        return std::string();
      lock_.emplace(folder, log);
      Resumption found = resumption_of(folder, checkpoint_);
      return archived(found);
    }));
    if (!options_.resume)
      return true;
    Resumption resumption;
    known(resumption);
    report(log, resumption, folder);
    goes_on_ = resumption.kind == Resumption::goes_on;
    if (goes_on_)
      journal.load(resumption.journal);
    return resumption.kind != Resumption::is_whole;
  }

  void
  RunMemory::begin_files(Log &log)
  {
    if (!lock_)
    {
      lock_.emplace(folder, log);
      require_usable(folder, options_.overwrite || is_free(folder)); // the previous owner may have written
    }
    if (!goes_on_)
      prepare(folder);
    const OutputParameters &output = input_.parameters.output;
    if (output.has_snapshots() && output.snapshot_format == SnapshotFormat::vtu)
      std::filesystem::create_directories(folder / "solution");
    write_file(folder / "original.prm", input_.file.text());
    write_file(folder / "parameters.prm", input_.effective);
    std::error_code error;
    std::filesystem::remove(folder / stop_file_name, error);
    log.open(folder / "log.txt", /*append=*/goes_on_);
    if (output.segment_table > 0)
      write_segment_tables(
        folder, *input_.scene.active_stress, input_.scene.end_time, output.segment_table, input_.parameters.units);
    if (const std::vector<double> &size = output.active_stress_table; !size.empty())
      if (const std::string problem = write_active_stress_table(folder / "active_stress.csv",
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
    if (journal.knows_next()) // the fields are those of the next try already
      return;
    if (journal.was_written()) // older states need the files that are about to be removed
    {
      remove_checkpoints(folder);
      journal.write();
    }
    remove_fields(folder);
  }

  void
  RunMemory::leave(Log &log, const bool is_complete)
  {
    if (is_complete)
      remove_checkpoints(folder);
    else if (journal.was_written())
      log.line("The state of the run is in restart.dat: the same command with --resume continues it.");
  }

  bool
  RunMemory::keep(const std::string &states)
  {
    if (!has_files_)
      return false;
    lock_->require_in_place();
    checkpoint_.journal = states;
    write_checkpoint(folder, checkpoint_);
    reach(StopPlace::state);
    return true;
  }
} // namespace crawler
