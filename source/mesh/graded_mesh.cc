// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/mesh/graded_mesh.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Numbers of cells for pieces of these lengths: @p least each; the rest goes, one by one, to the piece with the
    /// largest cells.
    std::vector<unsigned int>
    shared_out(const unsigned int n_cells, const std::vector<double> &lengths, const unsigned int least)
    {
      std::vector<unsigned int> cells(lengths.size(), least);
      unsigned int left = n_cells - std::min(n_cells, least * static_cast<unsigned int>(lengths.size()));
      // Shares most of them out at once.
      const unsigned int many = left;
      for (std::size_t i = 0; i < lengths.size(); ++i)
      {
        const auto share      = static_cast<unsigned int>(std::max(0., std::floor(lengths[i] * many) - least));
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

  unsigned int
  min_graded_cells(const std::size_t n_breaks, const Grading &grading)
  {
    return static_cast<unsigned int>(n_breaks + 1) * (grading.levels > 0 ? 2 : 1);
  }

  unsigned int
  finer_n_cells(const double factor, const unsigned int n_cells, const std::size_t n_breaks, const Grading &grading)
  {
    const unsigned int present = std::max(n_cells, min_graded_cells(n_breaks, grading));
    const unsigned int by      = n_breaks > 0 ? static_cast<unsigned int>(n_breaks) + 1 : 0;
    return std::max(static_cast<unsigned int>(std::ceil(factor * present)), present + by);
  }

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
    const std::vector<unsigned int> cells = shared_out(n_cells, lengths, min_graded_cells(0, grading));

    std::vector<double> ends = {0.};
    for (std::size_t i = 0; i < lengths.size(); ++i)
    {
      const double left = pieces[i], right = pieces[i + 1], size = lengths[i] / cells[i];
      for (unsigned int level = grading.levels; level > 0; --level)
        ends.push_back(left + size * std::pow(grading.ratio, level));
      for (unsigned int c = 1; c < cells[i]; ++c)
        ends.push_back(left + c * size);
      for (unsigned int level = 1; level <= grading.levels; ++level)
        ends.push_back(right - size * std::pow(grading.ratio, level));
      ends.push_back(right);
    }
    return ends;
  }

  std::vector<double>
  layered_cell_ends(const unsigned int n_cells,
                    const unsigned int parts,
                    const std::vector<double> &breaks,
                    const double layer)
  {
    constexpr double fewest    = 4.;
    std::vector<double> pieces = {0.}, ends = {0.};
    pieces.insert(pieces.end(), breaks.begin(), breaks.end());
    pieces.push_back(1.);
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i)
    {
      const double left = pieces[i], length = pieces[i + 1] - left, d = std::min(layer / length, 1.);
      const auto cells = static_cast<unsigned int>(std::max(fewest, std::round(n_cells * length))) * parts;
      const double A = 0.25 / std::log1p(1. / d), B = 0.5;
      const auto part_of = [&](const double x) // fraction of the cells to the left of x
      { return A * (std::log1p(x / d) - std::log1p(-x / (1. + d))) + B * x; };
      double x = 0.;
      for (unsigned int c = 1; c < cells; ++c)
      {
        const double wanted = 1. * c / cells;
        double low = x, high = 1.;
        for (int j = 0; j < 60 && high - low > 1e-16; ++j) // Newton's method, kept in the bracket
        {
          const double excess        = part_of(x) - wanted;
          (excess > 0. ? high : low) = x;
          double next                = x - excess / (A / (d + x) + A / (d + 1. - x) + B);
          if (!(next > low && next < high))
            next = 0.5 * (low + high);
          const double change = std::abs(next - x);
          x                   = next;
          if (change <= 1e-15 * x)
            break;
        }
        ends.push_back(left + length * x);
      }
      ends.push_back(pieces[i + 1]);
    }
    return ends;
  }
} // namespace crawler
