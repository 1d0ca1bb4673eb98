// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What one Newton step (residual, Jacobian, elimination, solution; degree 2) costs against the size of the mesh and the
// number of ranks that share it:
//
//     mpirun -n 1|2 scale_ranks [number of cells ...]
//
// A time is the largest over the ranks, which start together; the table has the median and the smallest of the
// repetitions. On a machine that does other things as well the CPU time says more: the smallest over repetitions and
// ranks, since ranks that wait for each other use the CPU, too. Each step is at a new time, so the active stress is
// evaluated once in it. With complex numbers the step has one complex system, as one pair of stages of a Radau method
// has. Prints a table in Markdown.
#include "../support/processor_time.h"
#include "../support/ranks.h"
#include "../support/run_text.h"

#include <crawler/base/communication.h>
#include <crawler/base/mpi_session.h>
#include <crawler/equation/position_form.h>

#include <algorithm>
#include <limits>

namespace
{
  using namespace crawler;

  constexpr unsigned int degree     = 2;
  constexpr double shift            = 100.; ///< of the size of a few stages of a step of 0.01 [1/time]
  constexpr double seconds_of_a_row = 1.;
  constexpr unsigned int min_times  = 5;

  /// A rank's share of a crawler, and a state of it.
  struct Bench
  {
    explicit Bench(const unsigned int n_cells)
      : scene(test::parameters_with(test::wave(-1., 0.4)).create_scene())
      , discretization(MPI_COMM_WORLD, 1., n_cells, degree)
      , assembler(std::make_unique<PositionForm>(scene, discretization))
      , y(assembler->n_owned(), 0.)
      , rate(y)
      , F(y)
      , complex_F(y.size())
    {
    }

    void
    newton_step(const double t, const bool is_complex)
    {
      assembler->residual(t, y, rate, F);
      if (!is_complex)
      {
        assembler->setup_jacobian(t, y, rate, shift);
        assembler->solve_with_jacobian(F, F);
        return;
      }
      std::copy(F.begin(), F.end(), complex_F.begin());
      const std::complex<double> sigma{shift, shift};
      assembler->setup_complex_jacobians(t, y, rate, {&sigma, 1});
      assembler->solve_with_complex_jacobian(0, complex_F, complex_F);
    }

    Scene scene;
    Discretization discretization;
    std::unique_ptr<PositionForm> assembler;
    std::vector<double> y, rate, F;
    std::vector<std::complex<double>> complex_F;
  };

  struct Seconds
  {
    double wall, cpu;
  };

  Seconds
  now()
  {
    return {MPI_Wtime(), test::processor_seconds()};
  }

  /// So many steps are timed at once that a clock can see them.
  Seconds
  seconds_per_step(Bench &bench, const bool is_complex, const unsigned int steps, double &t)
  {
    MPI_Barrier(MPI_COMM_WORLD);
    const Seconds start = now();
    for (unsigned int i = 0; i < steps; ++i)
      bench.newton_step(t += 1e-9, is_complex);
    const Seconds end = now();
    return {test::over_ranks((end.wall - start.wall) / steps, MPI_MAX),
            test::over_ranks((end.cpu - start.cpu) / steps, MPI_MIN)};
  }

  void
  print_row(const bool is_complex, const unsigned int n_cells)
  {
    Bench bench(n_cells);
    double t                 = 0.3;
    const unsigned int steps = std::max(1u, 10000 / n_cells);
    seconds_per_step(bench, is_complex, steps, t); // memory is touched for the first time
    const double guess = seconds_per_step(bench, is_complex, steps, t).wall;
    const auto times   = std::max(min_times, static_cast<unsigned int>(seconds_of_a_row / (guess * steps)));
    std::vector<double> seconds;
    double cpu = std::numeric_limits<double>::infinity();
    while (seconds.size() < times)
    {
      const Seconds repetition = seconds_per_step(bench, is_complex, steps, t);
      seconds.push_back(repetition.wall);
      cpu = std::min(cpu, repetition.cpu);
    }
    std::sort(seconds.begin(), seconds.end());
    const std::size_t unknowns = bench.discretization.n_unknowns();
    const double median        = seconds[seconds.size() / 2];
    if (bench.discretization.rank == 0)
      fmt::print("| {} | {} | {} | {} | {:.4g} | {:.4g} | {:.4g} | {:.1f} |\n",
                 bench.discretization.n_ranks,
                 is_complex ? "complex" : "real",
                 n_cells,
                 unknowns,
                 1e3 * median,
                 1e3 * seconds.front(),
                 1e3 * cpu,
                 1e9 * seconds.front() / n_cells);
    std::fflush(stdout);
  }
} // namespace

int
main(int argc, char **argv)
{
  const crawler::MpiSession guard(argc, argv);
  std::vector<unsigned int> cells;
  for (int i = 1; i < argc; ++i)
    cells.push_back(static_cast<unsigned int>(std::stoul(argv[i])));
  if (cells.empty())
    cells = {10, 100, 1000, 5000, 10000, 50000, 100000, 500000, 1000000};
  if (crawler::rank_of(MPI_COMM_WORLD) == 0)
    fmt::print("| ranks | shift | cells | unknowns | ms per step, median | smallest | CPU | ns per cell (smallest) |\n"
               "|---|---|---|---|---|---|---|---|\n");
  for (const bool is_complex : {false, true})
    for (const unsigned int n_cells : cells)
      print_row(is_complex, n_cells);
  return 0;
}
