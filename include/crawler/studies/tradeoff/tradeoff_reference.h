// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/parameters.h>

#include <nlohmann/json.hpp>

#include <functional>
#include <string>

namespace crawler
{
  /// Displacement that `crawler run` gives with a small Accuracy.
  struct TradeoffAnswer
  {
    std::string method;       ///< in words; empty: there is none
    double displacement = 0.; ///< [length]
    double error_bound  = 0.; ///< [length]
  };

  /// Displacement against which the errors of a tradeoff are measured; also as JSON.
  struct TradeoffReference
  {
    TradeoffAnswer answer, check; ///< the reference, and the result of a method that shares as little with it as
                                  ///< possible
    double displacement = 0.;     ///< displacement of the answer [length]
    double bar          = 0.;     ///< errors below this cannot be told from 0 [length]
    double size         = 0.;     ///< size to which errors are relative [length]
    double relative_bar = 0.;
    // Without a reference: failed or inverted, and why, or stopped.
    std::string status = "finished", message;
  };
  NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TradeoffAnswer, method, displacement, error_bound)
  NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(
    TradeoffReference, answer, check, displacement, bar, size, relative_bar, status, message)

  /**
   * Computes the reference of the nonlinear model: the answer with numerics chosen by the program, for the smallest
   * Accuracy from 1e-12 on that is reached within twice the time limit of a run; checked by the position form of degree
   * 7 with radau 5 on PETSc, from 1e-10 on. The bar is the distance of the two, plus the error bound of the reference,
   * plus 1e-14 for round-off. Errors are relative to the same size as Accuracy.
   */
  TradeoffReference
  make_reference(const Parameters &parameters, const std::function<bool()> &interrupted);
} // namespace crawler
