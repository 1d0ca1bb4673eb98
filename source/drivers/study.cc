// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/process.h>
#include <crawler/base/versions.h>
#include <crawler/drivers/parameters.h>
#include <crawler/drivers/study.h>
#include <crawler/parameters/declarations.h>
#include <crawler/parameters/parameter_file.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace crawler
{
  double
  now()
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  StudyProgress::StudyProgress(Log &log, const unsigned long n_parts, std::string parts)
    : log_(log)
    , n_parts_(n_parts)
    , parts_(std::move(parts))
  {
  }

  void
  StudyProgress::report(const unsigned long done, const std::string &remark)
  {
    constexpr double pause = 5.; // seconds
    if (now() < last_ + pause)
      return;
    last_             = now();
    const double rate = done / (last_ - start_);
    log_.line(fmt::format("  {:3.0f} %  {} of {} {}, {:.3g} {}/s, {:.0f} s left{}",
                          100. * done / n_parts_,
                          done,
                          n_parts_,
                          parts_,
                          rate,
                          parts_,
                          (n_parts_ - done) / rate,
                          remark));
  }

  unsigned long
  golden_stride(const unsigned long n)
  {
    auto stride = static_cast<unsigned long>(std::ceil(0.618034 * n));
    while (std::gcd(stride, n) != 1)
      ++stride;
    return stride;
  }

  std::map<std::string, std::string>
  provenance(const std::string &effective, const std::string &command_line)
  {
    std::map<std::string, std::string> attributes = {{"parameters.prm", effective}, {"command line", command_line}};
    for (const auto &[name, version] : versions())
      attributes["version of " + name] = version;
    return attributes;
  }

  std::vector<std::string>
  differences(const std::string &before, const std::string &after, const std::vector<std::string> &others)
  {
    const auto values = [](const std::string &text)
    {
      Parameters parameters;
      Declarations declarations;
      parameters.add_parameters(declarations);
      ParameterFile::from_text(text, "parameters.prm").apply(declarations);
      std::vector<std::pair<std::string, std::string>> list;
      for (unsigned int i = 0; i < declarations.entries().size(); ++i)
        list.emplace_back(declarations.entries()[i].path, declarations.value(i));
      return list;
    };
    const auto old_values = values(before), new_values = values(after);
    std::vector<std::string> list;
    for (std::size_t i = 0; i < old_values.size(); ++i)
      if (old_values[i].second != new_values[i].second &&
          std::find(others.begin(), others.end(), old_values[i].first) == others.end())
        list.push_back(
          fmt::format("{} was \"{}\" and is \"{}\"", old_values[i].first, old_values[i].second, new_values[i].second));
    return list;
  }

  void
  draw(const std::string &script, const std::filesystem::path &folder, Log &log)
  {
    const std::string path    = CRAWLER_SOURCE_DIR "/contrib/plot/" + script;
    const std::string debians = "/usr/bin/python3";
    for (const std::string &python : {debians, std::string("python3")})
      if (run_silently({python, path, folder.string()}))
        return;
    log.line(fmt::format("There is no picture (it needs Python with numpy and matplotlib); draw it with: "
                         "python3 contrib/plot/{} {}",
                         script,
                         folder.string()));
  }
} // namespace crawler
