// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/optimize/optimize_settings.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace crawler
{
  namespace
  {
    const std::string own = "Optimize/Variables";

    /// Is there a limit without which the displacement would have no maximum?
    void
    require_limit(const OptimizeParameters &p, const std::vector<Variable> &variables)
    {
      const auto holds = [](const LimitEntry &limit) { return limit.value && limit.name != "Largest stress rate"; };
      if (p.objective == "cost of transport" || std::ranges::any_of(limits_of(p), holds))
        return;
      for (const Variable &variable : variables) // ranges are limits, but not meant as such
        if (variable.path.starts_with("Active stress/Modes/Coefficients"))
          throw InputError(
            "there is no limit on strain, stress or work: the " + p.objective +
              " has no maximum (doc/theory.md, \"Gait efficiency\"); at least one of Work, Positive work, Dissipation, "
              "Largest strain and Smallest strain, Mean-square strain, Largest stress is expected",
            own);
    }
  } // namespace

  std::vector<Variable>
  read_variables_of_gait(Form &form)
  {
    const OptimizeParameters &p           = form.parameters.optimize;
    const std::vector<Variable> variables = read_variables(form, own);
    if (p.smallest_strain && p.largest_strain && *p.smallest_strain == 0. && *p.largest_strain == 0.)
      throw InputError(
        fmt::format("\"{}\": no strain is allowed, so no gait moves the body; a range of strain is expected", own),
        own);
    require_limit(p, variables);
    return variables;
  }

  std::vector<LimitEntry>
  limits_of(const OptimizeParameters &p)
  {
    return {{"Work", p.work},
            {"Positive work", p.positive_work},
            {"Dissipation", p.dissipation},
            {"Mean-square strain", p.mean_square_strain},
            {"Smallest strain", p.smallest_strain},
            {"Largest strain", p.largest_strain},
            {"Largest stress", p.largest_stress},
            {"Largest stress rate", p.largest_stress_rate}};
  }

  Parameters
  parameters_at(Form &form, const std::vector<Variable> &variables, const std::vector<double> &x)
  {
    for (std::size_t i = 0; i < x.size(); ++i)
      form.declarations.set(variables[i].path, to_text(x[i]));
    return form.parameters;
  }

  std::vector<double>
  start_values(const OptimizeParameters &parameters, const std::vector<Variable> &variables, const unsigned long number)
  {
    std::mt19937_64 random(parameters.seed * 1000003ul + number);
    std::vector<double> x;
    for (const Variable &variable : variables)
    {
      const double part  = static_cast<double>(random() >> 11) * 0x1p-52 - 1.; // from -1 to 1, alike on all machines
      const double shift = number == 0 ? 0. : parameters.spread * part * (variable.to - variable.from);
      x.push_back(std::clamp(variable.start + shift, variable.from, variable.to));
    }
    return x;
  }
} // namespace crawler
