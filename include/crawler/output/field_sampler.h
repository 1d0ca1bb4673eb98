// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/assembler.h>
#include <crawler/equation/general_sampler.h>

namespace crawler
{
  /// Output fields at a list of points, in the user's units.
  struct Fields
  {
    std::vector<double> position, displacement, stretch, velocity, active_stress, elastic_stress, friction_force;
  };

  /// Name of a field in files, and its unit.
  struct FieldName
  {
    const char *name, *unit;
    std::vector<double> Fields::*values;
    bool in_kymograph;
    bool has_peaks; ///< a jump of the active stress makes it large for an instant
  };
  constexpr FieldName field_names[] = {
    {"stretch", "1", &Fields::stretch, true, false},
    {"position", "length", &Fields::position, false, false},
    {"displacement", "length", &Fields::displacement, true, false},
    {"velocity", "length/time", &Fields::velocity, true, true},
    {"active_stress", "force", &Fields::active_stress, true, false},
    {"elastic_stress", "force", &Fields::elastic_stress, false, false},
    {"friction_force", "force/length", &Fields::friction_force, true, true},
  };

  /// Evaluates the fields at points inside this rank's cells.
  class FieldSampler
  {
  public:
    /// @p points: in cells numbered among this rank's.
    FieldSampler(const Assembler &assembler, const Units &units, std::vector<CellPlace> points);

    /// The fields of the state @p y with the velocity @p v (collective). Throws NonfiniteStress.
    const Fields &
    sample(double t, std::span<const double> y, std::span<const double> v);

    /// Material coordinates of the points [length].
    const std::vector<double> &
    coordinates() const
    {
      return coordinates_;
    }

  private:
    const Assembler &assembler_;
    const Units units_;
    const std::vector<CellPlace> points_;
    std::vector<double> coordinates_;
    std::vector<double> values_;   ///< [point][node] shape functions
    const StretchSampler stretch_; ///< at the x of the points
    std::unique_ptr<ActiveStressAtPoints> stress_;
    std::unique_ptr<GeneralSampler> general_; ///< of a general scene
    std::vector<double> u_local_, v_local_;
    Fields fields_;
  };
} // namespace crawler
