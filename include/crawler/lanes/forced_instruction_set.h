// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// Instruction set that the environment variable CRAWLER_INSTRUCTION_SET requests for all lanes ("baseline", "avx2",
  /// "avx512"), else null. Throws InputError if there is no such set, or if this processor does not have it.
  const char *
  forced_instruction_set();
} // namespace crawler
