// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/library.h>

namespace crawler
{
  void
  LibraryParameters::add_parameters(Declarations &declarations)
  {
    declarations.file("File", file, "the name of a shared object")
      .means("Shared object with the active stress as a plug-in (doc/generators/library.md).");
    declarations.text("Parameters", parameters, "a list name=value, name=value")
      .means("Parameters that are passed to the plug-in, which defines their names.");
  }
} // namespace crawler
