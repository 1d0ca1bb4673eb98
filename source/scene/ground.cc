// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/formula/formula_gradient.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/formula_input.h>
#include <crawler/scene/ground.h>

#include <cmath>
#include <functional>
#include <stdexcept>

namespace crawler
{
  namespace
  {
    /// A formula f of the stretch: g(w) = gamma f(w).
    class ExpressionFriction : public FrictionLaw
    {
    public:
      /// @param gamma friction coefficient [force time/length^2]; @param formula of the one variable w.
      ExpressionFriction(const double gamma, std::shared_ptr<const Formula> formula)
        : gamma_(gamma)
        , formula_(std::move(formula))
        , gradient_(formula_)
      {
      }

      void
      values(const std::span<const double> w, const std::span<double> g, const std::span<double> w_dg) const override
      {
        const std::span<const double> stretch[] = {w};
        const std::span<double> derivatives[]   = {w_dg};
        gradient_.evaluate(stretch, g, derivatives);
        for (double &value : g)
          value *= gamma_;
        for (std::size_t i = 0; i < w_dg.size(); ++i)
          w_dg[i] *= gamma_ * w[i];
      }
      std::unique_ptr<FrictionLaw>
      scaled(const double factor) const override
      {
        return std::make_unique<ExpressionFriction>(gamma_ * factor, formula_);
      }

    private:
      const double gamma_;
      const std::shared_ptr<const Formula> formula_;
      mutable FormulaGradient gradient_; ///< holds intermediate values
    };

    struct Law
    {
      std::string name, description;
      std::function<std::unique_ptr<const FrictionLaw>(const GroundParameters &, const Body &, double)> create;
    };

    /// The list of all friction laws, kept only here.
    const std::vector<Law> &
    laws()
    {
      static const std::vector<Law> list = {
        {"power",
         "gamma times stretch^(1-p), p the Anchoring exponent",
         [](const auto &, const Body &body, double) -> std::unique_ptr<const FrictionLaw> {
           return std::make_unique<PowerFriction>(body.friction_coefficient, body.friction_exponent());
         }},
        {"Newtonian",
         "a viscous film: gamma times stretch",
         [](const auto &, const Body &body, double) -> std::unique_ptr<const FrictionLaw> {
           return std::make_unique<PowerFriction>(body.friction_coefficient, /*a=*/1., /*its_is_power_law=*/false);
         }},
        {"expression",
         "gamma times a formula of the stretch w",
         [](const auto &p, const Body &body, const double end_time) -> std::unique_ptr<const FrictionLaw> {
           const FormulaInput input{
             "friction law", p.expression, p.constants, "Ground/Expression", "Ground/Constants", {"w"}};
           auto law = std::make_unique<ExpressionFriction>(body.friction_coefficient,
                                                           read_formula(input, body.length, end_time));
           // Every body is near the stretch 1; other stretches are checked when a body gets there.
           require_positive([&](const double w) { return law->value(w); }, 0.9, 1.1, input);
           return law;
         }},
      };
      return list;
    }
  } // namespace

  void
  GroundParameters::add_parameters(Declarations &declarations)
  {
    std::vector<std::string> names;
    std::string documentation = "Friction per reference length and velocity as a function of the stretch: ";
    for (const Law &law : laws())
    {
      documentation += (names.empty() ? "" : "; ") + law.name + " (" + law.description + ")";
      names.push_back(law.name);
    }
    declarations
      .file("Profile",
            profile,
            "a formula of x, or a CSV file (a name that ends in .csv) with the header x,value",
            "1",
            ".csv")
      .means("Factor of the friction along the ground; x is the place on the ground, where the body lies from 0 to L "
             "before it is stretched.");
    declarations.choice("Profile interpolation", interpolation, {"cubic", "linear"})
      .means("Interpolation between the rows of the CSV file.");
    declarations.choice("Outside", outside, {"hold", "error"})
      .means("What happens beyond the first and the last row of the CSV file: their values are kept, or the run ends.");
    declarations.choice("Friction law", friction_law, names).means(documentation + ".");
    declarations.text("Expression", expression, "a formula of w", "1")
      .means("Friction divided by gamma for the law expression, as a positive function of the stretch w.");
    declarations.constants("Constants", constants, {"Expression", "Profile"})
      .means("Constants that this formula and that of the Profile may use.");
    declarations.number("Backward ratio", backward_ratio, between(0.1, 10), "1")
      .means("Ratio r of the resistance to backward motion (v < 0) to that to forward motion; in between, the friction "
             "has the factor (1+r)/2 + (1-r)/2 tanh(v/v_s).");
    declarations.number("Switching velocity", switching_velocity, positive(), "length/time")
      .means(
        "Velocity v_s of the transition between backward and forward motion; needed if the Backward ratio is not 1.");
  }

  std::unique_ptr<const FrictionLaw>
  create_friction_law(const GroundParameters &parameters, const Body &body, const double end_time)
  {
    for (const Law &law : laws())
      if (law.name == parameters.friction_law)
        return law.create(parameters, body, end_time);
    throw std::logic_error("the parameters name a friction law that is not in the list");
  }

  Ground
  create_ground(const GroundParameters &parameters, const Body &body, const double end_time)
  {
    Ground ground{read_profile({{"profile of the ground",
                                 parameters.profile,
                                 parameters.constants,
                                 "Ground/Profile",
                                 "Ground/Constants",
                                 {"x"}},
                                parameters.interpolation,
                                parameters.outside},
                               body.length,
                               end_time),
                  {}};
    if (parameters.backward_ratio != 1.)
    {
      if (!parameters.switching_velocity)
        refuse("Ground/Backward ratio",
               "Backward ratio is {:g} and Switching velocity is automatic, but a velocity is expected",
               parameters.backward_ratio);
      ground.direction = {parameters.backward_ratio, *parameters.switching_velocity};
    }
    return ground;
  }
} // namespace crawler
