// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/run_journal.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/run/run_checkpoint.h>

#include <filesystem>
#include <optional>
#include <string>

namespace crawler
{
  /// Name of the file in the output folder whose presence asks the run to stop.
  inline const std::string stop_file_name = "stop";

  /// Folder of a run, which only the first rank has, with the states from which the run can resume.
  class RunMemory
  {
  public:
    RunMemory(MPI_Comm communicator, const Input &input, const CommandOptions &options);
    RunMemory(const RunMemory &) = delete;
    ~RunMemory();

    /// Checks the folder and, to resume, locks it and takes up its states (collective). Returns false if the run there
    /// is complete. Throws InputError, FileError.
    bool
    begin(Log &log);

    // Functions of the first rank.
    /// Makes the output folder with the files with which a run begins: parameters, log, and the tables of active stress
    /// and segments if the input asks for them. Throws FileError.
    void
    begin_files(Log &log);

    /// Forgets the fields of a try that is not the answer, and states that would need them, unless the next try
    /// is known.
    void
    forget_fields();

    /// Throws FileError if the folder is not that of this run any more.
    void
    require_in_place() const
    {
      lock_->require_in_place();
    }

    /// Leaves the folder with the present state, or with none if the run @p is_complete.
    void
    leave(Log &log, bool is_complete);

    const std::filesystem::path folder;
    RunJournal journal; ///< of this rank

  private:
    bool
    keep(const std::string &states);

    const MPI_Comm communicator_;
    const Input &input_;
    const CommandOptions &options_;
    std::optional<FolderLock> lock_;
    RunCheckpoint checkpoint_;
    bool goes_on_ = false, has_files_ = false;
  };
} // namespace crawler
