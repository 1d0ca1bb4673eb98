// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/process.h>
#include <crawler/base/stop_place.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

namespace crawler
{
  namespace
  {
    const char *const variable_name = "CRAWLER_STOP_AT";
    /// In the order of StopPlace.
    constexpr std::string_view places[]                  = {"step", "pilot", "state", "row"};
    constexpr std::string_view write_prefix              = "write:";
    constexpr std::pair<std::string_view, int> signals[] = {
      {"KILL", SIGKILL}, {"TERM", SIGTERM}, {"INT", SIGINT}, {"USR1", SIGUSR1}, {"STOP", SIGSTOP}, {"SEGV", SIGSEGV}};

    std::optional<unsigned long>
    whole_number(const std::string &text)
    {
      unsigned long value    = 0;
      const char *const end  = text.data() + text.size();
      const auto [last, bad] = std::from_chars(text.data(), end, value);
      return bad == std::errc() && last == end && !text.empty() ? std::optional(value) : std::nullopt;
    }

    std::optional<int>
    signal_named(const std::string &text)
    {
      for (const auto &[name, number] : signals)
        if (name == text)
          return number;
      return std::nullopt;
    }

    /// The request of this process, if any, and the number of times its place has been reached.
    struct Armed
    {
      std::optional<StopWish> wish;
      unsigned long reached = 0;

      Armed()
      {
        const char *const text = std::getenv(variable_name);
        if (text == nullptr)
          return;
        wish = stop_wish(text);
        if (wish->rank >= 0 && static_cast<unsigned int>(wish->rank) != rank_of_launcher())
          wish.reset();
      }

      void
      reach(const unsigned long times)
      {
        const unsigned long before = reached;
        reached += times;
        if (before < wish->number && reached >= wish->number)
          std::raise(wish->signal);
      }
    };

    Armed &
    armed()
    {
      static Armed one;
      return one;
    }
  } // namespace

  StopWish
  stop_wish(const std::string &text)
  {
    std::vector<std::string> words;
    std::istringstream in(text);
    for (std::string word; std::getline(in, word, ':');)
      words.push_back(word);
    StopWish wish;
    const auto refuse = [&]() {
      return InputError(
        fmt::format("the environment variable {} is \"{}\"; PLACE[:NUMBER]:SIGNAL[:RANK] is expected, with "
                    "the place {} or write:NAME, and the signal KILL, TERM, INT, USR1, STOP or SEGV",
                    variable_name,
                    text,
                    fmt::join(places, ", ")));
    };
    if (words.size() > 1 && whole_number(words.back()))
    {
      wish.rank = static_cast<int>(*whole_number(words.back()));
      words.pop_back();
    }
    if (words.empty() || !signal_named(words.back()))
      throw refuse();
    wish.signal = *signal_named(words.back());
    words.pop_back();
    if (words.size() > 1 && whole_number(words.back()))
    {
      wish.number = *whole_number(words.back());
      words.pop_back();
    }
    wish.place         = fmt::format("{}", fmt::join(words, ":"));
    const bool is_file = wish.place.starts_with(write_prefix) && wish.place.size() > write_prefix.size();
    if (wish.number == 0 || (!is_file && std::ranges::find(places, wish.place) == std::end(places)))
      throw refuse();
    return wish;
  }

  void
  check_stop_place()
  {
    armed();
  }

  void
  reach(const StopPlace place, const unsigned long times)
  {
    if (armed().wish && armed().wish->place == places[static_cast<std::size_t>(place)])
      armed().reach(times);
  }

  void
  reach_write(const std::filesystem::path &path)
  {
    if (armed().wish && armed().wish->place.starts_with(write_prefix) &&
        armed().wish->place.substr(write_prefix.size()) == path.filename().string())
      armed().reach(1);
  }
} // namespace crawler
