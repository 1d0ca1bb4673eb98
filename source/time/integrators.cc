// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/time/integrators.h>

#include <map>
#include <stdexcept>

namespace crawler
{
  const std::vector<Integrator> &
  integrators()
  {
    static const std::vector<Integrator> list = {
      {"bdf", "bdf", "", 0, true},
      {"backward euler", "beuler", "", 1, true},
      {"midpoint", "theta", "", 2, true},
      {"arkimex l2", "arkimex", "l2", 2, true},
      {"arkimex 3", "arkimex", "3", 3, true},
      {"arkimex ars443", "arkimex", "ars443", 3, false},
      {"arkimex 4", "arkimex", "4", 4, true},
      {"arkimex 5", "arkimex", "5", 5, true},
      {"radau 5", "radau", "5", 5, true, 3},
      {"radau 9", "radau", "9", 9, true, 5},
    };
    return list;
  }

  const Integrator &
  integrator(const std::string &name)
  {
    for (const Integrator &entry : integrators())
      if (entry.name == (name == "automatic" ? "bdf" : name))
        return entry;
    throw std::logic_error("no integrator is called " + name);
  }

  std::string
  reason_against(const std::string &petsc_name)
  {
    static const std::map<std::string, std::string> reasons = {
      {"rosw",
       "Rosenbrock-W methods assume a constant mass matrix; here it depends on the stretch, and the error does not go "
       "to 0"},
      {"irk", "PETSc's irk assumes the identity as mass matrix in its Jacobian; its order here is 0"},
      {"glle", "glle does not control its error for a mass matrix that depends on the state"},
      {"glee", "glee is explicit, and the friction matrix must be inverted implicitly"},
      {"theta endpoint",
       "the endpoint variant of theta (Crank-Nicolson) is erratic for a mass matrix that depends on the state"},
      {"cn", "the endpoint variant of theta (Crank-Nicolson) is erratic for a mass matrix that depends on the state"},
      {"crank nicolson",
       "the endpoint variant of theta (Crank-Nicolson) is erratic for a mass matrix that depends on the state"},
      {"euler",
       "an explicit method cannot take steps longer than the square of the smallest cell, and needs the friction "
       "matrix inverted"},
      {"rk",
       "an explicit method cannot take steps longer than the square of the smallest cell, and needs the friction "
       "matrix inverted"},
      {"ssp",
       "an explicit method cannot take steps longer than the square of the smallest cell, and needs the friction "
       "matrix inverted"},
      {"sundials", "PETSc's interface to SUNDIALS takes no mass matrix"},
      {"mimex", "mimex splits off an explicit part that this equation does not have"},
      {"arkimex 2c", "its error on a mass matrix that depends on the state does not go to 0"},
      {"arkimex 2d", "its error on a mass matrix that depends on the state does not go to 0"},
      {"arkimex 2e", "its error on a mass matrix that depends on the state does not go to 0"},
      {"arkimex a2", "it has no error estimate that holds for a mass matrix that depends on the state"},
      {"arkimex prssp2", "its error on a mass matrix that depends on the state does not go to 0"},
      {"arkimex bpr3", "its error on a mass matrix that depends on the state does not go to 0"},
      {"arkimex ars122", "it is of first order only here"},
      {"arkimex 1bee", "it is of first order only here"},
    };
    const auto found = reasons.find(petsc_name);
    return found == reasons.end() ? "" : found->second;
  }

  bool
  is_offered(const std::string &petsc_name)
  {
    for (const Integrator &entry : integrators())
      if (petsc_name == entry.petsc_type + (entry.subtype.empty() ? "" : " " + entry.subtype))
        return true;
    return false;
  }
} // namespace crawler
