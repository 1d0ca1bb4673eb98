// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/words.h>

namespace crawler
{
  /// Level of the model hierarchy (doc/theory.md, "The model hierarchy").
  enum class Model
  {
    automatic, ///< to be chosen
    perturbation,
    kinematic,
    linear,
    nonlinear
  };
  template <>
  inline constexpr const char *words_of<Model>[] = {"auto", "perturbation", "kinematic", "linear", "nonlinear"};
} // namespace crawler
