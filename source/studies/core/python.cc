// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/process.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/python.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>
#include <sysexits.h>
#include <unistd.h>

namespace crawler
{
  PythonEnd
  call_python(const std::string &script, const std::vector<std::string> &arguments, const bool shown)
  {
    std::error_code ignored;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    const auto folder  = program.parent_path(); // of the build, or of the installed program
    const std::array<std::filesystem::path, 2> places = {
      {folder.parent_path() / CRAWLER_INSTALLED_PYTHON / script, folder / "python/crawler" / script}};
    setenv("CRAWLER_PROGRAM", program.c_str(), /*overwrite=*/1);
    setenv("CRAWLER_PROGRAM_ID", std::to_string(getpid()).c_str(), /*overwrite=*/1);
    const auto *const path =
      std::ranges::find_if(places, [&](const auto &place) { return std::filesystem::exists(place, ignored); });
    if (path == places.end())
      return {EX_UNAVAILABLE,
              fmt::format("the script {} is neither at {} nor at {}; a copy of the program alone has no scripts, the "
                          "installed program and the one in the build folder have them",
                          std::filesystem::path(script).filename().string(),
                          places[0].lexically_normal().string(),
                          places[1].string())};
    // Scripts that lack a module in this Python go on with Debian's (contrib/python/crawler/needs.py).
    for (const std::string python : {"python3", "/usr/bin/python3"})
    {
      std::vector<std::string> command = {python, path->string()};
      command.insert(command.end(), arguments.begin(), arguments.end());
      if (const ProgramEnd end = run_program(command, shown); end.started)
        return end.stopped ? PythonEnd{static_cast<int>(ExitCode::stopped), "stopped by a signal"}
                           : PythonEnd{end.status, trimmed(end.errors)};
    }
    return {EX_UNAVAILABLE, "python3 was not found (Debian: apt install python3-h5py python3-matplotlib)"};
  }

  void
  hand_over_to_python(const std::string &script, const std::vector<std::string> &arguments)
  {
    std::cout.flush(); // the script writes to the same stream
    const PythonEnd end = call_python(script, arguments, /*shown=*/true);
    if (end.status == static_cast<int>(ExitCode::file_error))
      throw FileError(end.problem, /*on_all_ranks=*/true);
    if (end.status == static_cast<int>(ExitCode::bad_input) || end.status == EX_UNAVAILABLE)
      throw InputError(end.problem);
    if (end.status == static_cast<int>(ExitCode::stopped))
      throw Stopped(end.problem);
    if (end.status == static_cast<int>(ExitCode::numerical_failure))
      throw std::runtime_error(end.problem);
    if (end.status != 0)
      throw std::runtime_error(
        fmt::format("{} was ended{}", script, end.problem.empty() ? " by a signal" : ": " + end.problem));
  }

  void
  draw(const std::string &kind, const std::filesystem::path &folder, Log &log)
  {
    const PythonEnd end = call_python("plot/" + kind + ".py", {folder.string()}, /*shown=*/false);
    if (end.status == static_cast<int>(ExitCode::file_error))
      throw FileError(end.problem);
    if (end.status != 0)
      log.line(
        fmt::format("No picture was drawn: {}. Draw it later with: crawler plot {}", end.problem, folder.string()));
  }
} // namespace crawler
