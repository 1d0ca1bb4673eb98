// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/mesh/mesh_marking.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace crawler
{
  std::vector<CellChange>
  mark_for_division(const std::vector<double> &indicators, const Discretization &mesh, const MeshLimits &limits)
  {
    constexpr double rest = 0.1;
    const unsigned int n  = mesh.n_cells();
    const auto divisible  = [&](const unsigned int c) { return 0.5 * mesh.cells[c].size >= limits.smallest_cell; };
    std::vector<unsigned int> order(n);
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [&](const unsigned int a, const unsigned int b) {
      return indicators[a] > indicators[b];
    });
    double sum = std::accumulate(indicators.begin(), indicators.end(), 0.);
    std::vector<CellChange> changes(n, CellChange::keep);
    bool any = false;
    for (const unsigned int c : order)
    {
      if (sum <= rest * limits.tolerance || 2 * n > limits.most_cells)
        break;
      sum -= indicators[c];
      if (!divisible(c))
        continue;
      any        = true;
      changes[c] = CellChange::divide;
    }
    if (!any)
      return {};
    const std::vector<CellChange> worst = changes;
    for (unsigned int c = 0; c < n; ++c)
      if (worst[c] == CellChange::divide)
        for (const unsigned int neighbour : {c - 1, c + 1})
          if (neighbour < n && divisible(neighbour) && mesh.cells[neighbour].level <= mesh.cells[c].level)
            changes[neighbour] = CellChange::divide;
    return changes;
  }

  std::vector<CellChange>
  mark_for_joining(const std::vector<double> &indicators, const Discretization &mesh, const MeshLimits &limits)
  {
    constexpr double share = 0.01, worth = 0.25;
    const unsigned int n = mesh.n_cells();
    // Growth of the indicator by joining: for smooth stretch it scales with the cell size to the power 2q + 1.
    const double growth = std::ldexp(1., 2 * static_cast<int>(mesh.element.degree));
    std::vector<CellChange> changes(n, CellChange::keep);
    unsigned int joined = 0;
    for (unsigned int c = 0; c + 1 < n; ++c)
    {
      const auto &cell = mesh.cells[c];
      const bool pair  = cell.is_left_half && cell.level == mesh.cells[c + 1].level;
      if (!pair || (indicators[c] + indicators[c + 1]) * growth > share * limits.tolerance / n)
        continue;
      changes[c] = changes[c + 1] = CellChange::join;
      ++c;
      ++joined;
    }
    if (joined < worth * n)
      return {};
    return changes;
  }
} // namespace crawler
