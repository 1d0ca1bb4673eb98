// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/command_line.h>

int
main(int argc, char **argv)
{
  return crawler::run_command_line(argc, argv);
}
