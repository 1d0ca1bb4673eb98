// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/process.h>

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>

namespace crawler
{
  namespace
  {
    /// Reads a pipe until its other end is closed.
    std::string
    all_of(const int pipe)
    {
      std::string text;
      std::array<char, 4096> part;
      while (true)
      {
        const ssize_t n = read(pipe, part.data(), part.size());
        if (n > 0)
          text.append(part.data(), n);
        else if (n == 0 || errno != EINTR)
          return text;
      }
    }

    /// The child, 0 before it exists, and the last signal for it. Any thread may get a signal: it notes the signal and
    /// then looks for the child; the thread that starts the child does both in the other order, so no signal is lost.
    std::atomic<pid_t> child  = 0;
    std::atomic<int> awaiting = 0;

    void
    pass_on(const int number, siginfo_t *const info, void *)
    {
      const int error       = errno;
      const bool is_process = info->si_code <= 0; // a terminal sends its signals to the child, too
      if (is_process)
      {
        awaiting = number;
        if (const pid_t id = child; id > 0)
          kill(id, number);
      }
      errno = error;
    }

    /// Forwards signals that stop the program to its child during its lifetime; ignored ones stay ignored. Signals wait
    /// until there is a child.
    class SignalsForChild
    {
    public:
      SignalsForChild()
      {
        child    = 0;
        awaiting = 0;
        sigemptyset(&ours_);
        for (const int number : numbers)
          sigaddset(&ours_, number);
        sigprocmask(SIG_BLOCK, &ours_, &mask_);
        struct sigaction action = {};
        action.sa_sigaction     = pass_on;
        action.sa_flags         = SA_SIGINFO | SA_RESTART;
        for (std::size_t i = 0; i < numbers.size(); ++i)
        {
          sigaction(numbers[i], nullptr, &before_[i]);
          if (before_[i].sa_handler != SIG_IGN)
            sigaction(numbers[i], &action, nullptr);
        }
      }

      ~SignalsForChild()
      {
        for (std::size_t i = 0; i < numbers.size(); ++i)
          sigaction(numbers[i], &before_[i], nullptr);
        sigprocmask(SIG_SETMASK, &mask_, nullptr);
      }

      SignalsForChild(const SignalsForChild &) = delete;

      /// Starts the child with the previous signal handling, but the signals blocked. Returns whether it has started.
      bool
      start(pid_t &id, std::vector<char *> &words, const posix_spawn_file_actions_t &actions)
      {
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        posix_spawnattr_setsigmask(&attributes, &ours_);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
        const bool started = posix_spawnp(&id, words[0], &actions, &attributes, words.data(), environ) == 0;
        posix_spawnattr_destroy(&attributes);
        if (started)
        {
          child = id;
          if (const int number = waiting())
            kill(id, number);
          sigprocmask(SIG_SETMASK, &mask_, nullptr);
        }
        return started;
      }

      /// Returns whether this signal is one of those that are forwarded.
      static bool
      has(const int number)
      {
        return std::ranges::find(numbers, number) != numbers.end();
      }

    private:
      /// Signal that has come before there was a child, also from a terminal; 0 without one.
      int
      waiting() const
      {
        sigset_t pending;
        sigpending(&pending);
        for (std::size_t i = 0; i < numbers.size(); ++i)
          if (sigismember(&pending, numbers[i]) == 1 && before_[i].sa_handler != SIG_IGN)
            return numbers[i];
        return awaiting;
      }

      static constexpr std::array<int, 3> numbers = {{SIGINT, SIGTERM, SIGUSR1}};
      std::array<struct sigaction, numbers.size()> before_;
      sigset_t ours_, mask_;
    };
  } // namespace

  unsigned int
  rank_of_launcher()
  {
    for (const char *const name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"})
      if (const char *const rank = std::getenv(name); rank != nullptr)
        return static_cast<unsigned int>(std::strtoul(rank, nullptr, 10));
    return 0;
  }

  ProgramEnd
  run_program(const std::vector<std::string> &command, const bool shown)
  {
    std::vector<std::string> words = command;
    std::vector<char *> pointers;
    for (std::string &word : words)
      pointers.push_back(word.data());
    pointers.push_back(nullptr);

    ProgramEnd end;
    std::array<int, 2> pipe_of_errors;
    if (pipe2(pipe_of_errors.data(), O_CLOEXEC) != 0)
      return end;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    if (!shown)
      posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, pipe_of_errors[1], STDERR_FILENO);
    pid_t id = 0;
    SignalsForChild signals;
    end.started = signals.start(id, pointers, actions);
    posix_spawn_file_actions_destroy(&actions);
    close(pipe_of_errors[1]);
    end.errors = all_of(pipe_of_errors[0]);
    close(pipe_of_errors[0]);
    if (!end.started)
      return end;
    int status = 0;
    while (waitpid(id, &status, 0) < 0)
      if (errno != EINTR)
        return end;
    if (WIFEXITED(status))
      end.status = WEXITSTATUS(status);
    end.stopped = WIFSIGNALED(status) && SignalsForChild::has(WTERMSIG(status));
    return end;
  }

  bool
  comes_to_an_end(const std::function<void()> &work, const unsigned int seconds)
  {
    const pid_t id = fork();
    if (id < 0)
      return true; // no copy is available, so the original must try
    if (id == 0)
    {
      for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU})
        std::signal(number, SIG_DFL);
      const rlimit time = {seconds, seconds}, no_core = {0, 0};
      setrlimit(RLIMIT_CPU, &time);
      setrlimit(RLIMIT_CORE, &no_core);
      const int nowhere = open("/dev/null", O_WRONLY);
      dup2(nowhere, STDOUT_FILENO);
      dup2(nowhere, STDERR_FILENO);
      try
      {
        work();
      }
      catch (...)
      {
      }
      _exit(0);
    }
    int status = 0;
    while (waitpid(id, &status, 0) < 0)
      if (errno != EINTR)
        return false;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }
} // namespace crawler
