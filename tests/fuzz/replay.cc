// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Gives a target the inputs that are kept in a folder, and some changed copies of each, without a fuzzer:
//     fuzz_formulas FOLDER COPIES
// What is tried stands in last_input of the present folder, so a failure leaves it there.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <unistd.h>
#include <vector>

#include "fuzz.h"

namespace
{
  using Input = std::vector<std::uint8_t>;

  constexpr unsigned int longest = 10; // seconds

  void
  run(const Input &input, const std::string &name)
  {
    const std::string file = name + ".last_input";
    std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char *>(input.data()), static_cast<std::streamsize>(input.size()));
    alarm(longest);
    LLVMFuzzerTestOneInput(input.data(), input.size());
    alarm(0);
  }

  /// Changed in some places, as often to values at the ends of what is possible.
  Input
  changed(Input input, std::mt19937 &random)
  {
    constexpr std::uint8_t values[] = {0, 1, 0x7f, 0x80, 0xff, '\n', '"', '/', '-', '0', '9', '(', ')', ',', '='};
    for (auto n = 1 + random() % 4; n > 0 && !input.empty(); --n)
    {
      const auto place = static_cast<std::ptrdiff_t>(random() % input.size());
      switch (random() % 4)
      {
        case 0:
          input[static_cast<std::size_t>(place)] = static_cast<std::uint8_t>(random());
          break;
        case 1:
          input[static_cast<std::size_t>(place)] = values[random() % std::size(values)];
          break;
        case 2:
          input.insert(input.begin() + place, values[random() % std::size(values)]);
          break;
        default:
          input.erase(input.begin() + place,
                      input.begin() + std::min<std::ptrdiff_t>(place + static_cast<std::ptrdiff_t>(random() % 16),
                                                               static_cast<std::ptrdiff_t>(input.size())));
      }
    }
    return input;
  }
} // namespace

int
main(int argc, char **argv)
{
  if (argc != 3)
  {
    std::fprintf(stderr, "%s FOLDER COPIES is expected\n", argv[0]);
    return 2;
  }
  std::signal(SIGALRM, [](int) {
    constexpr char text[]               = "no answer after 10 s\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text, sizeof(text) - 1);
    std::abort();
  });
  const std::string name = std::filesystem::path(argv[0]).filename().string();
  std::vector<std::filesystem::path> files;
  for (const auto &file : std::filesystem::directory_iterator(argv[1]))
    files.push_back(file.path());
  std::sort(files.begin(), files.end());
  std::mt19937 random(1);
  const unsigned long n_copies = std::stoul(argv[2]);
  unsigned long n_inputs       = 0;
  for (const auto &file : files)
  {
    std::ifstream in(file, std::ios::binary);
    const Input input((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    run(input, name);
    for (unsigned long i = 0; i < n_copies; ++i)
      run(changed(input, random), name);
    n_inputs += 1 + n_copies;
  }
  std::filesystem::remove(name + ".last_input");
  std::printf("%lu inputs\n", n_inputs);
  return n_inputs > 0 ? 0 : 1;
}
