// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Which scene has which fast paths and numbers? Every cell of the table "What each scene has" in the developer guide is
// a run here; the guide must have the lines that come out.
#include "../support/lane_runs.h"
#include "../support/test.h"

#include <crawler/accuracy/run_to_accuracy.h>
#include <crawler/run/cycle_stop.h>

using namespace crawler;
using test::Settings;

namespace
{
  struct Row
  {
    std::string name;
    Settings settings;
    std::string reason = ""; ///< of what is missing
  };

  const Settings wave = test::with(test::wave(-1., 0.3, 1., 20.), {{"Accuracy", "1e-3"}});

  Settings
  wave_with_feedback(const std::string &more)
  {
    return test::set("T = 4; strain feedback; Active stress = 0.2*sin(2*pi*(s+t))*s*(1-s)*4{}", more);
  }

  const std::vector<Row> rows = {
    {"plain", {}},
    {"a = 0", {{"Body/Anchoring exponent", "1"}}, "no displacement"},
    {"k(s)", {{"Body/Elastic modulus profile", "1+0.3*s"}}},
    {"gamma(s)", {{"Body/Friction profile", "1.2-0.3*s"}}, "the efficiency has no bound there"},
    {"friction law", {{"Ground/Friction law", "expression"}, {"Ground/Expression", "0.3+0.7/w^1.5"}}},
    {"direction",
     {{"Ground/Backward ratio", "3"}, {"Ground/Switching velocity", "0.2"}},
     "the efficiency has no bound there"},
    {"gamma(x)", {{"Ground/Profile", "1+0.1*tanh(x)"}}, "strides depend on the place"},
    {"initial stretch", {{"Body/Initial stretch", "1+0.1*sin(pi*s)^2"}}, "batches start from rest"},
    {"feedback by w, w_t", wave_with_feedback("-0.1*(w-1)+0.05*w_t"), "no period is declared"},
    {"feedback by w_near",
     wave_with_feedback("+0.1*(w_near-1); Distance = 0.2"),
     "cells that are no neighbours are coupled"},
    {"feedback by w_delayed", wave_with_feedback("+0.1*(w_delayed-1); Delay = 0.2"), "the past is a part of the state"},
    {"stretch form",
     {{"Discretization/Formulation", "stretch"}, {"Accuracy", "1e-2"}},
     "batches are in the position form"},
    {"adaptive mesh", {{"Discretization/Mesh", "adaptive"}, {"Time/End time", "4"}}, "the lanes have one mesh"},
    {"jumps in s and t", test::set("segments; Number of segments = 3; Phase lag = 0.3; Amplitude = 0.1")},
    {"jumps that move",
     test::set("Accuracy = 0.1; T = 4; travelling wave; Profile = square"),
     "an answer is made of several runs"},
    {"bdf", {{"Time/Integrator", "bdf"}, {"Time/End time", "4"}}, "the lanes have radau 5 and 9"},
  };

  /// The line of a row.
  std::string
  line(const Row &row)
  {
    const Parameters parameters = test::parameters_with(test::with(wave, row.settings));
    const Scene scene           = parameters.create_scene();
    RecordOptions options       = {
            .energy_balance = true, .cycles = cycle_wish(parameters, scene, /*has_pictures=*/false), .gait = GaitWish::any};
    const Answer answer            = answer_in_memory({parameters, scene}, options);
    const SimulationResult &result = answer.result;
    EXPECT_EQ(result.time.status, Status::finished) << row.name << ": " << result.time.message;
    bool in_batches = false;
    if (!answer.choice.has_fronts && batch_method(scene, parameters.time, answer.choice.numerics))
    {
      const BatchRun run = {&scene, &parameters.time, &answer.choice.numerics};
      in_batches         = run_batch({&run, 1}, options).front().has_value();
    }
    std::string text = "| " + row.name + " |";
    for (const bool has : {result.process.engine == "fused",
                           in_batches,
                           result.error && std::isfinite(result.error->total),
                           result.cycles.has_value(),
                           result.gait.has_value(),
                           result.gait_efficiency.has_value()})
      text += has ? " yes |" : "  |";
    return text + " " + row.reason + " |";
  }
} // namespace

TEST(Capabilities, AreThoseOfTheGuide)
{
  std::set<std::string> guide;
  std::ifstream file(CRAWLER_SOURCE_DIR "/doc/developer_guide.md");
  ASSERT_TRUE(file);
  for (std::string text; std::getline(file, text);)
    guide.insert(text);
  for (const Row &row : rows)
  {
    const std::string text = line(row);
    fmt::print("{}\n", text);
    EXPECT_TRUE(guide.contains(text)) << text;
  }
}
