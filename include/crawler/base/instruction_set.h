// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

/**
 * Namespace of the loops over cells: templates that several files compile, some for instruction sets that not every
 * processor has (source/lanes). Each instruction set has its own namespace, or the linker could use a function compiled
 * for one of them in the whole program.
 */
#ifndef CRAWLER_INSTRUCTION_SET
#  define CRAWLER_INSTRUCTION_SET generic
#endif
