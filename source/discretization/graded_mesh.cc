// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/discretization/graded_mesh.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Cells for pieces of these lengths: one each; the others one by one to the piece whose cells are the largest.
    std::vector<unsigned int>
    shared_out(const unsigned int n_cells, const std::vector<double> &lengths)
    {
      std::vector<unsigned int> cells(lengths.size(), 1);
      unsigned int left = n_cells - std::min(n_cells, static_cast<unsigned int>(lengths.size()));
      // Most of them at once.
      const unsigned int many = left;
      for (std::size_t i = 0; i < lengths.size(); ++i)
      {
        const auto share      = static_cast<unsigned int>(std::max(0., std::floor(lengths[i] * many) - 1.));
        const unsigned int of = std::min(share, left);
        cells[i] += of;
        left -= of;
      }
      for (; left > 0; --left)
      {
        std::size_t largest = 0;
        for (std::size_t i = 1; i < lengths.size(); ++i)
          if (lengths[i] / cells[i] > lengths[largest] / cells[largest] * (1. + 1e-9))
            largest = i;
        ++cells[largest];
      }
      return cells;
    }
  } // namespace

  std::vector<double>
  cell_ends(const unsigned int n_cells, const std::vector<double> &breaks, const Grading &grading)
  {
    if (breaks.empty() && grading.levels == 0)
      return {};
    std::vector<double> pieces = {0.};
    pieces.insert(pieces.end(), breaks.begin(), breaks.end());
    pieces.push_back(1.);
    std::vector<double> lengths;
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i)
      lengths.push_back(pieces[i + 1] - pieces[i]);
    const std::vector<unsigned int> cells = shared_out(n_cells, lengths);

    std::vector<double> ends = {0.};
    for (std::size_t i = 0; i < lengths.size(); ++i)
    {
      const double left = pieces[i], right = pieces[i + 1], size = lengths[i] / cells[i];
      const double graded = cells[i] == 1 ? 0.5 * size : size; // of each end
      if (grading.levels > 0)
      {
        for (unsigned int level = grading.levels; level > 0; --level)
          ends.push_back(left + graded * std::pow(grading.ratio, level));
        if (cells[i] == 1)
          ends.push_back(left + graded);
      }
      for (unsigned int c = 1; c < cells[i]; ++c)
        ends.push_back(left + c * size);
      if (grading.levels > 0)
        for (unsigned int level = 1; level <= grading.levels; ++level)
          ends.push_back(right - graded * std::pow(grading.ratio, level));
      ends.push_back(right);
    }
    return ends;
  }
} // namespace crawler
