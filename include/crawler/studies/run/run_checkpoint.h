// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/studies/core/command_options.h>
#include <crawler/studies/core/input.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /// Checkpoint from which a run can be resumed: restart.dat in its folder, and the previous one, restart.old.dat.
  struct RunCheckpoint
  {
    std::string program;                                    ///< program that wrote it
    std::string effective;                                  ///< parameters
    std::string petsc_options;                              ///< behind "--"
    std::vector<std::pair<std::string, std::string>> files; ///< files read, with their fingerprints
    std::string journal;                                    ///< states of the runs (run_journal.h)

    void
    exchange(Archive &archive)
    {
      archive(program, effective, petsc_options, files, journal);
    }
  };

  /// Checkpoint of this program and input, without a journal.
  RunCheckpoint
  checkpoint_of(const Input &input, const CommandOptions &options);

  /// Writes a new file first, then renames it; the older one stays under the other name. Throws FileError.
  void
  write_checkpoint(const std::filesystem::path &folder, RunCheckpoint &checkpoint);

  void
  remove_checkpoints(const std::filesystem::path &folder);

  /// Findings of `--resume` in a folder.
  struct Resumption
  {
    enum Kind
    {
      begins,   ///< nothing to resume
      goes_on,  ///< resumed with the journal
      is_whole, ///< run that has ended
    } kind = begins;
    std::string journal;
    std::vector<std::string> notes; ///< notes for the user

    void
    exchange(Archive &archive)
    {
      archive(kind, journal, notes);
    }
  };

  /// Examines a folder that is locked. Throws InputError if its content belongs to another command or other parameters.
  Resumption
  resumption_of(const std::filesystem::path &folder, const RunCheckpoint &own);
} // namespace crawler
