// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/deal_ii_library.h>
#include <crawler/base/exceptions.h>

#include <dlfcn.h>

#include <string>

namespace crawler
{
  void *
  deal_ii_symbol(const char *const name)
  {
    static void *const library = dlopen(CRAWLER_DEAL_II_LIBRARY, RTLD_LAZY | RTLD_LOCAL);
    void *const symbol         = library != nullptr ? dlsym(library, name) : nullptr;
    if (symbol == nullptr)
    {
      const char *const reason = dlerror();
      throw FileError(std::string("cannot load the part of the program that needs deal.II: ") +
                      (reason != nullptr ? reason : name));
    }
    return symbol;
  }
} // namespace crawler
