// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/studies/core/crash_file.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <iterator>
#include <sstream>
#include <unistd.h>

namespace crawler
{

  namespace
  {
    constexpr int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

    /// Data of the signal handler, which must not allocate memory.
    struct Prepared
    {
      std::array<char, 4096> path{};
      std::array<char, 4096> line{};
      std::array<char, 65536> stack{}; ///< alternative stack: the overflow of the normal one may be the fault
      volatile std::size_t size = 0;   ///< size of the line
      stack_t stack_before{};
      struct sigaction before[std::size(faults)] = {};
    } prepared;

    /// Signal handler: calls only async-signal-safe functions (signal-safety(7)).
    void
    write_line(const int signal)
    {
      if (prepared.size > 0)
        if (const int file = open(prepared.path.data(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644); file >= 0)
        {
          [[maybe_unused]] const auto written = write(file, prepared.line.data(), prepared.size);
          close(file);
        }
      raise(signal); // default action again, delivered when this handler returns
    }
  } // namespace

  CrashNote::CrashNote(const std::filesystem::path &folder)
  {
    if (std::filesystem::exists(folder / crash_file))
    {
      std::istringstream text(read_whole_file(folder / crash_file));
      for (std::string point; text >> point;)
        crashes_.insert(point);
    }
    const std::string path = std::filesystem::absolute(folder / crash_file).string();
    prepared.size          = 0;
    if (path.size() >= prepared.path.size())
      throw FileError(fmt::format("the name of the folder \"{}\" is too long", folder.string()));
    std::strcpy(prepared.path.data(), path.c_str());
    const stack_t stack = {.ss_sp = prepared.stack.data(), .ss_flags = 0, .ss_size = prepared.stack.size()};
    sigaltstack(&stack, &prepared.stack_before);
    struct sigaction action = {};
    action.sa_handler       = write_line;
    action.sa_flags         = static_cast<int>(SA_ONSTACK | SA_RESETHAND);
    for (std::size_t i = 0; i < std::size(faults); ++i)
      sigaction(faults[i], &action, &prepared.before[i]);
  }

  CrashNote::~CrashNote()
  {
    prepared.size = 0;
    for (std::size_t i = 0; i < std::size(faults); ++i)
      sigaction(faults[i], &prepared.before[i], nullptr);
    sigaltstack(&prepared.stack_before, nullptr);
  }

  void
  CrashNote::at_work_on(const std::string &points)
  {
    prepared.size = 0;
    if (points.empty() || points.size() >= prepared.line.size())
      return;
    *std::ranges::copy(points, prepared.line.begin()).out = '\n';
    prepared.size                                         = points.size() + 1;
  }
} // namespace crawler
