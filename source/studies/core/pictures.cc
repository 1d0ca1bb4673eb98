// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/process.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/pictures.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sysexits.h>

namespace crawler
{
  namespace
  {
    /// Where a script of contrib/plot is looked for: where it is installed with the program, and in the build folder,
    /// which has a link to contrib/plot.
    std::array<std::filesystem::path, 2>
    places_of_script(const std::string &name)
    {
      std::error_code ignored;
      const auto folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
      return {{folder.parent_path() / CRAWLER_INSTALLED_PLOTS / name, folder / "plot" / name}};
    }
  } // namespace

  PictureEnd
  call_plot_script(const std::string &name, const std::vector<std::string> &arguments, const bool shown)
  {
    const auto places = places_of_script(name);
    std::error_code ignored;
    const auto script =
      std::ranges::find_if(places, [&](const auto &place) { return std::filesystem::exists(place, ignored); });
    if (script == places.end())
      return {
        EX_UNAVAILABLE,
        fmt::format("the script {} is neither {} nor {}; a copy of the program alone draws nothing, the installed "
                    "one and that of the build folder do",
                    name,
                    places[0].lexically_normal().string(),
                    places[1].string())};
    // If this Python lacks a module, the script itself goes on with Debian's (contrib/plot/plotting.py).
    for (const std::string python : {"python3", "/usr/bin/python3"})
    {
      std::vector<std::string> command = {python, script->string()};
      command.insert(command.end(), arguments.begin(), arguments.end());
      if (const ProgramEnd end = run_program(command, shown); end.started)
        return {end.status, trimmed(end.errors)};
    }
    return {EX_UNAVAILABLE, "python3 is not there (Debian: apt install python3-h5py python3-matplotlib)"};
  }

  void
  draw(const std::string &script, const std::filesystem::path &folder, Log &log)
  {
    const PictureEnd end = call_plot_script(script, {folder.string()}, /*shown=*/false);
    if (end.status == static_cast<int>(ExitCode::file_error))
      throw FileError(end.problem);
    if (end.status != 0)
      log.line(
        fmt::format("There is no picture: {}. Draw it later with: crawler plot {}", end.problem, folder.string()));
  }
} // namespace crawler
