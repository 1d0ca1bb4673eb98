// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/model_choice.h>
#include <crawler/run/numerics.h>
#include <crawler/studies/core/scene_numbers.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace crawler
{
  /// Parameter file, read and interpreted.
  struct Input
  {
    ParameterFile file;
    Parameters parameters;
    std::string effective; ///< all entries as used, as a .prm file
    Scene scene;
    std::vector<SensitivityEntry> sensitivities;
    std::vector<std::string> notes; ///< possible mistakes: entries without effect, tables beyond the body
  };

  /// Reads @p file_name on rank 0 and sends it to all (collective). Throws InputError or FileError, on all ranks.
  ParameterFile
  read_file(MPI_Comm communicator, const std::string &file_name, const std::vector<std::string> &overrides);

  /// Interprets a parameter file and builds the scene. Notes name entries that have no effect in @p command.
  Input
  read_input(ParameterFile file, const std::string &command = "run");

  /// Notes on entries that have no effect since the program has chosen another level, mesh or method than they are for.
  std::vector<std::string>
  notes_on_choice(const Input &input, Model model, const Numerics *numerics = nullptr);

  /// Chooses the level (model_choice.h); messages say where in the file the entry at fault is.
  ModelChoice
  choose_model(const Input &input);
} // namespace crawler
