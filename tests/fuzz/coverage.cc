// SPDX-License-Identifier: LGPL-2.1-or-later
//
// GCC calls this function at every branch of what is compiled with -fsanitize-coverage=trace-pc. libFuzzer looks at
// the numbers in the section of this name to see whether an input went another way.
#include <cstdint>

namespace
{
  constexpr std::uintptr_t n_counters = 1 << 16;
  __attribute__((section("__libfuzzer_extra_counters"))) std::uint8_t counters[n_counters];
} // namespace

extern "C" __attribute__((no_sanitize_coverage, no_sanitize("address", "undefined"))) void
__sanitizer_cov_trace_pc()
{
  const auto place    = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0));
  std::uint8_t &count = counters[(place ^ (place >> 16)) % n_counters];
  if (count < 255)
    ++count;
}

// With trace-cmp GCC also tells which floating-point numbers are compared; libFuzzer, which is told the integers, has
// no use for these.
extern "C" void
__sanitizer_cov_trace_cmpf(float, float)
{
}

extern "C" void
__sanitizer_cov_trace_cmpd(double, double)
{
}
