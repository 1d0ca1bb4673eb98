// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "run_text.h"

#include <algorithm>

namespace crawler::test
{
  /// A term of the equation, by the entries that bring it in.
  struct Feature
  {
    std::string name;
    Settings settings;
  };

  inline Settings
  feedback(const std::string &formula)
  {
    return set("strain feedback; Active stress = {}", formula);
  }

  /// Laws of bodies and grounds that both forms have.
  inline std::vector<Feature>
  laws()
  {
    return {{"elastic modulus", {{"Body/Elastic modulus profile", "1+0.5*s"}}},
            {"friction", {{"Body/Friction profile", "2-s^2"}}},
            {"expression", {{"Ground/Friction law", "expression"}, {"Ground/Expression", "0.5*w^(-1.5)+0.5*w"}}},
            {"direction", {{"Ground/Backward ratio", "3"}, {"Ground/Switching velocity", "0.2"}}}};
  }

  /// All of them together, and more.
  inline Feature
  all_of(const std::vector<Feature> &features, const Settings &more)
  {
    Settings all;
    for (const Feature &feature : features)
      all = with(all, feature.settings);
    return {"all", with(all, more)};
  }

  inline double
  largest(const std::vector<double> &x)
  {
    double result = 0.;
    for (const double value : x)
      result = std::max(result, std::abs(value));
    return result;
  }
} // namespace crawler::test
