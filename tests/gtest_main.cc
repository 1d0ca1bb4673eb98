// SPDX-License-Identifier: LGPL-2.1-or-later
#include "support/ranks.h"

#include <crawler/base/communication.h>
#include <crawler/base/mpi_session.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>

#ifdef __SANITIZE_ADDRESS__
#  include <sanitizer/lsan_interface.h>

/// What the runtime of MPI keeps to the end of a program on several ranks.
extern "C" const char *
__lsan_default_suppressions()
{
  return "leak:libpmix\nleak:libopen-pal\nleak:libopen-rte\nleak:libmpi\n";
}
#endif

namespace
{
  /// Restricts the run to the tests of one source, archive_test for archive_test.cc, but for suites named Long...;
  /// "long" are these, of all sources (contrib/verify.sh). Returns how many there are.
  unsigned int
  keep_tests_of(const std::string &source)
  {
    const auto &all = *::testing::UnitTest::GetInstance();
    std::string filter;
    unsigned int n = 0;
    for (int i = 0; i < all.total_test_suite_count(); ++i)
    {
      const auto &suite = *all.GetTestSuite(i);
      for (int j = 0; j < suite.total_test_count(); ++j)
        if (const auto &test = *suite.GetTestInfo(j); std::string_view(suite.name()).starts_with("Long")
                                                        ? source == "long"
                                                        : std::filesystem::path(test.file()).stem() == source)
        {
          filter += std::string(suite.name()) + "." + test.name() + ":";
          ++n;
        }
    }
    ::testing::GTEST_FLAG(filter) = filter;
    return n;
  }
} // namespace

/// Runs the tests of all sources of the program, or of the one that is named: unit_base archive_test; or the long ones.
/// Starts MPI and PETSc for all tests of a program; only rank 0 prints, and all ranks fail together.
/// Leaks are looked for in what the tests allocate. Start and end of MPI are left out: it loads and unloads modules,
/// and what these keep would look like leaks of unknown origin.
int
main(int argc, char **argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  int one = 1; // PETSc need not see GoogleTest's options
#ifdef __SANITIZE_ADDRESS__
  __lsan_disable();
#endif
  const crawler::MpiSession guard(one, argv);
#ifdef __SANITIZE_ADDRESS__
  __lsan_enable();
#endif
  if (argc > 1 && keep_tests_of(argv[1]) == 0)
  {
    std::cerr << argv[0] << " has no tests named " << argv[1] << "\n";
    return 2;
  }
  auto &listeners = ::testing::UnitTest::GetInstance()->listeners();
  if (crawler::rank_of(MPI_COMM_WORLD) != 0)
    delete listeners.Release(listeners.default_result_printer());
  const int failed = RUN_ALL_TESTS();
#ifdef __SANITIZE_ADDRESS__
  __lsan_do_leak_check();
#endif
  return crawler::test::over_ranks(failed, MPI_MAX);
}
