// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/mesh/triangulation.h>

#include <dlfcn.h>
#include <string>

namespace crawler
{
  /// Calls the shared library crawler_deal_ii (source/deal_ii). It alone links deal.II, which takes ten times as long
  /// to load as all the rest and which most commands do not need; so it is loaded on first use.
  std::unique_ptr<Triangulation>
  create_triangulation(MPI_Comm communicator, const std::vector<double> &ends)
  {
    const char *const name     = "crawler_create_triangulation";
    static void *const library = dlopen(CRAWLER_DEAL_II_LIBRARY, RTLD_LAZY | RTLD_LOCAL);
    void *const symbol         = library != nullptr ? dlsym(library, name) : nullptr;
    if (symbol == nullptr)
    {
      const char *const reason = dlerror();
      throw FileError(std::string("cannot load the part of the program that needs deal.II: ") +
                      (reason != nullptr ? reason : name));
    }
    return std::unique_ptr<Triangulation>(reinterpret_cast<CreateTriangulation *>(symbol)(communicator, ends));
  }
} // namespace crawler
