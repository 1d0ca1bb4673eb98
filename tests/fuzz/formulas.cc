// SPDX-License-Identifier: LGPL-2.1-or-later
//
// A formula, and behind the first zero byte its constants.
#include <crawler/formula/formula_bound.h>
#include <crawler/formula/formula_gradient.h>
#include <crawler/scene/active_stress/formula_input.h>

#include <vector>

#include "fuzz.h"

int
LLVMFuzzerTestOneInput(const std::uint8_t *data, const std::size_t size)
{
  using namespace crawler;
  fuzz::Bytes bytes(data, size);
  FormulaInput input;
  input.quantity  = "active stress";
  input.formula   = bytes.word('\0');
  input.constants = bytes.word('\0');
  fuzz::is_accepted([&]() {
    const auto formula               = read_formula(input, 1., 2.);
    const std::vector<double> points = {0., 0.3, 1.};
    std::vector<double> values(points.size()), rates(points.size());
    FormulaAtPoints(formula, points).values(0.7, values);
    FormulaGradient(formula).evaluate(
      std::array<std::span<const double>, 2>{{points, points}}, values, std::array<std::span<double>, 2>{{{}, rates}});
    FormulaBound bound(formula);
    bound({0., 1.}, {0., 2.});
    bound({0.3, 0.3}, {0.7, 0.7});
  });
  return 0;
}
