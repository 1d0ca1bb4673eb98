// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

/// The parts of crawler_benchmark; each registers its benchmarks.
namespace crawler::test
{
  void
  add_run_benchmarks();
  void
  add_sweep_benchmarks();
  void
  add_kernel_benchmarks();
} // namespace crawler::test
