// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/versions.h>
#include <crawler/studies/core/form.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/run/run_checkpoint.h>

#include <boost/crc.hpp>
#include <fmt/format.h>

#include <optional>

namespace crawler
{
  namespace fs = std::filesystem;

  namespace
  {
    const std::string present_name = "restart.dat", older_name = "restart.old.dat";
    /// Entries that determine how a run is made, not its results.
    const std::vector<std::string> free_entries = {"Time/Wall time limit", "Time/Checkpoint interval"};

    std::string
    heading(const std::string &content)
    {
      boost::crc_32_type crc;
      crc.process_bytes(content.data(), content.size());
      return fmt::format("crawler state, {} bytes, CRC-32 {:08x}\n", content.size(), crc.checksum());
    }

    /// Reads a checkpoint; nothing if there is no such file. Throws FileError if it is not whole.
    std::optional<RunCheckpoint>
    read(const fs::path &path)
    {
      std::error_code error;
      if (!fs::exists(path, error))
        return std::nullopt;
      const std::string text  = read_whole_file(path);
      const std::size_t first = text.find('\n') + 1;
      if (first == 0 || text.substr(0, first) != heading(text.substr(first)))
        throw FileError("\"" + path.string() + "\" is damaged: its checksum differs");
      RunCheckpoint checkpoint;
      Archive archive(text.substr(first));
      archive(checkpoint.program);
      if (checkpoint.program != versions_in_words())
        throw FileError("\"" + path.string() + "\" was written by another version of the program (" +
                        checkpoint.program + ")");
      Archive whole(text.substr(first));
      whole(checkpoint);
      return checkpoint;
    }

    /// Reads the newer checkpoint that is whole.
    std::optional<RunCheckpoint>
    read_newest(const fs::path &folder, std::vector<std::string> &notes)
    {
      for (const std::string &name : {present_name, older_name})
        try
        {
          if (auto checkpoint = read(folder / name))
            return checkpoint;
        }
        catch (const FileError &problem)
        {
          notes.emplace_back(problem.what());
        }
      return std::nullopt;
    }

    /// Throws InputError if the content of the folder is that of another command, or of unknown origin.
    void
    require_run(const fs::path &folder)
    {
      std::error_code error;
      const auto has      = [&](const char *name) { return fs::exists(folder / name, error); };
      const bool is_study = has("results.h5") || has("tradeoff.h5");
      if (!has_just_begun(folder, {"solution"}) && (is_study || !has("parameters.prm") || !has("log.txt")))
        throw InputError(
          fmt::format("\"{}\" has no run that can be resumed; another folder is expected for --output, or --overwrite",
                      folder.string()));
    }
  } // namespace

  RunCheckpoint
  checkpoint_of(const Input &input, const CommandOptions &options)
  {
    RunCheckpoint checkpoint{versions_in_words(), input.effective, options.petsc_options, {}, ""};
    const Form form(input.file);
    for (unsigned int i = 0; i < form.declarations.entries().size(); ++i)
    {
      const std::string name = form.declarations.value(i);
      std::error_code error;
      if (form.declarations.entries()[i].names_file && !name.empty() && fs::is_regular_file(name, error))
        checkpoint.files.emplace_back(name, fingerprint(name));
    }
    return checkpoint;
  }

  void
  write_checkpoint(const fs::path &folder, RunCheckpoint &checkpoint)
  {
    const std::string content = archived(checkpoint);
    const fs::path next       = folder / (present_name + ".new");
    write_file(next, heading(content) + content);
    std::error_code error;
    if (fs::exists(folder / present_name, error))
      fs::rename(folder / present_name, folder / older_name, error);
    rename_whole(next, folder / present_name);
  }

  void
  remove_checkpoints(const fs::path &folder)
  {
    std::error_code error;
    for (const std::string &name : {present_name, older_name})
      fs::remove(folder / name, error);
  }

  Resumption
  resumption_of(const fs::path &folder, const RunCheckpoint &own)
  {
    require_run(folder);
    Resumption result;
    auto checkpoint = read_newest(folder, result.notes);
    std::error_code error;
    std::string before = checkpoint ? checkpoint->effective : "";
    if (!checkpoint && fs::exists(folder / "parameters.prm", error))
      before = read_whole_file(folder / "parameters.prm");
    if (before.empty())
      return result;
    std::vector<std::string> changes = differences(before, own.effective, free_entries);
    if (checkpoint)
    {
      if (checkpoint->petsc_options != own.petsc_options)
        changes.push_back(fmt::format(
          "the options after \"--\" were \"{}\" and are \"{}\"", checkpoint->petsc_options, own.petsc_options));
      if (checkpoint->files != own.files)
        changes.emplace_back("a file that the parameters name has changed");
    }
    require_unchanged("run", folder, changes, free_entries);
    if (status_in(folder) == "finished")
      result.kind = Resumption::is_whole;
    else if (checkpoint)
    {
      result.kind    = Resumption::goes_on;
      result.journal = std::move(checkpoint->journal);
    }
    return result;
  }
} // namespace crawler
