// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/mesh/triangulation.h>

#include <deal.II/distributed/shared_tria.h>
#include <deal.II/grid/tria_description.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  struct Triangulation::Implementation
  {
    using Shared   = dealii::parallel::shared::Triangulation<1>;
    using Iterator = dealii::Triangulation<1>::active_cell_iterator;

    explicit Implementation(MPI_Comm communicator)
      : n_ranks(size_of(communicator))
      , shared(communicator,
               dealii::Triangulation<1>::none,
               /*allow_artificial_cells=*/false,
               Shared::partition_custom_signal)
    {
    }

    /// The active cells from left to right; deal.II has them level by level.
    std::vector<Iterator>
    cells_along_the_body() const
    {
      std::vector<Iterator> cells;
      cells.reserve(shared.n_active_cells());
      for (const auto &cell : shared.active_cell_iterators())
        cells.push_back(cell);
      if (shared.n_levels() > 1)
        std::sort(cells.begin(), cells.end(), [](const Iterator &a, const Iterator &b) {
          return a->vertex(0)[0] < b->vertex(0)[0];
        });
      return cells;
    }

    void
    assign_ranks()
    {
      const auto cells = cells_along_the_body();
      for (std::size_t i = 0; i < cells.size(); ++i)
        cells[i]->set_subdomain_id(owner(i, cells.size(), n_ranks));
    }

    const unsigned int n_ranks;
    Shared shared;
  };

  Triangulation::Triangulation(MPI_Comm communicator, const std::vector<double> &ends)
    : implementation_(std::make_unique<Implementation>(communicator))
  {
    const auto assign = [this]() { implementation_->assign_ranks(); };
    implementation_->shared.signals.create.connect(assign); // the first mesh does not count as a refinement
    implementation_->shared.signals.post_refinement.connect(assign);
    std::vector<dealii::Point<1>> vertices;
    for (const double s : ends)
      vertices.emplace_back(s);
    std::vector<dealii::CellData<1>> cells(ends.size() - 1);
    for (unsigned int c = 0; c < cells.size(); ++c)
      cells[c].vertices = {c, c + 1};
    implementation_->shared.create_triangulation(vertices, cells, {});
  }

  Triangulation::~Triangulation() = default;

  std::size_t
  Triangulation::n_cells() const
  {
    return implementation_->shared.n_active_cells();
  }

  std::vector<Cell>
  Triangulation::cells(const std::vector<Cell> &coarse) const
  {
    std::vector<Cell> result;
    result.reserve(n_cells());
    for (const auto &cell : implementation_->cells_along_the_body())
    {
      auto first = dealii::Triangulation<1>::cell_iterator(cell);
      while (first->level() > 0)
        first = first->parent();
      const bool is_left_half = cell->level() > 0 && cell->parent()->child_index(0) == cell->index();
      result.push_back({cell->vertex(0)[0],
                        std::ldexp(coarse[static_cast<std::size_t>(first->index())].size, -cell->level()),
                        static_cast<unsigned int>(cell->level()),
                        is_left_half});
    }
    return result;
  }

  void
  Triangulation::change(const std::vector<CellChange> &changes)
  {
    const auto cells = implementation_->cells_along_the_body();
    for (std::size_t c = 0; c < cells.size(); ++c)
      if (changes[c] == CellChange::divide)
        cells[c]->set_refine_flag();
      else if (changes[c] == CellChange::join)
        cells[c]->set_coarsen_flag();
    implementation_->shared.execute_coarsening_and_refinement();
  }
} // namespace crawler
