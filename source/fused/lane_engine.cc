// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/fused/lane_engine.h>

#include <cstring>

namespace crawler
{
  // source/fused/lanes.cc, compiled for each.
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
    const Compiled (&compiled())[3]
    {
#ifdef __x86_64__
      static const bool has_avx2   = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"),
                        has_avx512 = has_avx2 && __builtin_cpu_supports("avx512f") &&
                                     __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
      static const Compiled list[3] = {{avx512::batch, avx512::single, has_avx512},
                                       {avx2::batch, avx2::single, has_avx2},
                                       {baseline::batch, baseline::single, true}};
#else
      static const Compiled list[3] = {{baseline::batch, baseline::single, true},
                                       {baseline::batch, baseline::single, true},
                                       {baseline::batch, baseline::single, true}};
#endif
      return list;
    }
  } // namespace

  const LaneEngine &
  batch_engine()
  {
    for (const Compiled &engine : compiled())
      if (engine.usable)
        return engine.batch;
    return baseline::batch;
  }

  const LaneEngine &
  single_engine()
  {
    for (const Compiled &engine : compiled())
      if (engine.usable)
        return engine.single;
    return baseline::single;
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
