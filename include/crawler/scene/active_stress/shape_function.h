// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  /**
   * A continuous function V(x) on an interval, as a polynomial on each of many panels, with the integral and the
   * derivative of the polynomials. These are series of Chebyshev polynomials T_k(u), -1 <= u <= 1.
   */
  class ShapeFunction
  {
  public:
    /// Writes V at the places x into the second list.
    using Function = std::function<void(std::span<const double> x, std::span<double> values)>;

    /**
     * Interpolates a function on @p from <= x <= @p to by polynomials of degree 15: panels, @p size long at first, are
     * halved until the last coefficients are below 1e-13 of the largest |V|. Where V' jumps they are halved down to
     * 1e-10 of that length. Throws InputError for @p entry if V is not a finite number somewhere, if it jumps by more
     * than 1e-3 of its largest value, or if there are more than 1e6 panels.
     */
    ShapeFunction(const Function &function, double from, double to, double size, const std::string &entry);

    /// Interpolates values @p f at increasing @p x, four at least, by a cubic spline (base/cubic_spline.h).
    ShapeFunction(const std::vector<double> &x, const std::vector<double> &f);

    /// Writes V and its integral from the first panel to x at places x; all lists have one length. @p panel is that of
    /// the last place (0 at first), which is fast for places in order. Beyond the ends the outermost polynomials
    /// continue.
    void
    values_and_integrals(std::span<const double> x,
                         std::size_t &panel,
                         std::span<double> values,
                         std::span<double> integrals) const;

    /// Derivative V'(x); the panel likewise.
    double
    derivative(double x, std::size_t &panel) const;

    /// Places where V' jumps.
    const std::vector<double> &
    kinks() const
    {
      return kinks_;
    }

  private:
    std::vector<double>
    coefficients(const Function &function, double left, double right) const;
    void
    add_panel(double right, std::span<const double> coefficients);
    std::size_t
    find(double x, std::size_t panel) const;
    double
    local(const double x, const std::size_t panel) const
    {
      const double left = left_[panel], right = left_[panel + 1];
      return ((x - left) - (right - x)) / (right - left);
    }

    const unsigned int degree_;
    std::vector<double> left_;     ///< ends of the panels, one more than panels
    std::vector<double> value_;    ///< [panel][k] of V, k = 0 ... degree
    std::vector<double> integral_; ///< [panel][k] of the integral, k = 0 ... degree + 1
    std::vector<double> kinks_;
  };
} // namespace crawler
