// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/numerics.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace crawler
{
  /// Settings, and the reason for them in a sentence.
  struct NumericsChoice
  {
    Numerics numerics;
    std::string explanation;
    /// Accuracy times the size of the displacement [length]; not a number if the user chose the numerics.
    double wanted_error = std::numeric_limits<double>::quiet_NaN();
    /// Share of the mesh in the error, as far as the rule can tell; not a number if it cannot [1].
    double space_share = std::numeric_limits<double>::quiet_NaN();
    /// Floor of the reported error, for the part that the indicators cannot see [length].
    double min_error = 0.;
    /// True if the active stress is not smooth along the body: finer meshes have errors that are not much smaller
    bool is_rough = false;
    /// True if errors of a smooth active stress fall slowly with the cells, as pilots measured: fronts of friction
    bool is_steep = false;
    /// True if the user set cells or tolerances
    bool is_users = false;
    /// Error of the displacement, if it was measured on successive meshes: jumps of the active stress move [length]
    std::optional<double> measured_error;
    /// Stretch form: its runs on a family of meshes measure the error (mesh_family.h). They begin with `numerics`,
    /// whose time tolerance is meant for this strain [1].
    bool is_family = false;
    double strain  = 0.;
    /// Fronts in place of moving jumps of the active stress (moving_fronts.h): a run alone has fronts of this width,
    /// relative to the widest that fit; 0: the jumps themselves.
    bool has_fronts   = false;
    double front_part = 0.;
    /// Floor of the size of the displacement, known after the run [length]; NaN if the user chose the numerics.
    double min_size = std::numeric_limits<double>::quiet_NaN();
    /// Advice for an Accuracy that is not met; empty if there is none.
    std::string advice;

    /// True if a rule chose the numerics such that the error of one run is the wanted one.
    bool
    follows_rule() const
    {
      return std::isfinite(wanted_error) && !numerics.jumps_move;
    }

    /// True if the answer is made of several runs, of which none is the answer.
    bool
    is_of_several_runs() const
    {
      return is_family || has_fronts;
    }

    /// Sets the size from the run's displacement: corrects the meaning of Accuracy if pilots, or the first strides of
    /// many, were far from it.
    void
    set_size(const double displacement, const double accuracy)
    {
      constexpr double near = 0.2;
      const double wanted   = accuracy * std::max(std::abs(displacement), min_size);
      if (!std::isfinite(min_size) || std::abs(wanted - wanted_error) <= near * wanted_error)
        return;
      wanted_error = wanted;
    }
  };
} // namespace crawler
