// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/drivers/parameters.h>
#include <crawler/drivers/simulation.h>

#include <string>
#include <vector>

namespace crawler
{
  /// The last mesh of a run.
  struct SummaryMesh
  {
    unsigned int n_cells, degree;
    std::size_t n_unknowns;
    bool is_shared; ///< by several ranks

    static SummaryMesh
    of(const Discretization &discretization);
  };

  /// The text of summary.json. Its keys are a contract (doc/user_guide.md); what is not known is null. @p
  /// mesh: nothing if there was none.
  std::string
  summary_json(const SimulationResult &result,
               const Parameters &parameters,
               const std::optional<SummaryMesh> &mesh,
               unsigned int n_ranks,
               const std::string &command_line);

  /// The same for people, in a few lines.
  std::vector<std::string>
  summary_lines(const SimulationResult &result, const Parameters &parameters);
} // namespace crawler
