// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/files.h>
#include <crawler/base/versions.h>
#include <crawler/run/result_table.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/report/folder_data.h>
#include <crawler/studies/report/page_files.h>
#include <crawler/studies/report/report.h>
#include <crawler/studies/sweep/sweep_points.h>
#include <crawler/studies/sweep/sweep_rows.h>

#include <fmt/format.h>

#include <algorithm>
#include <unistd.h>

namespace crawler
{
  namespace fs = std::filesystem;

  namespace
  {
    constexpr std::size_t most_rows_of_all = 640; ///< of all kymographs of a page together
    constexpr std::size_t fewest_rows      = 64;

    /// What a folder may be: a file or folder that only it has, and where its table is.
    struct Kind
    {
      std::string name, sign;
      std::string table = "", group = "";
    };

    const std::vector<Kind> &
    kinds()
    {
      static const std::vector<Kind> list = {{"atlas", "atlas.h5", "atlas.h5", "atlas"},
                                             {"tradeoff", "tradeoff.h5", "tradeoff.h5", "tradeoff"},
                                             {"tradeoff", "rows"},
                                             {"optimisation", "starts", "results.h5", "optimize"},
                                             {"sweep", sweep_file, sweep_file, sweep_group},
                                             {"run", "summary.json"},
                                             {"run", "statistics.csv"}};
      return list;
    }

    /// Throws InputError if the folder is none of a command.
    const Kind &
    kind_of(const fs::path &folder)
    {
      std::error_code error;
      if (!fs::is_directory(folder, error))
        throw InputError(
          fmt::format("\"{}\" is {}, but the output folder of a run, sweep, atlas, tradeoff or optimisation "
                      "is expected",
                      folder.string(),
                      fs::exists(folder, error) ? "a file" : "not there"));
      for (const Kind &kind : kinds())
        if (fs::exists(folder / kind.sign, error))
          return kind;
      throw InputError(fmt::format("\"{}\" has no results: none of summary.json, statistics.csv, results.h5, atlas.h5, "
                                   "tradeoff.h5 is there; the output folder of a run, sweep, atlas, tradeoff or "
                                   "optimisation is expected",
                                   folder.string()));
    }

    /// The folders of runs within a study: its optima, or the points whose fields were kept, by their numbers.
    std::vector<fs::path>
    runs_within(const fs::path &folder, const Kind &kind)
    {
      const bool has_points = kind.name == "sweep" || kind.name == "atlas";
      std::vector<std::pair<unsigned long, fs::path>> found;
      std::error_code error;
      for (const auto &one : fs::directory_iterator(has_points ? folder / "points" : folder, error))
      {
        const std::string name = one.path().filename().string(), prefix = has_points ? "" : "best";
        const std::string rest   = name.starts_with(prefix) ? name.substr(prefix.size()) : "?";
        const std::string digits = rest.starts_with("-") ? rest.substr(1) : rest;
        if (fs::exists(one.path() / "summary.json", error) && digits.size() < 9 &&
            (has_points ? !rest.empty() : true) &&
            std::ranges::all_of(digits, [](const char c) { return c >= '0' && c <= '9'; }))
          found.emplace_back(digits.empty() ? 0 : std::stoul(digits), one.path());
      }
      std::ranges::sort(found);
      std::vector<fs::path> list;
      for (auto &[number, path] : found)
        list.push_back(std::move(path));
      return list;
    }

    Json
    result_entries()
    {
      Json list = Json::array();
      for (const ResultEntry &entry : result_table())
        list.push_back({{"key", entry.key}, {"unit", entry.unit}, {"meaning", entry.meaning}});
      return list;
    }

    Json
    data_of(const fs::path &folder, const Kind &kind)
    {
      const fs::path absolute = fs::canonical(folder);
      Json data               = {{"kind", kind.name},
                                 {"folder", absolute.filename().string()},
                                 {"path", folder.string()},
                                 {"program", Json::object()},
                                 {"summary", summary_data(folder)},
                                 {"parameters", parameter_data(folder)},
                                 {"entries", result_entries()},
                                 {"units", unit_data(folder)},
                                 {"reasons", reasons_table},
                                 {"table", nullptr},
                                 {"runs", Json::array()},
                                 {"more_runs", Json::array()}};
      for (const auto &[name, version] : versions())
        data["program"][name] = version;
      std::error_code error;
      if (!kind.table.empty() && fs::exists(folder / kind.table, error))
        data["table"] = table_data(folder / kind.table, kind.group);
      if (kind.name == "run")
        data["runs"].push_back(run_data(folder, "", most_rows_of_all));
      else
      {
        const auto within      = runs_within(folder, kind);
        const std::size_t most = most_rows_of_all * 2 / fewest_rows;
        for (std::size_t i = 0; i < within.size(); ++i)
        {
          const std::string name = fs::relative(within[i], folder).string();
          if (i < most)
            data["runs"].push_back(
              run_data(within[i], name, std::max(fewest_rows, most_rows_of_all / std::min(within.size(), most))));
          else
            data["more_runs"].push_back(name);
        }
      }
      return data;
    }

    /// In a script of the page "<" could end it.
    std::string
    with_data(const Json &data)
    {
      const std::string mark  = "{{data}}";
      const std::string words = data.dump(-1, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace);
      std::string page;
      for (const std::string_view part : page_parts)
      {
        const auto place = part.find(mark);
        page += part.substr(0, place);
        if (place == part.npos)
          continue;
        for (const char c : words)
          if (c == '<')
            page += "\\u003c";
          else
            page += c;
        page += part.substr(place + mark.size());
      }
      return page;
    }
  } // namespace

  ExitCode
  report(MPI_Comm communicator, const CommandOptions &options)
  {
    on_first_rank(communicator, [&]() {
      const fs::path folder = options.file;
      const Kind &kind      = kind_of(folder);
      if (::access(folder.c_str(), W_OK) != 0)
        throw FileError("cannot write to the folder \"" + folder.string() + "\"");
      write_file(folder / report_name, with_data(data_of(folder, kind)));
      Log(/*is_first_rank=*/true, options.quiet)
        .line(fmt::format(
          "The report of this {} is {}; open it in a browser.", kind.name, (folder / report_name).string()));
      return "";
    });
    return ExitCode::finished;
  }
} // namespace crawler
