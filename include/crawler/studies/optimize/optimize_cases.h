// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/optimize/scene_family.h>
#include <crawler/studies/sweep/sweep_inputs.h>
#include <crawler/studies/sweep/sweep_points.h>

#include <memory>
#include <string>
#include <vector>

namespace crawler
{
  /// Cases, variables, objective and limits of an optimisation, as its tables name them.
  struct OptimizeNames
  {
    struct Case
    {
      std::vector<std::string> values; ///< of the axes, as they stand in a parameter file
      std::vector<std::string> paths;  ///< of the variables
      double sign;                     ///< of the wanted direction
    };
    std::vector<std::string> axes;
    std::vector<Case> cases;
    std::vector<std::string> paths, units; ///< of the variables of any case
    std::vector<std::string> limits;       ///< entries that limit any case
    std::string objective, unit;           ///< and its unit
  };

  /// The problems that an optimisation solves one by one: the points of section Sweep, or the file as it is where that
  /// has no axes.
  class OptimizeCases
  {
  public:
    /// Reads the design and the variables of all cases (collective). Throws InputError, with the place in the file.
    OptimizeCases(MPI_Comm communicator, const ParameterFile &file);

    unsigned long
    size() const
    {
      return points_ ? points_->design().n_points() : 1;
    }

    /// The scenes of a case. One at a time: it goes before the next one comes.
    std::unique_ptr<SceneFamily>
    family(unsigned long number);

    const OptimizeNames &
    names() const
    {
      return names_;
    }
    bool
    are_several() const
    {
      return !names_.axes.empty();
    }

    /// The cases next to a case (SweepDesign::neighbours()).
    std::vector<unsigned long>
    neighbours(unsigned long number) const
    {
      return points_ ? points_->design().neighbours(number) : std::vector<unsigned long>();
    }

    /// "Section/Entry = value, ..." of a case, with the last names only; empty if there are no axes.
    std::string
    in_words(unsigned long number) const;

    /// The entries of the file itself.
    const Parameters &
    parameters() const
    {
      return file_form_.parameters;
    }
    const Declarations &
    declarations() const
    {
      return file_form_.declarations;
    }

    /// On entries without an effect in any case.
    std::vector<std::string>
    notes(const ParameterFile &file);

    /// What the gaits depend on (one process: reads files). Throws FileError.
    SweepInputs
    inputs() const;

    /// All entries as they are used, but for the axes, as a .prm file.
    std::string
    effective() const;

  private:
    void
    add_case(unsigned long number);

    Form file_form_;
    std::unique_ptr<SweepPoints> points_; ///< if there are axes
    OptimizeNames names_;
  };
} // namespace crawler
