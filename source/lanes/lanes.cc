// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Compiled once for each instruction set; CRAWLER_INSTRUCTION_SET names it and CRAWLER_PACK is the widest pack.
#include <crawler/lanes/adjoint_lanes.h>
#include <crawler/lanes/radau_lanes.h>

namespace crawler::CRAWLER_INSTRUCTION_SET
{
  namespace
  {
    template <typename Pack, template <typename, int> class System>
    std::size_t
    memory_of(const LaneSetup &setup)
    {
      return setup.n_stages == 3 ? RadauLanes<Pack, 3, System>::memory(setup)
                                 : RadauLanes<Pack, 5, System>::memory(setup);
    }

    template <typename Pack, template <typename, int> class System>
    void
    run_in(const LaneSetup &setup, const LaneHost &host, double *memory)
    {
      if (setup.n_stages == 3)
        RadauLanes<Pack, 3, System>(setup, host, memory).run();
      else
        RadauLanes<Pack, 5, System>(setup, host, memory).run();
    }

    template <typename Pack>
    std::size_t
    memory(const LaneSetup &setup)
    {
      return setup.is_stretch ? memory_of<Pack, StretchSystem>(setup) : memory_of<Pack, PositionSystem>(setup);
    }

    template <typename Pack>
    void
    run(const LaneSetup &setup, const LaneHost &host, double *memory)
    {
      if (setup.is_stretch)
        run_in<Pack, StretchSystem>(setup, host, memory);
      else
        run_in<Pack, PositionSystem>(setup, host, memory);
    }

    template <typename Pack>
    std::size_t
    adjoint_memory(const LaneSetup &setup)
    {
      return setup.n_stages == 3   ? AdjointLanes<Pack, 3>::memory(setup)
             : setup.n_stages == 5 ? AdjointLanes<Pack, 5>::memory(setup)
                                   : AdjointLanes<Pack, 7>::memory(setup);
    }

    template <typename Pack>
    void
    adjoint(const LaneSetup &setup, const LaneAdjointHost &host, double *memory)
    {
      if (setup.n_stages == 3)
        AdjointLanes<Pack, 3>(setup, host, memory).run();
      else if (setup.n_stages == 5)
        AdjointLanes<Pack, 5>(setup, host, memory).run();
      else
        AdjointLanes<Pack, 7>(setup, host, memory).run();
    }

#define CRAWLER_TEXT(name) CRAWLER_TEXT_OF(name)
#define CRAWLER_TEXT_OF(name) #name
    template <typename Pack>
    constexpr LaneEngine engine = {CRAWLER_TEXT(CRAWLER_INSTRUCTION_SET),
                                   PackTraits<Pack>::size,
                                   memory<Pack>,
                                   run<Pack>,
                                   adjoint_memory<Pack>,
                                   adjoint<Pack>};
  } // namespace

  extern const LaneEngine batch, single;
  const LaneEngine batch  = engine<CRAWLER_PACK>;
  const LaneEngine single = engine<double>;
} // namespace crawler::CRAWLER_INSTRUCTION_SET
