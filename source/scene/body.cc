// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/scene/body.h>

namespace crawler
{
  void
  Body::add_parameters(Declarations &declarations)
  {
    declarations.number("Length", length, positive(), "length").means("Rest length L of the body.");
    declarations.number("Elastic modulus", elastic_modulus, positive(), "force")
      .means("Elastic modulus k: force per unit strain.");
    declarations.number("Friction coefficient", friction_coefficient, positive(), "force time/length^2")
      .means("Friction coefficient gamma: force per velocity and reference length of the unstretched body.");
    declarations.number("Anchoring exponent", anchoring_exponent, between(-100, 100), "1")
      .means("Anchoring exponent p: friction per reference length is gamma times velocity times stretch^(1-p). Where p "
             "> 1 a contracted part grips (earthworm), where p < 1 a stretched part grips (snail); at p = 1 no wave "
             "moves the body.");
    declarations.profile("Elastic modulus profile", elastic_modulus_profile)
      .means("Factor of the elastic modulus along the body; s is the material coordinate, L the body length. The "
             "numbers of a list are at places that are equally spaced from s = 0 to L.");
    declarations.profile("Friction profile", friction_profile)
      .means("Factor of the friction coefficient along the body, for example of a belly with scales.");
    declarations.profile("Initial stretch", initial_stretch)
      .means("Stretch of the body at t = 0; its centre of mass starts where that of the unstretched body would.");
    declarations.constants("Constants", constants, {"Elastic modulus profile", "Friction profile", "Initial stretch"})
      .means("Constants that the formulas of this section may use.");
    declarations.choice("Profile interpolation", profile_interpolation, {"cubic", "linear"})
      .means(
        "Interpolation between the numbers of the lists and the rows of the CSV files of this section; their values "
        "are kept beyond the first and the last row. Cubic: a spline of the logarithms, which gives positive values.");
  }

  BodyProfiles
  read_profiles(const Body &body, const double end_time)
  {
    const auto read = [&](const std::string &name, const std::string &quantity, const std::string &text) {
      return read_profile(
        {{quantity, text, body.constants, "Body/" + name, "Body/Constants", {"s"}}, body.profile_interpolation},
        body.length,
        end_time);
    };
    return {read("Elastic modulus profile", "profile of the elastic modulus", body.elastic_modulus_profile),
            read("Friction profile", "profile of the friction", body.friction_profile),
            read("Initial stretch", "initial stretch", body.initial_stretch)};
  }
} // namespace crawler
