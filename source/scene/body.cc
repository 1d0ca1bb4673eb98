// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/scene/body.h>

namespace crawler
{
  void
  Body::add_parameters(Declarations &declarations)
  {
    declarations.enter("Body");
    declarations.number("Length", length, positive(), "Rest length L of the body.", "length");
    declarations.number(
      "Elastic modulus", elastic_modulus, positive(), "Elastic modulus k: force per unit strain.", "force");
    declarations.number("Friction coefficient",
                        friction_coefficient,
                        positive(),
                        "Friction coefficient gamma: force per velocity and reference length of the "
                        "unstretched body.",
                        "force time/length^2");
    declarations.number("Anchoring exponent",
                        anchoring_exponent,
                        between(-100, 100),
                        "Anchoring exponent p: friction per reference length is gamma times velocity times "
                        "stretch^(1-p). Where p > 1 a contracted part grips (earthworm), where p < 1 a "
                        "stretched part grips (snail); at p = 1 no wave moves the body.",
                        "1");
    declarations.leave();
  }
} // namespace crawler
