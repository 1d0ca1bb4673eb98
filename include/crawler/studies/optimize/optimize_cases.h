// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/optimize/scene_family.h>
#include <crawler/studies/sweep/sweep_inputs.h>
#include <crawler/studies/sweep/sweep_points.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
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

    /// The smallest and the largest number of variables of a case.
    std::pair<std::size_t, std::size_t>
    n_variables() const
    {
      return n_variables_;
    }

    /// The scenes of a case. One at a time: it goes before the next one comes.
    std::unique_ptr<SceneFamily>
    family(unsigned long number);

    /// What varies over the cases, and the values of one as they stand in a parameter file.
    const std::vector<std::string> &
    axes() const
    {
      return axes_;
    }
    std::vector<std::string>
    values(unsigned long number) const;

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
    Form file_form_;
    std::unique_ptr<SweepPoints> points_; ///< if there are axes
    std::vector<std::string> axes_;
    std::pair<std::size_t, std::size_t> n_variables_;
  };
} // namespace crawler
