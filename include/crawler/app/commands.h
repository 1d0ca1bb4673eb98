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
   * All that the command line can say. What is wrong with it is known, and what needs no MPI is done, before MPI and
   * PETSc start: they take longer than most runs.
   */
  class Commands
  {
  public:
    Commands();
    Commands(const Commands &) = delete;

    /// Reads the @p arguments, and the @p petsc_options behind "--". Throws InputError. Returns false if there is
    /// nothing else to do: help or version are printed, by the first rank.
    bool
    parse(const std::vector<std::string> &arguments, const std::vector<std::string> &petsc_options);

    /// Whether the command computes.
    bool
    needs_mpi() const;

    /// The command, if it needs no MPI; on one rank. Throws InputError and FileError.
    void
    run_alone();

    /// The command, if it needs MPI (collective). Throws what it throws.
    ExitCode
    run(MPI_Comm communicator) const;

    const CLI::App &
    app() const
    {
      return app_;
    }

  private:
    void
    add_own_commands();

    const std::string &
    chosen() const;

    void
    check_petsc_options(const std::vector<std::string> &petsc_options) const;

    CLI::App app_;
    CommandOptions options_;
    std::vector<std::string> words_;           ///< of the command line
    std::string format_ = "prm", name_, kind_; ///< name_: of a template, a shell or a section
    bool plot_help_     = false;
  };
} // namespace crawler
