// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/terminal.h>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

namespace crawler
{
  namespace
  {
    std::string_view
    variable(const char *name)
    {
      const char *const value = std::getenv(name);
      return value == nullptr ? "" : value;
    }

    constexpr unsigned int usual = 80;

    /// Width of a terminal; 0 if this is none, or its width is unknown.
    unsigned int
    columns_of(const int descriptor)
    {
      winsize size{};
      return ioctl(descriptor, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
    }

    /// Width of the terminal of the parent process, mpirun, which gives its processes terminals without a size,
    /// wherever the output goes; 0 if the parent's output is no terminal.
    unsigned int
    columns_of_parent()
    {
      const std::string stream = "/proc/" + std::to_string(getppid()) + "/fd/1";
      std::error_code ignored;
      if (!std::filesystem::read_symlink(stream, ignored).string().starts_with("/dev/"))
        return 0;
      const int descriptor = open(stream.c_str(), O_RDONLY | O_NOCTTY | O_NONBLOCK);
      if (descriptor < 0)
        return 0;
      const bool is_terminal     = isatty(descriptor) != 0;
      const unsigned int columns = columns_of(descriptor);
      close(descriptor);
      return !is_terminal ? 0 : columns > 0 ? columns : usual;
    }
  } // namespace

  unsigned int
  terminal_width()
  {
    if (isatty(STDOUT_FILENO) == 0 || variable("TERM").empty() || variable("TERM") == "dumb")
      return 0;
    const unsigned int columns = columns_of(STDOUT_FILENO);
    return columns > 0 ? columns : columns_of_parent();
  }

  bool
  terminal_has_utf8()
  {
    for (const char *const name : {"LC_ALL", "LC_CTYPE", "LANG"})
      if (const std::string_view value = variable(name); !value.empty())
        return value.find("UTF-8") != std::string_view::npos || value.find("utf8") != std::string_view::npos;
    return false;
  }
} // namespace crawler
