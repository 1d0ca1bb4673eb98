// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/lanes/lane_engine.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>

namespace crawler
{
  // Namespaces of source/lanes/lanes.cc, which is compiled for each.
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

    /// Engines compiled, the best one first.
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

    /// Engine for the lanes: the best one, or the one that is forced.
    const Compiled &
    chosen()
    {
      static const Compiled &result =
        *std::ranges::find_if(compiled(), [forced = forced_instruction_set()](const Compiled &engine) {
          return engine.usable && (forced == nullptr || std::strcmp(engine.batch.instruction_set, forced) == 0);
        });
      return result;
    }
  } // namespace

  bool
  LawHost::evaluate(const LanePoints &)
  {
    return false;
  }

  double
  LawHost::evaluate_cells(double, const double *, const double *, const double *, CellLaws<double> &)
  {
    return 0.;
  }

  const char *
  forced_instruction_set()
  {
    const char *const name = std::getenv("CRAWLER_INSTRUCTION_SET");
    if (name == nullptr || *name == '\0' || batch_engine(name) != nullptr)
      return name == nullptr || *name == '\0' ? nullptr : name;
    std::string usable, is_known = "there is no such instruction set";
    for (const Compiled &engine : compiled())
    {
      if (engine.usable)
        usable += fmt::format("{}{}", usable.empty() ? "" : ", ", engine.batch.instruction_set);
      if (std::strcmp(engine.batch.instruction_set, name) == 0)
        is_known = "this processor does not have it";
    }
    throw InputError(
      fmt::format("CRAWLER_INSTRUCTION_SET is \"{}\", but {}; possible here are {}", name, is_known, usable));
  }

  const LaneEngine &
  batch_engine()
  {
    return chosen().batch;
  }

  const LaneEngine &
  single_engine()
  {
    return chosen().single;
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
