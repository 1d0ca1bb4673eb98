// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/time/integrators.h>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace crawler
{
  const std::vector<Integrator> &
  integrators()
  {
    static const std::vector<Integrator> list = {
      {"bdf", "bdf", 1},
      {"radau 5", "radau", 3},
      {"radau 9", "radau", 5},
    };
    return list;
  }

  const Integrator &
  integrator(const std::string &name)
  {
    for (const Integrator &entry : integrators())
      if (entry.name == name)
        return entry;
    throw std::logic_error("no integrator is called " + name);
  }

  std::string
  reason_against(const std::string &petsc_name)
  {
    const std::string crank_nicolson  = "Crank-Nicolson is erratic for a mass matrix that depends on the state";
    const std::string explicit_method = "an explicit method cannot take steps longer than the square of the smallest "
                                        "cell, and needs the friction matrix inverted";
    const std::map<std::string, std::string> reasons = {
      {"rosw",
       "Rosenbrock-W methods assume a constant mass matrix; here it depends on the stretch, and the error does not go "
       "to 0"},
      {"irk", "PETSc's irk assumes the identity as mass matrix in its Jacobian; its order here is 0"},
      {"glle", "glle does not control its error for a mass matrix that depends on the state"},
      {"glee", "glee is explicit, and the friction matrix must be inverted implicitly"},
      {"cn", crank_nicolson},
      {"crank nicolson", crank_nicolson},
      {"euler", explicit_method},
      {"rk", explicit_method},
      {"ssp", explicit_method},
      {"sundials", "PETSc's interface to SUNDIALS takes no mass matrix"},
      {"mimex", "mimex splits off an explicit part that this equation does not have"},
    };
    const auto found = reasons.find(petsc_name);
    return found == reasons.end() ? "" : found->second;
  }

  bool
  is_offered(const std::string &name)
  {
    return std::ranges::find(integrators(), name, &Integrator::name) != integrators().end();
  }
} // namespace crawler
