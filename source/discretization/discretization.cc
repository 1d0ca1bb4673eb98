// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/discretization/discretization.h>

#include <deal.II/distributed/shared_tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>

#include <algorithm>

namespace crawler
{
  struct Discretization::Mesh
  {
    Mesh(MPI_Comm communicator, const unsigned int degree)
      : triangulation(communicator,
                      dealii::Triangulation<1>::none,
                      /*allow_artificial_cells=*/false,
                      dealii::parallel::shared::Triangulation<1>::partition_custom_signal)
      , element(degree)
      , dof_handler(triangulation)
    {
    }

    dealii::parallel::shared::Triangulation<1> triangulation;
    dealii::FE_Q<1> element; // Gauss-Lobatto nodes
    dealii::DoFHandler<1> dof_handler;
  };

  Discretization::Discretization(MPI_Comm communicator,
                                 const double length,
                                 const unsigned int n_cells,
                                 const unsigned int degree)
    : communicator_(communicator)
    , length_(length)
    , n_cells_(n_cells)
    , element_(degree)
    , rank_(dealii::Utilities::MPI::this_mpi_process(communicator))
    , n_ranks_(dealii::Utilities::MPI::n_mpi_processes(communicator))
    , n_active_ranks_(std::min(n_cells, n_ranks_))
  {
    make_mesh();
  }

  Discretization::~Discretization() = default;

  void
  Discretization::make_mesh()
  {
    mesh_      = std::make_unique<Mesh>(communicator_, element_.degree);
    auto &tria = mesh_->triangulation;
    auto &dofs = mesh_->dof_handler;

    // Each rank owns a run of neighbouring cells.
    const auto assign = [&]()
    {
      const auto n         = static_cast<std::uint64_t>(tria.n_active_cells());
      std::uint64_t number = 0;
      for (const auto &cell : tria.active_cell_iterators())
        cell->set_subdomain_id(static_cast<dealii::types::subdomain_id>(number++ * n_active_ranks_ / n));
    };
    tria.signals.create.connect(assign); // the first mesh does not count as a refinement
    tria.signals.post_refinement.connect(assign);
    dealii::GridGenerator::subdivided_hyper_cube(tria, n_cells_, 0., length_);
    dofs.distribute_dofs(mesh_->element);

    // Number the unknowns along the body. FE_Q lists the two ends of a cell before its inside.
    const unsigned int q = element_.degree;
    std::vector<dealii::types::global_dof_index> numbers(dofs.n_dofs()), of_cell(q + 1);
    std::size_t cell_number = 0;
    for (const auto &cell : dofs.active_cell_iterators())
    {
      cell->get_dof_indices(of_cell);
      numbers[of_cell[0]] = cell_number * q;
      numbers[of_cell[1]] = (cell_number + 1) * q;
      for (unsigned int i = 1; i < q; ++i)
        numbers[of_cell[i + 1]] = cell_number * q + i;
      if (cell->is_locally_owned())
      {
        cell_left_.push_back(cell->vertex(0)[0]);
        cell_size_.push_back(cell->vertex(1)[0] - cell->vertex(0)[0]);
      }
      ++cell_number;
    }
    dofs.renumber_dofs(numbers);
    if (dofs.n_locally_owned_dofs() != n_owned() || (rank_ < n_active_ranks_) == cell_left_.empty())
      throw std::logic_error("deal.II's ownership of unknowns is not the one of the chain numbering");
  }

  std::vector<double>
  Discretization::quadrature_points() const
  {
    std::vector<double> points;
    points.reserve(cell_left_.size() * element_.n);
    for (std::size_t c = 0; c < cell_left_.size(); ++c)
      for (const double x : element_.points)
        points.push_back(cell_left_[c] + x * cell_size_[c]);
    return points;
  }

  std::span<const double>
  Discretization::to_local(const std::span<const double> owned, std::vector<double> &buffer) const
  {
    if (n_active_ranks_ == 1 || n_local() == 0)
      return owned;
    double from_left = 0.;
    const auto left  = has_left_neighbour() ? static_cast<int>(rank_) - 1 : MPI_PROC_NULL;
    const auto right = has_right_neighbour() ? static_cast<int>(rank_) + 1 : MPI_PROC_NULL;
    MPI_Sendrecv(
      &owned.back(), 1, MPI_DOUBLE, right, 0, &from_left, 1, MPI_DOUBLE, left, 0, communicator_, MPI_STATUS_IGNORE);
    if (!has_left_neighbour())
      return owned;
    buffer.resize(n_local());
    buffer[0] = from_left;
    std::copy(owned.begin(), owned.end(), buffer.begin() + 1);
    return buffer;
  }

  void
  Discretization::add_to_owned(const std::span<const double> local, const std::span<double> owned) const
  {
    if (n_local() == 0)
      return;
    const bool skip_first = has_left_neighbour();
    if (owned.data() != local.data())
      std::copy(local.begin() + (skip_first ? 1 : 0), local.end(), owned.begin());
    if (n_active_ranks_ == 1)
      return;
    double from_right = 0.;
    const auto left   = has_left_neighbour() ? static_cast<int>(rank_) - 1 : MPI_PROC_NULL;
    const auto right  = has_right_neighbour() ? static_cast<int>(rank_) + 1 : MPI_PROC_NULL;
    MPI_Sendrecv(
      local.data(), 1, MPI_DOUBLE, left, 1, &from_right, 1, MPI_DOUBLE, right, 1, communicator_, MPI_STATUS_IGNORE);
    owned.back() += from_right;
  }
} // namespace crawler
