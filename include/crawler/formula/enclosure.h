// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <boost/numeric/interval.hpp>
#include <boost/numeric/interval/compare/explicit.hpp>

#include <limits>

namespace crawler
{
  namespace interval_policies = boost::numeric::interval_lib;

  /// Intervals without directed rounding; NaN where nothing is defined.
  using Interval = boost::numeric::interval<
    double,
    interval_policies::policies<interval_policies::save_state_nothing<interval_policies::rounded_transc_exact<double>>,
                                interval_policies::checking_base<double>>>;

  /// Enclosure of a value of a formula, and of its derivative by t, in a box of places and times.
  struct Enclosure
  {
    static constexpr unsigned int no_number = std::numeric_limits<unsigned int>::max();

    Interval value, rate;
    unsigned int number = no_number; ///< of the value in its formula
    bool on_s           = false;     ///< the value depends on s
  };
} // namespace crawler
