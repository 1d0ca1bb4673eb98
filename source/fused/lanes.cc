// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Compiled once for each instruction set; CRAWLER_INSTRUCTION_SET names it and CRAWLER_PACK is the widest pack.
#include <crawler/fused/radau_lanes.h>

namespace crawler::CRAWLER_INSTRUCTION_SET
{
  namespace
  {
    template <typename Pack>
    std::size_t
    memory(const LaneSetup &setup)
    {
      return setup.n_stages == 3 ? RadauLanes<Pack, 3>::memory(setup) : RadauLanes<Pack, 5>::memory(setup);
    }

    template <typename Pack>
    void
    run(const LaneSetup &setup, const LaneHost &host, double *memory)
    {
      if (setup.n_stages == 3)
        RadauLanes<Pack, 3>(setup, host, memory).run();
      else
        RadauLanes<Pack, 5>(setup, host, memory).run();
    }

#define CRAWLER_TEXT(name) CRAWLER_TEXT_OF(name)
#define CRAWLER_TEXT_OF(name) #name
    template <typename Pack>
    constexpr LaneEngine engine = {
      CRAWLER_TEXT(CRAWLER_INSTRUCTION_SET), PackTraits<Pack>::size, memory<Pack>, run<Pack>};
  } // namespace

  extern const LaneEngine batch, single;
  const LaneEngine batch  = engine<CRAWLER_PACK>;
  const LaneEngine single = engine<double>;
} // namespace crawler::CRAWLER_INSTRUCTION_SET
