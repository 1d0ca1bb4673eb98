// SPDX-License-Identifier: LGPL-2.1-or-later
//
// A command line, its words in lines of their own; those behind "--" are for PETSc. What computes, draws or writes is
// read only.
#include <crawler/app/commands.h>

#include <algorithm>
#include <iostream>
#include <sstream>

#include "fuzz.h"

int
LLVMFuzzerTestOneInput(const std::uint8_t *data, const std::size_t size)
{
  using namespace crawler;
  fuzz::Bytes bytes(data, size);
  std::vector<std::string> words, petsc_options;
  bool is_behind = false;
  while (!bytes.is_empty())
  {
    const std::string word = bytes.word('\n');
    if (!is_behind && word == "--")
      is_behind = true;
    else
      (is_behind ? petsc_options : words).push_back(word);
  }
  std::ostringstream screen;
  std::streambuf *const before = std::cout.rdbuf(screen.rdbuf());
  fuzz::is_accepted([&]() {
    Commands commands;
    if (!commands.parse(words, petsc_options) || commands.needs_mpi() || words[0] == "plot")
      return;
    if (std::none_of(words.begin(), words.end(), [](const std::string &word) { return word.starts_with("--output"); }))
      commands.run_alone();
  });
  std::cout.rdbuf(before);
  return 0;
}
