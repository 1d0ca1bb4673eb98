// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/parameters.h>

namespace crawler
{
  void
  Parameters::add_parameters(Declarations &declarations)
  {
    RunParameters::add_parameters(declarations);
    sweep.add_parameters(declarations);
    atlas.add_parameters(declarations);
    tradeoff.add_parameters(declarations);
  }
} // namespace crawler
