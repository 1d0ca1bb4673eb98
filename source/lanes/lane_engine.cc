// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/lanes/lane_engine.h>

#include <algorithm>
#include <cstring>
#include <span>

namespace crawler
{
  // source/lanes/lanes.cc, compiled for each.
#ifdef __x86_64__
  namespace avx512
  {
    extern const LaneEngine batch, single;
  }
  namespace avx2
  {
    extern const LaneEngine batch, single;
  }
#endif
  namespace baseline
  {
    extern const LaneEngine batch, single;
  }

  namespace
  {
    struct Compiled
    {
      const LaneEngine &batch, &single;
      bool usable;
    };

    /// The best one first.
    std::span<const Compiled>
    compiled()
    {
#ifdef __x86_64__
      static const bool has_avx2   = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"),
                        has_avx512 = has_avx2 && __builtin_cpu_supports("avx512f") &&
                                     __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
      static const Compiled list[] = {{avx512::batch, avx512::single, has_avx512},
                                      {avx2::batch, avx2::single, has_avx2},
                                      {baseline::batch, baseline::single, true}};
#else
      static const Compiled list[] = {{baseline::batch, baseline::single, true}};
#endif
      return list;
    }

    const Compiled &
    best()
    {
      return *std::ranges::find_if(compiled(), &Compiled::usable);
    }
  } // namespace

  const LaneEngine &
  batch_engine()
  {
    return best().batch;
  }

  const LaneEngine &
  single_engine()
  {
    return best().single;
  }

  const LaneEngine *
  batch_engine(const char *instruction_set)
  {
    for (const Compiled &engine : compiled())
      if (engine.usable && std::strcmp(engine.batch.instruction_set, instruction_set) == 0)
        return &engine.batch;
    return nullptr;
  }
} // namespace crawler
