// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/drivers/parameters.h>
#include <crawler/parameters/declarations.h>

namespace crawler
{
  void
  Parameters::add_parameters(Declarations &declarations)
  {
    declarations.choice("Model", model, {"nonlinear"}, "The model: the full nonlinear equation.");
    declarations.number(
      "Accuracy",
      accuracy,
      between(1e-12, 0.1),
      "Wanted relative error of the displacement. Chooses degree, cells and time tolerance where they "
      "are automatic (doc/numerics.md).",
      "1");
    body.add_parameters(declarations);
    active_stress.add_parameters(declarations);
    discretization.add_parameters(declarations);
    time.add_parameters(declarations);
    output.add_parameters(declarations);
    atlas.add_parameters(declarations);
  }

  Scene
  Parameters::create_scene() const
  {
    time.validate();
    return {body,
            std::make_unique<PowerFriction>(body.friction_coefficient, body.friction_exponent()),
            create_active_stress(active_stress, body, time.end_time),
            time.end_time};
  }
} // namespace crawler
