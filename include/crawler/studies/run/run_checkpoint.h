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
  /// What a run leaves in its folder so that it can go on: restart.dat, and the one before it, restart.old.dat.
  struct RunCheckpoint
  {
    std::string program;                                    ///< who wrote it
    std::string effective;                                  ///< parameters
    std::string petsc_options;                              ///< behind "--"
    std::vector<std::pair<std::string, std::string>> files; ///< that were read, with their fingerprints
    std::string journal;                                    ///< of the runs (run_journal.h)

    void
    exchange(Archive &archive)
    {
      archive(program, effective, petsc_options, files, journal);
    }
  };

  /// That of this program and input, without a journal.
  RunCheckpoint
  checkpoint_of(const Input &input, const CommandOptions &options);

  /// Writes a new file first, then gives it its name; the older one stays under the other name. Throws FileError.
  void
  write_checkpoint(const std::filesystem::path &folder, RunCheckpoint &checkpoint);

  void
  remove_checkpoints(const std::filesystem::path &folder);

  /// What `--resume` finds in a folder.
  struct Resumption
  {
    enum Kind
    {
      begins,   ///< there is nothing to go on with
      goes_on,  ///< with the journal
      is_whole, ///< the run has ended
    } kind = begins;
    std::string journal;
    std::vector<std::string> notes; ///< what the user should know

    void
    exchange(Archive &archive)
    {
      archive(kind, journal, notes);
    }
  };

  /// Looks at a folder that is locked. Throws InputError if what is there belongs to another command or other
  /// parameters.
  Resumption
  resumption_of(const std::filesystem::path &folder, const RunCheckpoint &own);
} // namespace crawler
