// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What a sweep costs besides the points: taking the next block from the counter, and writing the rows of a block.
//
//     mpirun -n N work_sharing [FOLDER]      (default: the current one; take the file system that a sweep would write
//     to)
//
// All ranks do the same at the same time. Prints the mean time of each on a rank, and of all ranks together how many a
// second. The counter is measured twice: while rank 0 takes part, and while it computes (and calls serve(), as a sweep
// does at every step).
#include <crawler/base/communication.h>
#include <crawler/base/mpi_session.h>
#include <crawler/base/row_file.h>
#include <crawler/base/work_queue.h>

#include <fmt/format.h>

#include <filesystem>
#include <functional>

namespace
{
  using namespace crawler;

  constexpr unsigned long n_numbers = 64, n_texts = 10, block = 64; // as in a sweep
  constexpr unsigned int text_width = 32;

  /// Mean over the ranks that have worked of the time of one of @p n actions [s], on rank 0.
  double
  seconds_each(const unsigned int n, const bool works, const std::function<void(unsigned int)> &action)
  {
    MPI_Barrier(MPI_COMM_WORLD);
    const double start = MPI_Wtime();
    for (unsigned int i = 0; works && i < n; ++i)
      action(i);
    double sums[2] = {works ? (MPI_Wtime() - start) / n : 0., works ? 1. : 0.};
    MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return sums[0] / sums[1];
  }

  void
  print(const std::string &what, const double each, const unsigned int n_working)
  {
    if (rank_of(MPI_COMM_WORLD) == 0)
      fmt::print("| {:<47} | {:>9.2f} | {:>10.3g} |\n", what, 1e6 * each, n_working / each);
  }

  void
  measure_counter(const unsigned int n_ranks)
  {
    constexpr unsigned int n = 20000;
    const bool first         = rank_of(MPI_COMM_WORLD) == 0;
    {
      WorkQueue queue(MPI_COMM_WORLD, ~0ul / 2);
      const double each = seconds_each(n, true, [&](unsigned int) { queue.next(); });
      print("next block, all ranks ask", each, n_ranks);
    }
    if (n_ranks == 1)
      return;
    WorkQueue queue(MPI_COMM_WORLD, ~0ul / 2);
    // Rank 0 is busy until the others are through; it sees that in the counter of what is done.
    constexpr unsigned int few = 500;
    if (first)
    {
      MPI_Barrier(MPI_COMM_WORLD);
      while (queue.so_far().done < n_ranks - 1)
        for (int i = 0; i < 1000; ++i)
          queue.serve();
      double sums[2] = {0., 0.};
      MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
      print("next block, rank 0 computes", sums[0] / sums[1], n_ranks - 1);
    }
    else
      seconds_each(few, true, [&](const unsigned int i) {
        queue.next();
        if (i + 1 == few)
          queue.done();
      });
  }

  void
  measure_rows(const unsigned int n_ranks, const std::filesystem::path &path)
  {
    constexpr unsigned int n_blocks = 200;
    std::vector<RowFile::Column> columns;
    RowFile::Row row;
    for (unsigned long i = 0; i < n_numbers + n_texts; ++i)
    {
      const bool is_number = i < n_numbers;
      columns.push_back({fmt::format("column {}", i), "", "", is_number ? 0 : text_width});
      row.push_back(is_number ? RowFile::Value(1. / (1. + i)) : RowFile::Value("finished"));
    }
    on_first_rank(MPI_COMM_WORLD, [&]() {
      const double start = MPI_Wtime();
      RowFile::create(path, "results", columns, n_blocks * block * n_ranks, {});
      print("making the file, each row", (MPI_Wtime() - start) / (n_blocks * block * n_ranks), 1);
    });
    const std::vector<RowFile::Row> rows(block, row);
    {
      RowFile file(MPI_COMM_WORLD, path, "results", columns);
      const unsigned int rank = rank_of(MPI_COMM_WORLD);
      const double each =
        seconds_each(n_blocks, true, [&](const unsigned int i) { file.write((i * n_ranks + rank) * block, rows); });
      print(fmt::format("writing {} rows of {} columns", block, columns.size()), each, n_ranks);
    }
    on_first_rank(MPI_COMM_WORLD, [&]() { std::filesystem::remove(path); });
  }
} // namespace

int
main(int argc, char **argv)
{
  const crawler::MpiSession mpi(argc, argv);
  const unsigned int n_ranks = size_of(MPI_COMM_WORLD);
  if (rank_of(MPI_COMM_WORLD) == 0)
    fmt::print("| on {:<4} rank{:<38} | us each   | a second   |\n|---|---|---|\n", n_ranks, n_ranks == 1 ? "" : "s");
  measure_counter(n_ranks);
  measure_rows(n_ranks, std::filesystem::path(argc > 1 ? argv[1] : ".") / "work_sharing.h5");
}
