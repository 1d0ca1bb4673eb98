// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// The address of a function of the shared library crawler_deal_ii (source/deal_ii). It alone links deal.II, whose
  /// loading takes ten times as long as that of all else, and which most commands do not need: so it is loaded when a
  /// function is first asked for. Throws FileError if that fails.
  void *
  deal_ii_symbol(const char *name);

  template <typename Function>
  Function *
  deal_ii_function(const char *const name)
  {
    return reinterpret_cast<Function *>(deal_ii_symbol(name));
  }
} // namespace crawler
