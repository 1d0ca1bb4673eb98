// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/energy_balance.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    constexpr unsigned int max_points = 6;
    /// Growth of a step over the one before beyond which earlier points are not used.
    constexpr double largest_growth = 25.;
  } // namespace

  void
  EnergyBalance::add_works(const Rates &increments)
  {
    stress_work += increments[0];
    dissipation += increments[1];
    positive_work += increments[2];
    exchanged_work += increments[3];
    end_work += increments[4];
  }

  double
  EnergyBalance::residual() const
  {
    const double gap   = std::abs(stress_work - dissipation - elastic_energy + initial_energy - transfer_loss);
    const double scale = std::max({exchanged_work, dissipation, elastic_energy, initial_energy});
    return gap == 0. ? 0. : gap / scale;
  }

  EnergyBalance
  EnergyBalance::scaled(const double unit) const
  {
    EnergyBalance result = *this;
    for (const auto energy : energies())
      result.*energy *= unit;
    result.initial_energy *= unit;
    return result;
  }

  void
  RateQuadrature::advance(const double time, const Rates &rates)
  {
    size_              = points_.empty() ? 0. : time - latest_;
    latest_            = time;
    const double shift = points_.empty() ? 0. : points_.front().offset;
    for (Point &point : points_)
      point.offset -= shift;
    points_.push_front({size_, rates});
    if (points_.size() > max_points)
      points_.pop_back();
    used_ = std::min<std::size_t>(points_.size(), 2);
    while (used_ >= 2 && used_ < points_.size() &&
           (points_[used_ - 1].offset - points_[used_].offset) * largest_growth >= size_)
      ++used_;
  }

  void
  RateQuadrature::begin_step(const double size)
  {
    points_.clear();
    size_ = size;
    used_ = 0;
  }

  void
  RateQuadrature::add_stage(const double place, const Rates &rates)
  {
    points_.push_front({place * size_, rates});
    ++used_;
  }

  Rates
  RateQuadrature::until(const double place) const
  {
    Rates increment{};
    const double part = place * size_;
    if (part == 0.)
      return increment;
    // Gauss formula with three points, exact for the polynomial of degree n - 1 <= 5 through the n points.
    const double offset         = 0.5 * std::sqrt(0.6);
    constexpr double weights[3] = {5. / 18., 4. / 9., 5. / 18.};
    const double x[3]           = {0.5 - offset, 0.5, 0.5 + offset};
    for (std::size_t j = 0; j < used_; ++j)
    {
      double weight = 0.;
      for (unsigned int g = 0; g < 3; ++g)
      {
        double lagrange = weights[g];
        for (std::size_t i = 0; i < used_; ++i)
          if (i != j)
            lagrange *= (x[g] * part - points_[i].offset) / (points_[j].offset - points_[i].offset);
        weight += lagrange;
      }
      for (unsigned int r = 0; r < increment.size(); ++r)
        increment[r] += part * weight * points_[j].rates[r];
    }
    return increment;
  }
} // namespace crawler
