// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/mesh/discretization_parameters.h>
#include <crawler/mesh/reference_element.h>
#include <crawler/parameters/declarations.h>

namespace crawler
{
  void
  DiscretizationParameters::add_parameters(Declarations &declarations)
  {
    declarations.choice("Formulation", formulation)
      .means("Unknowns that are solved for: position, of high order on bodies that deform smoothly; stretch, for "
             "bodies that collapse, soft ones with thin layers, and fronts; automatic takes the cheaper one.");
    declarations.choice("Mesh", mesh)
      .means("Whether the cells have one size, or are refined and coarsened during the run where an error indicator "
             "asks for it. Automatic: with cells that become smaller towards the ends and the jumps if the active "
             "stress starts or jumps suddenly, else adaptive only where the body inverts on coarse uniform ones.");
    declarations.number("Mesh tolerance", mesh_tolerance, positive(), "1")
      .means("Admissible sum of the error indicators of an adaptive mesh, relative to the square of the strain. "
             "Automatic: chosen from Accuracy.");
    declarations.number("Smallest cell", smallest_cell, positive(), "length")
      .means("Lower limit of the size of a cell of an adaptive mesh. Automatic: 1e-6 of the length.");
    declarations.whole_number("Degree", degree, 1, ReferenceElement::highest_degree)
      .means("Polynomial degree of the position within a cell. The displacement converges with twice this order. "
             "Automatic: chosen from Accuracy.");
    declarations.whole_number("Number of cells", n_cells, 1, 10000000)
      .means("Number of equal cells along the body; for an adaptive mesh, that of the first and coarsest mesh. "
             "Automatic: chosen from Accuracy.");
    declarations.choice("Share cells", share_cells)
      .means("Whether the ranks of mpirun share the cells, or each computes the whole body. Automatic: shared from "
             "2000 cells on; with fewer, communication costs more than it saves.");
  }

  bool
  DiscretizationParameters::shares(const unsigned int cells) const
  {
    constexpr unsigned int worth_sharing = 2000; // measured, doc/numerics.md
    return share_cells == ShareCells::yes || (share_cells == ShareCells::automatic && cells >= worth_sharing);
  }
} // namespace crawler
