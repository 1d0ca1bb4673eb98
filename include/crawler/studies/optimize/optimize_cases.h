// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/optimize/scene_family.h>
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
      std::vector<std::string> values; ///< values of the axes, as written in a parameter file
      std::vector<std::string> paths;  ///< paths of the variables
      GaitObjective objective;
    };
    std::vector<std::string> axes;
    std::vector<Case> cases;
    std::vector<std::string> paths, units; ///< variables of any case
    std::vector<std::string> limits;       ///< entries that limit any case
    GaitObjective objective;               ///< objective of all, but for the wanted direction
  };

  /// Problems that an optimisation solves one by one: the points of section Sweep.
  class OptimizeCases
  {
  public:
    /// Reads the design and the variables of all cases (collective). Throws InputError, with the place in the file.
    OptimizeCases(MPI_Comm communicator, const ParameterFile &file);

    unsigned long
    size() const
    {
      return points_.design().n_points();
    }

    /// Scenes of a case. One at a time: it must be destroyed before the next one is made.
    std::unique_ptr<SceneFamily>
    family(const unsigned long number)
    {
      return std::make_unique<SceneFamily>(points_.form(number));
    }

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

    /// Values of a case, "Section/Entry = value, ...", with the last names only; empty if there are no axes.
    std::string
    in_words(unsigned long number) const;

    /// Entries of the file itself.
    const Parameters &
    parameters() const
    {
      return points_.own_parameters();
    }
    /// Notes on entries without an effect in any case.
    std::vector<std::string>
    notes(const ParameterFile &file);

    /// The cases as points of a design.
    const SweepPoints &
    points() const
    {
      return points_;
    }

  private:
    void
    add_case(unsigned long number);

    SweepPoints points_;
    OptimizeNames names_;
  };
} // namespace crawler
