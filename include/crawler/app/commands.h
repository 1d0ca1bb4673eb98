// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>
#include <crawler/studies/core/command_options.h>

#include <mpi.h>

#include <CLI/CLI.hpp>

#include <vector>

namespace crawler
{
  /**
   * Commands and options of the command line. Its errors are found, and work without MPI is done, before MPI and PETSc
   * start: they take longer than most runs.
   */
  class Commands
  {
  public:
    Commands();
    Commands(const Commands &) = delete;

    /// Reads the @p arguments, and the @p petsc_options behind "--". Throws InputError. Returns false if nothing else
    /// is to be done: help or version are printed, by the first rank.
    bool
    parse(const std::vector<std::string> &arguments, const std::vector<std::string> &petsc_options);

    /// True if the command computes.
    bool
    needs_mpi() const;

    /// Runs a command that needs no MPI, on one rank. Throws InputError and FileError.
    void
    run_alone();

    /// Runs a command that needs MPI (collective). Throws what the command throws.
    ExitCode
    run(MPI_Comm communicator) const;

  private:
    void
    add_own_commands();

    const std::string &
    chosen() const;

    CLI::App app_;
    CommandOptions options_;
    std::vector<std::string> words_;           ///< words of the command line
    std::string format_ = "prm", name_, kind_; ///< name_ of a template, a shell or a section
    bool plot_help_     = false;
  };
} // namespace crawler
