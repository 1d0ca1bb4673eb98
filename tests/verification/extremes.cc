// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The extremes: every row of contrib/reference/extremes.json (made by an independent solver) with the automatic choice
// of form and mesh. A run must end as the body does, with an error of the displacement that is not above the reported
// one. Prints a table; the exit code is 1 if a row fails.
//
//     extremes contrib/reference/extremes.json [accuracy]
#include "../support/run_text.h"

#include <crawler/base/mpi_session.h>

#include <nlohmann/json.hpp>

#include <fstream>

namespace
{
  using namespace crawler;

  std::string
  words(const nlohmann::json &numbers)
  {
    std::string text;
    for (const double number : numbers)
      text += (text.empty() ? "" : ", ") + test::text(number);
    return text.empty() ? "0" : text;
  }

  /// The time by which inversions may differ, relative to the duration.
  constexpr double time_tolerance = 1e-3;
} // namespace

int
main(int argc, char **argv)
{
  int one = 1;
  const crawler::MpiSession guard(one, argv);
  if (argc < 2)
    return 2;
  std::ifstream file(argv[1]);
  if (!file)
  {
    fmt::print(stderr, "extremes: cannot read {}\n", argv[1]);
    return 2;
  }
  const auto rows       = nlohmann::json::parse(file)["rows"];
  const double accuracy = argc > 2 ? std::stod(argv[2]) : 1e-3;
  int failures = 0, done = 0;
  for (const auto &row : rows)
  {
    const auto outcome = test::run_with(
      test::with(test::wave(row["exponent"], row["chi"], row["speed"], row["end_time"], row["elastic_modulus"]),
                 "Accuracy = {}; optimal wave; Sine coefficients = {}; Cosine coefficients = {}",
                 accuracy,
                 words(row["sine"]),
                 words(row["cosine"])));
    const auto &result = outcome.result;
    ++done;
    std::string verdict;
    bool ok = false;
    if (row.contains("inversion") && !row["inversion"].is_null())
    {
      const double t = row["inversion"]["t"];
      ok      = result.inversion && std::abs(result.inversion->t - t) <= time_tolerance * row["end_time"].get<double>();
      verdict = fmt::format("t = {:.8g}, expected {:.8g}", result.inversion ? result.inversion->t : 0., t);
    }
    else
    {
      const double reference = row["displacement"], error = std::abs(result.displacement - reference);
      ok = result.time.status == Status::finished && error <= outcome.choice.wanted_error + row["error"].get<double>();
      verdict = fmt::format("{:.10g}, expected {:.10g}: error {:.1e}, reported {:.1e}",
                            result.displacement,
                            reference,
                            error,
                            outcome.choice.wanted_error);
    }
    failures += !ok;
    fmt::print("{:<36} {:<9} {:<16} {} ({} cells, {} steps, {:.2f} s){}\n",
               row["name"].get<std::string>(),
               word_of(result.time.status),
               result.time.reason,
               verdict,
               result.mesh.most_cells,
               result.time.steps,
               result.seconds.solve,
               ok ? "" : "  <- FAILS");
  }
  fmt::print("{} rows, {} failed\n", done, failures);
  return failures == 0 && done > 0 ? 0 : 1;
}
