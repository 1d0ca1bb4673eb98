// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <boost/numeric/interval.hpp>
#include <boost/numeric/interval/compare/explicit.hpp>

#include <limits>

namespace crawler
{
  namespace interval_policies = boost::numeric::interval_lib;

  /// Without directed rounding; not a number where nothing is defined.
  using Interval = boost::numeric::interval<
    double,
    interval_policies::policies<interval_policies::save_state_nothing<interval_policies::rounded_transc_exact<double>>,
                                interval_policies::checking_base<double>>>;

  /// What a value of a formula is within in a box of places and times, and its derivative by t.
  struct Enclosure
  {
    static constexpr unsigned int no_number = std::numeric_limits<unsigned int>::max();

    Interval value, rate;
    unsigned int number = no_number; ///< of the value in its formula
    bool on_s           = false;     ///< it depends on s
  };
} // namespace crawler
