// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/gauss_panels.h>
#include <crawler/scene/known_stress.h>
#include <crawler/scene/scene.h>
#include <crawler/scene/strain_extremes.h>

#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Active stress/Prescribed strain".
  struct PrescribedStrainParameters
  {
    std::string given_by = "expression";

    std::string strain    = "0.3*(sin(2*pi*(s+t)) - sin(2*pi*s))";
    std::string constants = "";

    double mean_strain = 0., amplitude = 0.3, wave_number = 1., wave_speed = 1., phase = 0.;

    std::string file = "strain.csv";

    /// Declares the entries; @p generators are the names of those whose values can be read as strain.
    void
    add_parameters(Declarations &declarations, const std::vector<std::string> &generators);

    /// True if another generator gives the strain.
    bool
    is_generated() const
    {
      return given_by != "expression" && given_by != "wave" && given_by != "table";
    }
  };

  /**
   * A strain e(s,t) = zeta_s - 1 imposed on the body. Its active stress follows from the balance of forces
   * (doc/theory.md, "Prescribed strain"): with the friction g of each point and <.> the mean over the body,
   *
   *   v = B_t - <g B_t>/<g>,   B_t = int_0^s e_t ds,   m = int_0^s g v ds - k e.
   *
   * Integrals over s use Gauss quadrature on panels, which are doubled until m no longer changes.
   */
  class PrescribedStrain : public KnownStress
  {
  public:
    /// Takes a @p scene complete but for the active stress, and a @p generator if the strain is generated: its values
    /// are read as strain [1]. Throws InputError if formula, file or numbers do not make sense, if 1 + e is not
    /// positive somewhere, if the strain jumps, or if the generator does not know its rate or depends on the stretch.
    PrescribedStrain(const PrescribedStrainParameters &parameters,
                     const Scene &scene,
                     std::unique_ptr<const ActiveStress> generator = nullptr);


    const StressFailures *
    failures() const override
    {
      return strain_->failures();
    }

    void
    report(std::ostream &out) const override;

  protected:
    const Scene scene_; ///< without active stress

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;

    void
    require_usable_generator() const;
    void
    require_admissible_strain();
    void
    choose_panels();

    const PrescribedStrainParameters parameters_;
    const std::shared_ptr<const ActiveStress> strain_;
    StrainExtremes extremes_{};
    std::vector<double> panels_; ///< ends of the panels of the quadrature over the body
  };
} // namespace crawler
