// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/plot.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/studies/core/python.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace crawler
{
  namespace
  {
    namespace fs = std::filesystem;

    /// Kind of picture, and the files by any of which an output folder is recognised.
    struct Kind
    {
      const char *name, *of;
      std::vector<std::string> files;
    };

    /// Kinds in order: the first that fits is drawn; those without files only if their name is given.
    const std::vector<Kind> &
    kinds()
    {
      static const std::vector<Kind> list = {
        {"tradeoff", "a tradeoff", {"tradeoff.csv", "tradeoff.h5"}},
        {"optimize", "an optimisation", {"starts.csv", "starts.h5"}},
        {"fit", "a fit", {"residuals.csv", "inputs.json", "comparison.csv"}},
        {"sweep", "a sweep", {"results.h5"}},
        {"calibration", "a calibration", {"calibration.csv"}},
        {"table", "a table of crawler table", {}},
        {"kymograph", "a run", {"kymograph.vts", "statistics.csv", "solution.pvd", "summary.json"}},
        {"sensitivity", "a run with Output/Sensitivities", {}},
        {"scaling", "the sweep of prm/studies/scaling.prm", {}}};
      return list;
    }

    std::string
    kind_of(const fs::path &path)
    {
      std::error_code ignored;
      if (path.extension() == ".csv" && fs::is_regular_file(path, ignored))
      {
        std::string first;
        std::getline(std::ifstream(path) >> std::ws, first);
        if (first.starts_with("s,t,"))
          return "table";
        if (first.find("reported_error") != std::string::npos)
          return "calibration";
        throw InputError(
          fmt::format("\"{}\" has {} columns, but s, t and m (or strain) are expected, as \"crawler table\" "
                      "writes them, or those of a calibration",
                      path.string(),
                      std::count(first.begin(), first.end(), ',') + 1));
      }
      if (!fs::is_directory(path, ignored))
        throw InputError(fmt::format("\"{}\" is not a folder; the output folder of a run or study is expected (or the "
                                     "table of a calibration or of crawler table)",
                                     path.string()));
      std::vector<std::string> names;
      for (const Kind &kind : kinds())
      {
        if (std::any_of(kind.files.begin(), kind.files.end(), [&](const std::string &file) {
              return fs::exists(path / file, ignored);
            }))
          return kind.name;
        if (!kind.files.empty())
          names.push_back(fmt::format("{} ({})", kind.of, kind.files.front()));
      }
      throw InputError(fmt::format("\"{}\" has nothing to draw; the output folder of one of these is expected: {}",
                                   path.string(),
                                   fmt::join(names, ", ")));
    }
  } // namespace

  std::vector<std::string>
  plot_kinds()
  {
    std::vector<std::string> names;
    for (const Kind &kind : kinds())
      names.emplace_back(kind.name);
    return names;
  }

  void
  plot(const std::string &path, const std::string &kind, const std::vector<std::string> &options)
  {
    const std::vector<std::string> known = plot_kinds();
    if (path.empty())
      throw InputError("the folder is missing; \"crawler plot DIR\" is expected");
    if (!kind.empty() && std::find(known.begin(), known.end(), kind) == known.end())
      throw InputError(fmt::format("\"--kind\" is \"{}\", but {} is expected", kind, quoted_list(known)));
    const std::string chosen           = kind.empty() ? kind_of(path) : kind;
    std::vector<std::string> arguments = {path};
    arguments.insert(arguments.end(), options.begin(), options.end());
    hand_over_to_python("plot/" + chosen + ".py", arguments);
    std::error_code ignored;
    if (kind.empty() && fs::exists(fs::path(path) / "sensitivity_body.csv", ignored))
      std::cout << fmt::format("Also available: crawler plot {} --kind sensitivity", path) << std::endl;
  }
} // namespace crawler
