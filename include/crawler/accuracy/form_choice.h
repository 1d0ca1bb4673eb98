// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/run_parameters.h>

/**
 * Choice of the cheaper form, as measured by `stretch_table trade` (doc/numerics.md, "Which form"): the position form
 * is of high order where the body deforms smoothly, the stretch form of second order everywhere. So the limits fall
 * with Accuracy.
 */
namespace crawler
{
  /// True if the user's settings leave the form open, and the stretch form can compute the scene.
  bool
  may_be_stretch_form(const RunParameters &parameters, const Scene &scene);

  /// True if a body of this stiffness k T/(gamma L^2) is for the stretch form, because of its thin layers. Steep
  /// friction, with the @p exponent a, makes them thinner.
  bool
  is_soft(double stiffness, double exponent, double accuracy);

  /// True if the stretch form is cheaper than many cells of the position form, where few are not enough. @p lengths of
  /// the active stress fit on the body.
  bool
  is_cheaper_than_many_cells(double lengths, double accuracy);

  /// True if a body with this smallest stretch is for the stretch form.
  bool
  empties(double smallest_stretch, double exponent, double accuracy);
} // namespace crawler
