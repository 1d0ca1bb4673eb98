// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/equation/stretch_means.h>

using namespace crawler;

namespace
{
  /// Three cells of different lengths, L = 2.
  const std::vector<Cell> cells = {{0., 0.5, 0, false}, {0.5, 1.1, 0, false}, {1.6, 0.4, 0, false}};
  constexpr double L            = 2.;

  template <typename Function>
  std::vector<double>
  means(const unsigned int degree, const std::vector<double> &middles, const double length, const Function &f)
  {
    const ReferenceElement &element = reference_element(degree);
    std::vector<double> field, result(middles.size());
    for (const Cell &cell : cells)
      for (const double x : element.stretch_points)
        field.push_back(f(cell.left + x * cell.size));
    StretchMeans(cells, element, middles, length).mean(field, result);
    return result;
  }
} // namespace

/// (F(right) - F(left))/length of the power s^(q-1), wherever the ends of the sensor are in the cells; sensors that
/// would reach beyond the body are moved inside.
TEST(StretchMeans, AreExactForPolynomials)
{
  const std::vector<double> middles = {-0.7, 0., 0.2, 0.5, 0.9, 1.3, 1.61, 1.99, 2.4};
  for (const unsigned int q : {1u, 2u, 4u, 8u})
    for (const double length : {0.01, 0.3, 1.2, L})
    {
      const auto found = means(q, middles, length, [&](const double s) { return std::pow(s, q - 1); });
      for (std::size_t i = 0; i < middles.size(); ++i)
      {
        const double left = std::min(std::max(middles[i] - 0.5 * length, 0.), L - length), right = left + length;
        EXPECT_NEAR(
          found[i], (std::pow(right, q) - std::pow(left, q)) / (q * length), 1e-12 * std::pow(L, q - 1) / length)
          << "degree " << q << ", length " << length << ", middle " << middles[i];
      }
    }
}

/// A sensor multiplies a wave sin(k s) by sin(k b/2)/(k b/2).
TEST(StretchMeans, DampFineWaves)
{
  constexpr double k = 3., b = 0.8, middle = 0.93;
  const auto found = means(8, {middle}, b, [&](const double s) { return std::sin(k * s); });
  EXPECT_NEAR(found[0], std::sin(k * middle) * std::sin(0.5 * k * b) / (0.5 * k * b), 1e-8);
}
