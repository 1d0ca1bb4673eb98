// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/drivers/compute.h>
#include <crawler/drivers/self_check.h>

namespace crawler
{
  Computed
  compute(const Parameters &parameters, const Scene &scene, const std::function<bool()> &keep_going)
  {
    Computed computed;
    const auto choice = choose_numerics(MPI_COMM_SELF, parameters, scene, keep_going);
    if (!choice)
    {
      computed.result.time.status = "stopped";
      return computed;
    }
    computed.choice = *choice;
    Simulation simulation(MPI_COMM_SELF, scene, parameters.time, computed.choice.numerics);
    computed.result = simulation.run({}, {.ledger = parameters.output.ledger, .resolution = false}, {}, keep_going);
    check_identities(computed.result, parameters);
    return computed;
  }
} // namespace crawler
