// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/entry_notes.h>
#include <crawler/studies/core/scene_numbers.h>
#include <crawler/studies/sweep/sweep_design.h>

#include <mpi.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace crawler
{
  /// Parameters of all points of a sweep: the parameter file as a form in which the values of the axes are filled in.
  class SweepPoints
  {
  public:
    /// Reads the design and checks all names and values (collective: rank 0 examines the files of a file axis, which
    /// are read again when their points need them). Throws InputError, with the place in the file, also for no axes
    /// unless @p may_be_one, the file as it is.
    SweepPoints(MPI_Comm communicator, const ParameterFile &file, bool may_be_one = false);

    const SweepDesign &
    design() const
    {
      return *design_;
    }
    const SweepParameters &
    sweep() const
    {
      return own_.sweep;
    }

    /// Entries of the file itself, without an axis.
    const Parameters &
    own_parameters() const
    {
      return own_;
    }
    const Declarations &
    declarations() const
    {
      return base_->declarations;
    }

    /// Files on the file axis: their different names, sorted, and one of them, which is read now. Throws InputError,
    /// FileError.
    std::vector<std::string>
    scene_names() const;
    ParameterFile
    scene(const std::string &name) const
    {
      return ParameterFile::read((design_->folder() / name).string());
    }

    /// Entries as used, except for the axes, as a .prm file.
    const std::string &
    effective() const
    {
      return effective_;
    }

    /// Entries that the axes fill in.
    VariedEntries
    varied() const;

    /// Notes on entries without an effect at any point.
    std::vector<std::string>
    notes() const;

    /// Entries of a point; valid until the next call.
    Form &
    form(unsigned long point);
    const Parameters &
    parameters(const unsigned long point)
    {
      return form(point).parameters;
    }

    /// Entries by which the numbers of all points are differentiated.
    const std::vector<SensitivityEntry> &
    sensitivities() const
    {
      return sensitivities_;
    }

    /// Entries of a point as overrides "Section/Entry=value" of a command line: the file of the axis, the user, the
    /// axes.
    std::vector<std::string>
    overrides(unsigned long point) const;

    /// Point numbers in Sweep/Keep fields. Throws InputError if one is not that of a point.
    std::vector<unsigned long>
    kept_points() const;

    /// Throws InputError, with the place in the file, if Sweep/Cross-check is requested where answers cannot be
    /// compared.
    void
    require_checkable();

  private:
    void
    require_scene_files(MPI_Comm communicator) const;
    void
    require_admissible_values();
    void
    require_words();
    void
    require_scene();

    const ParameterFile &file_;
    Parameters own_;
    std::unique_ptr<SweepDesign> design_;
    std::string effective_;
    std::vector<SensitivityEntry> sensitivities_;
    std::size_t file_axis_ = 0;                          ///< number of axes if there is none
    std::unique_ptr<Form> base_;                         ///< form of the file itself
    std::map<std::string, std::unique_ptr<Form>> forms_; ///< forms of the files of the file axis that were needed
                                                         ///< lately
  };
} // namespace crawler
