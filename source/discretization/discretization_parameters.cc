// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/discretization/discretization_parameters.h>
#include <crawler/discretization/reference_element.h>
#include <crawler/parameters/declarations.h>

namespace crawler
{
  void
  DiscretizationParameters::add_parameters(Declarations &declarations)
  {
    declarations.enter("Discretization");
    declarations.whole_number("Degree",
                              degree,
                              1,
                              ReferenceElement::highest_degree,
                              "Polynomial degree of the position within a cell. The displacement converges with twice "
                              "this order. Automatic: chosen from Accuracy.");
    declarations.whole_number("Number of cells",
                              n_cells,
                              1,
                              10000000,
                              "Number of cells of one size along the body. Automatic: chosen from Accuracy.");
    declarations.leave();
  }
} // namespace crawler
