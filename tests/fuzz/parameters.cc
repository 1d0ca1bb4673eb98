// SPDX-License-Identifier: LGPL-2.1-or-later
//
// A parameter file: what is accepted is written with all entries, and must be read from there as the same.
#include <crawler/studies/core/input.h>

#include <regex>
#include <unistd.h>

#include "fuzz.h"

namespace
{
  /// The text without comments, and with names of files as they were set: defaults have no folder before they are read.
  std::string
  meaning(const std::string &text)
  {
    static const std::regex comments(" +#[^\n]*"), folder(crawler::fuzz::scratch().string() + "/");
    return std::regex_replace(std::regex_replace(text, comments, ""), folder, "");
  }
} // namespace

int
LLVMFuzzerTestOneInput(const std::uint8_t *data, const std::size_t size)
{
  using namespace crawler;
  fuzz::start_mpi();
  static const bool is_inside = chdir(fuzz::scratch().c_str()) == 0; // where names of files lead to nothing
  fuzz::require(is_inside, "the folder for files can be entered");
  std::string effective;
  const auto read = [&](const std::string &text) {
    Input input = read_input(ParameterFile::from_text(text, "fuzzed.prm"));
    effective   = input.effective;
    choose_model(input);
  };
  if (!fuzz::is_accepted([&]() { read({reinterpret_cast<const char *>(data), size}); }))
    return 0;
  const std::string before = effective;
  fuzz::require(fuzz::is_accepted([&]() { read(before); }), "parameters.prm is accepted as the file was");
  fuzz::require(meaning(effective) == meaning(before), "parameters.prm means the same as the file");
  return 0;
}
