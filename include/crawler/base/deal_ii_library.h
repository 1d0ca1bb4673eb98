// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// Address of a function of the shared library crawler_deal_ii (source/deal_ii). It alone links deal.II, which takes
  /// ten times as long to load as all the rest and which most commands do not need; so it is loaded on first use.
  /// Throws FileError if that fails.
  void *
  deal_ii_symbol(const char *name);

  template <typename Function>
  Function *
  deal_ii_function(const char *const name)
  {
    return reinterpret_cast<Function *>(deal_ii_symbol(name));
  }
} // namespace crawler
