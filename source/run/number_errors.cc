// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/number_errors.h>

namespace crawler
{
  const std::array<const char *, NumberErrors::n> &
  NumberErrors::keys()
  {
    static const std::array<const char *, n> list = {{"stress_power",
                                                      "dissipation",
                                                      "elastic_energy",
                                                      "paper_energy",
                                                      "positive_power",
                                                      "min_stretch",
                                                      "max_stretch",
                                                      "gait.displacement",
                                                      "gait.speed",
                                                      "gait.cost_of_transport.stress_power",
                                                      "gait.cost_of_transport.positive_power",
                                                      "gait.cost_of_transport.paper_energy",
                                                      "gait.cost_of_transport.dissipation",
                                                      "gait.slip",
                                                      "gait.wave.speed",
                                                      "gait.efficiency"}};
    return list;
  }
} // namespace crawler
