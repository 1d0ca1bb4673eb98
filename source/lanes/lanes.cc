// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Compiled once for each instruction set; CRAWLER_INSTRUCTION_SET names it and CRAWLER_PACK is the widest pack.
#include <crawler/lanes/adjoint_sweep.h>
#include <crawler/lanes/radau_lanes.h>

namespace crawler::CRAWLER_INSTRUCTION_SET
{
  namespace
  {
    /// Result of @p use for the engine of a setup, as the type of a null pointer.
    template <typename Pack, typename Use>
    auto
    with_engine(const LaneSetup &setup, const Use &use)
    {
      if constexpr (PackTraits<Pack>::size == 1)
        if (setup.is_stretch)
          return setup.n_stages == 3 ? use(static_cast<RadauLanes<Pack, 3, StretchSystem> *>(nullptr))
                                     : use(static_cast<RadauLanes<Pack, 5, StretchSystem> *>(nullptr));
      return setup.n_stages == 3 ? use(static_cast<RadauLanes<Pack, 3, PositionSystem> *>(nullptr))
                                 : use(static_cast<RadauLanes<Pack, 5, PositionSystem> *>(nullptr));
    }

    template <typename Pack>
    std::size_t
    memory(const LaneSetup &setup)
    {
      return with_engine<Pack>(setup, [&](auto *lanes) { return lanes->memory(setup); });
    }

    template <typename Pack>
    void
    start(const LaneSetup &setup, LaneHost &host, double *memory)
    {
      with_engine<Pack>(setup, [&](auto *lanes) { lanes->start(setup, &host, memory); });
    }

    template <typename Pack>
    bool
    advance(const LaneSetup &setup, double *memory)
    {
      return with_engine<Pack>(setup,
                               [memory](auto *lanes) { return reinterpret_cast<decltype(lanes)>(memory)->advance(); });
    }

    std::size_t
    adjoint_memory(const LaneSetup &setup)
    {
      return setup.n_stages == 3   ? AdjointSweep<3>::memory(setup)
             : setup.n_stages == 5 ? AdjointSweep<5>::memory(setup)
                                   : AdjointSweep<7>::memory(setup);
    }

    bool
    adjoint(const LaneSetup &setup, LaneAdjointHost &host, const LaneBody &body, const LanePast &past, double *memory)
    {
      return setup.n_stages == 3   ? AdjointSweep<3>(setup, &host, memory).run(body, past)
             : setup.n_stages == 5 ? AdjointSweep<5>(setup, &host, memory).run(body, past)
                                   : AdjointSweep<7>(setup, &host, memory).run(body, past);
    }

#define CRAWLER_TEXT(name) CRAWLER_TEXT_OF(name)
#define CRAWLER_TEXT_OF(name) #name
    template <typename Pack>
    constexpr LaneEngine engine = {CRAWLER_TEXT(CRAWLER_INSTRUCTION_SET),
                                   PackTraits<Pack>::size,
                                   memory<Pack>,
                                   start<Pack>,
                                   advance<Pack>,
                                   adjoint_memory,
                                   adjoint};
  } // namespace

  extern const LaneEngine batch, single;
  const LaneEngine batch  = engine<CRAWLER_PACK>;
  const LaneEngine single = engine<double>;
} // namespace crawler::CRAWLER_INSTRUCTION_SET
