// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/stretch_means.h>

#include <algorithm>

namespace crawler
{
  StretchMeans::StretchMeans(const std::vector<Cell> &cells,
                             const ReferenceElement &element,
                             const std::vector<double> &middles,
                             const double length)
    : q_(element.degree)
    , length_(length)
  {
    for (const Cell &cell : cells)
      for (const double weight : element.stretch_weights)
        cell_weights_.push_back(cell.size * weight);
    const double end = cells.back().left + cells.back().size;
    std::vector<double> left, right;
    for (const double middle : middles)
    {
      left.push_back(std::max(std::min(middle + 0.5 * length, end) - length, 0.));
      right.push_back(std::min(left.back() + length, end));
    }
    left_  = integrals_to(cells, element, left);
    right_ = integrals_to(cells, element, right);
  }

  StretchMeans::Integrals
  StretchMeans::integrals_to(const std::vector<Cell> &cells,
                             const ReferenceElement &element,
                             const std::vector<double> &places) const
  {
    Integrals result;
    for (const double s : places)
    {
      const auto [c, x] = place_in(cells, s);
      // Gauss points of the part from 0 to x: exact for the polynomials of degree q - 1.
      std::vector<double> points = element.stretch_points;
      for (double &point : points)
        point *= x;
      const auto values = interpolation_matrix(element.stretch_points, points);
      result.cells.push_back(c);
      for (unsigned int p = 0; p < q_; ++p)
      {
        double weight = 0.;
        for (unsigned int i = 0; i < q_; ++i)
          weight += element.stretch_weights[i] * values[i * q_ + p];
        result.weights.push_back(cells[c].size * x * weight);
      }
    }
    return result;
  }

  void
  StretchMeans::mean(const std::span<const double> field, const std::span<double> means) const
  {
    std::vector<double> before(cell_weights_.size() / q_ + 1, 0.);
    for (std::size_t c = 0; c + 1 < before.size(); ++c)
    {
      before[c + 1] = before[c];
      for (unsigned int p = 0; p < q_; ++p)
        before[c + 1] += cell_weights_[c * q_ + p] * field[c * q_ + p];
    }
    const auto integral = [&](const Integrals &to, const std::size_t i) {
      double sum = before[to.cells[i]];
      for (unsigned int p = 0; p < q_; ++p)
        sum += to.weights[i * q_ + p] * field[to.cells[i] * q_ + p];
      return sum;
    };
    for (std::size_t i = 0; i < means.size(); ++i)
      means[i] = (integral(right_, i) - integral(left_, i)) / length_;
  }
} // namespace crawler
