// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

// Not interval.hpp: it wants processors with directed rounding, which is not used here and WebAssembly does not have.
#include <boost/numeric/interval/arith.hpp>
#include <boost/numeric/interval/arith2.hpp>
#include <boost/numeric/interval/checking.hpp>
#include <boost/numeric/interval/compare/explicit.hpp>
#include <boost/numeric/interval/interval.hpp>
#include <boost/numeric/interval/policies.hpp>
#include <boost/numeric/interval/rounded_transc.hpp>
#include <boost/numeric/interval/rounding.hpp>
#include <boost/numeric/interval/transc.hpp>
#include <boost/numeric/interval/utility.hpp>

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
    bool jumps_known    = false;     ///< jumps in time are left out: they move with the place, or their times are known
  };
} // namespace crawler
