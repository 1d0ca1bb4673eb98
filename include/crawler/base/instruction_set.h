// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

/**
 * The loops over cells are templates that several files compile, some of them for instruction sets that not every
 * processor has (source/lanes). Each instruction set has a namespace of its own, or the linker could take a function
 * that was compiled for one of them for the whole program.
 */
#ifndef CRAWLER_INSTRUCTION_SET
#  define CRAWLER_INSTRUCTION_SET generic
#endif
