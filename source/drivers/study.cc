// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/process.h>
#include <crawler/base/versions.h>
#include <crawler/drivers/study.h>

#include <fmt/format.h>

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

  void
  draw(const std::string &script, const std::filesystem::path &folder, Log &log)
  {
    // Beside an installed program, else in the folder of the source code.
    std::error_code ignored;
    const auto program   = std::filesystem::read_symlink("/proc/self/exe", ignored);
    const auto installed = program.parent_path().parent_path() / CRAWLER_INSTALLED_PLOTS / script;
    const std::string path =
      std::filesystem::exists(installed, ignored) ? installed.string() : CRAWLER_SOURCE_DIR "/contrib/plot/" + script;
    const std::string debians = "/usr/bin/python3";
    for (const std::string &python : {debians, std::string("python3")})
      if (run_silently({python, path, folder.string()}))
        return;
    log.line(fmt::format("There is no picture (it needs Python with numpy and matplotlib); draw it with: "
                         "python3 {} {}",
                         path,
                         folder.string()));
  }
} // namespace crawler
