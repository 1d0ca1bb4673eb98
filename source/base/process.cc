// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/process.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

namespace crawler
{
  bool
  run_silently(const std::vector<std::string> &command)
  {
    std::vector<std::string> words = command;
    std::vector<char *> pointers;
    for (std::string &word : words)
      pointers.push_back(word.data());
    pointers.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
    pid_t id         = 0;
    const int failed = posix_spawnp(&id, pointers[0], &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0)
      return false;
    int status = 0;
    while (waitpid(id, &status, 0) < 0)
      if (errno != EINTR)
        return false;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
} // namespace crawler
