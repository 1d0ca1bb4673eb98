// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/mesh/triangulation.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/multithread_info.h>
#include <deal.II/distributed/shared_tria.h>
#include <deal.II/grid/tria_description.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    class SharedTriangulation : public Triangulation
    {
    public:
      SharedTriangulation(MPI_Comm communicator, const std::vector<double> &ends)
        : n_ranks_(dealii::Utilities::MPI::n_mpi_processes(communicator))
        , shared_(communicator,
                  dealii::Triangulation<1>::none,
                  /*allow_artificial_cells=*/false,
                  Shared::partition_custom_signal)
      {
        const auto assign = [this]() { assign_ranks(); };
        shared_.signals.create.connect(assign); // the first mesh does not count as a refinement
        shared_.signals.post_refinement.connect(assign);
        std::vector<dealii::Point<1>> vertices;
        for (const double s : ends)
          vertices.emplace_back(s);
        std::vector<dealii::CellData<1>> cells(ends.size() - 1);
        for (unsigned int c = 0; c < cells.size(); ++c)
          cells[c].vertices = {c, c + 1};
        shared_.create_triangulation(vertices, cells, {});
      }

      std::size_t
      n_cells() const override
      {
        return shared_.n_active_cells();
      }

      std::vector<Cell>
      cells(const std::vector<Cell> &coarse) const override
      {
        std::vector<Cell> result;
        result.reserve(n_cells());
        for (const auto &cell : cells_along_the_body())
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
      change(const std::vector<CellChange> &changes) override
      {
        const auto cells = cells_along_the_body();
        for (std::size_t c = 0; c < cells.size(); ++c)
          if (changes[c] == CellChange::divide)
            cells[c]->set_refine_flag();
          else if (changes[c] == CellChange::join)
            cells[c]->set_coarsen_flag();
        shared_.execute_coarsening_and_refinement();
      }

    private:
      using Shared   = dealii::parallel::shared::Triangulation<1>;
      using Iterator = dealii::Triangulation<1>::active_cell_iterator;

      /// The active cells from left to right; deal.II keeps them level by level.
      std::vector<Iterator>
      cells_along_the_body() const
      {
        std::vector<Iterator> cells;
        cells.reserve(shared_.n_active_cells());
        for (const auto &cell : shared_.active_cell_iterators())
          cells.push_back(cell);
        if (shared_.n_levels() > 1)
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
          cells[i]->set_subdomain_id(owner(i, cells.size(), n_ranks_));
      }

      const unsigned int n_ranks_;
      Shared shared_;
    };
  } // namespace
} // namespace crawler

extern "C" crawler::Triangulation *
crawler_create_triangulation(MPI_Comm communicator, const std::vector<double> &ends)
{
  dealii::MultithreadInfo::set_thread_limit(1);
  return new crawler::SharedTriangulation(communicator, ends);
}
