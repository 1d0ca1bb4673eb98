// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <map>
#include <poll.h>
#include <spawn.h>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace crawler::test
{
  /// Time limit of a program that hangs [s]; tests do not depend on it otherwise.
  constexpr int patience = 600;

  inline std::string
  read_text(const std::filesystem::path &path)
  {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream content;
    content << in.rdbuf();
    return content.str();
  }

  inline void
  write_text(const std::filesystem::path &path, const std::string &content)
  {
    std::ofstream(path, std::ios::binary) << content;
  }

  inline std::vector<std::string>
  lines_of(const std::string &text)
  {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
      lines.push_back(line);
    return lines;
  }

  /// Empty folder that is removed with this object.
  class TemporaryFolder
  {
  public:
    TemporaryFolder()
    {
      std::string name = (std::filesystem::temp_directory_path() / "crawler_test_XXXXXX").string();
      if (mkdtemp(name.data()) == nullptr)
        throw std::runtime_error("cannot make a temporary folder");
      path = name;
    }
    TemporaryFolder(const TemporaryFolder &) = delete;
    ~TemporaryFolder()
    {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }

    /// Content of every file by its name; that of every folder is "folder".
    std::map<std::string, std::string>
    content() const
    {
      std::map<std::string, std::string> result;
      for (const auto &entry : std::filesystem::recursive_directory_iterator(path))
        result[entry.path().lexically_relative(path).string()] =
          entry.is_directory() ? "folder" : read_text(entry.path());
      return result;
    }

    std::filesystem::path path;
  };

  /**
   * Process of the real program, started in a folder. The environment is its own: MPI_Init of the test leaves variables
   * from which the child would conclude that it belongs to the same job. The program stops at @p stop_at
   * (crawler/base/stop_place.h), if that is not empty.
   */
  class Program
  {
  public:
    Program(const std::filesystem::path &folder,
            const std::vector<std::string> &arguments,
            const std::string &input   = "",
            const std::string &stop_at = "")
    {
      write_text(streams_.path / "in", input);
      std::vector<std::string> words = {CRAWLER_PROGRAM};
      words.insert(words.end(), arguments.begin(), arguments.end());
      std::vector<std::string> environment = {
        "OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1", "OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1"};
      for (const char *name : {"PATH", "HOME", "TMPDIR", "LD_LIBRARY_PATH"})
        if (const char *value = std::getenv(name); value != nullptr)
          environment.push_back(std::string(name) + "=" + value);
      if (!stop_at.empty())
        environment.push_back("CRAWLER_STOP_AT=" + stop_at);

      posix_spawn_file_actions_t actions;
      posix_spawn_file_actions_init(&actions);
      posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
      const auto redirect = [&](const int descriptor, const char *name, const int flags) {
        posix_spawn_file_actions_addopen(&actions, descriptor, (streams_.path / name).c_str(), flags, 0600);
      };
      redirect(STDIN_FILENO, "in", O_RDONLY);
      redirect(STDOUT_FILENO, "out", O_WRONLY | O_CREAT);
      redirect(STDERR_FILENO, "err", O_WRONLY | O_CREAT);
      const int failed =
        posix_spawn(&id_, CRAWLER_PROGRAM, &actions, nullptr, pointers(words).data(), pointers(environment).data());
      posix_spawn_file_actions_destroy(&actions);
      if (failed != 0)
        throw std::runtime_error("cannot start " + words[0]);
    }
    Program(const Program &) = delete;
    ~Program()
    {
      if (!ended_)
      {
        kill(id_, SIGKILL);
        waitpid(id_, nullptr, 0);
      }
    }

    /// Waits for the end; returns the exit code, or minus the number of the signal that ended the program.
    int
    exit_code()
    {
      if (!ended_)
      {
        const int file = static_cast<int>(syscall(SYS_pidfd_open, id_, 0)); // readable when the program has ended
        if (file < 0)
          throw std::runtime_error("cannot wait for the program");
        pollfd end = {file, POLLIN, 0};
        int n      = -1;
        do
          n = poll(&end, 1, 1000 * patience);
        while (n < 0 && errno == EINTR);
        close(file);
        if (n != 1)
          throw std::runtime_error("the program does not come to an end");
        ended_ = waitpid(id_, &status_, 0) == id_;
      }
      return WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
    }

    std::string
    out() const
    {
      return read_text(streams_.path / "out");
    }
    std::string
    err() const
    {
      return read_text(streams_.path / "err");
    }

  private:
    static std::vector<char *>
    pointers(std::vector<std::string> &words)
    {
      std::vector<char *> result;
      for (std::string &word : words)
        result.push_back(word.data());
      result.push_back(nullptr);
      return result;
    }

    TemporaryFolder streams_;
    pid_t id_   = 0;
    int status_ = 0;
    bool ended_ = false;
  };

  struct ProgramResult
  {
    int exit_code;
    std::string out, err;
  };

  inline ProgramResult
  run_program(const std::filesystem::path &folder,
              const std::vector<std::string> &arguments,
              const std::string &input   = "",
              const std::string &stop_at = "")
  {
    Program program(folder, arguments, input, stop_at);
    const int exit_code = program.exit_code();
    return {exit_code, program.out(), program.err()};
  }

  /// The words @p before, and those that set these entries on a command line.
  inline std::vector<std::string>
  sets(const std::vector<std::string> &entries, std::vector<std::string> before = {})
  {
    for (const std::string &entry : entries)
      before.insert(before.end(), {"--set", entry});
    return before;
  }
} // namespace crawler::test
