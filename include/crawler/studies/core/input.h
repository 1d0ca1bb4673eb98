// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/model_choice.h>
#include <crawler/run/numerics.h>
#include <crawler/studies/core/sensitivity_entries.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace crawler
{
  /// A parameter file, read and understood.
  struct Input
  {
    ParameterFile file;
    Parameters parameters;
    std::string effective; ///< all entries as they are used, as a .prm file
    Scene scene;
    std::vector<SensitivityEntry> sensitivities;
    std::vector<std::string> notes; ///< what is perhaps not meant: entries without effect, tables beyond the body
  };

  /// Reads @p file_name on rank 0 and gives it to all (collective). Throws InputError or FileError, on all ranks.
  ParameterFile
  read_file(MPI_Comm communicator, const std::string &file_name, const std::vector<std::string> &overrides);

  /// The same, understood: the scene is built too. Notes say what has no effect in @p command.
  Input
  read_input(ParameterFile file, const std::string &command = "run");

  /// Notes on entries that have no effect since the program has chosen another level, mesh or method than they are for.
  std::vector<std::string>
  notes_on_choice(const Input &input, Model model, const Numerics *numerics = nullptr);

  /// model_choice.h; messages say where in the file the entry at fault is.
  ModelChoice
  choose_model(const Input &input);
} // namespace crawler
