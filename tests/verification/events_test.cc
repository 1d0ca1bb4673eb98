// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Events that samples miss, long runs, and gaits of hundreds of strides: their answers were once wrong, with bounds
// that said otherwise.
#include "../support/answers.h"
#include "../support/expect_within.h"
#include "../support/test.h"

using namespace crawler;
using test::answer_to;
using test::expect_within;
using test::never;

namespace
{
  test::Settings
  pulse(const double speed, const double repetition, const double end_time, const std::string &accuracy)
  {
    return test::set(
      "p = 2; T = {}; Accuracy = {}; pulse; Amplitude = 0.4; Width = 0.1; Speed = {}; Repetition period = {}",
      end_time,
      accuracy,
      speed,
      repetition);
  }

  test::Settings
  event(const double time, const double width, const std::string &accuracy)
  {
    return test::set("Accuracy = {}; expression; Constants = q={}, w={}; "
                     "Active stress = 0.1*sin(2*pi*(s+t))*tanh(5*t)+0.6*sin(pi*s)*sin(2*pi*s)*exp(-((t-q)/w)^2)",
                     accuracy,
                     time,
                     width);
  }

  /// With steps that no event can escape.
  double
  with_short_steps(const test::Settings &settings, const double step)
  {
    const Parameters parameters = test::parameters_with(settings);
    const Scene scene           = parameters.create_scene();
    const Numerics numerics     = {
          .degree = 8, .n_cells = 12, .tolerance = 1e-10, .initial_step = 1e-4 * step, .step_limits = {{0., step}}};
    TimeParameters time = parameters.time;
    time.integrator     = "radau 9";
    return Simulation(MPI_COMM_WORLD, scene, time, numerics).run({}, {}).displacement;
  }
} // namespace

/// Segments that a formula describes have the answer of the generator that declares their jumps.
TEST(Events, JumpsOfFormulasAreAsGoodAsDeclaredOnes)
{
  const test::Settings rest = test::set("p = 2; Time/End time = 1; Accuracy = 1e-6");
  const auto generator      = answer_to(test::with(
    rest, "segments; Number of segments = 4; Amplitude = 0.2; Phase lag = 0.25; Direction = from tail to head"));
  const auto formula = answer_to(test::with(rest, "expression; Active stress = 0.2*(mod(t-0.25*floor(4*s),1)<0.5)"));
  ASSERT_EQ(formula.time.status, Status::finished);
  EXPECT_EQ(formula.process.mesh.n_cells, generator.process.mesh.n_cells);
  EXPECT_NEAR(formula.displacement, generator.displacement, 1e-12);
}

TEST(Events, ASinglePulseIsNotMissed)
{
  expect_within(answer_to(pulse(20., 0., 1000., "1e-4")), -0.00316044717, 1e-4, "pulse");
}

TEST(Events, PulsesAreCounted)
{
  const double one = answer_to(pulse(20., 0., 1000., "1e-7")).displacement;
  for (const char *stop : {"automatic", "off"})
    expect_within(
      answer_to(test::with(pulse(20., 50., 1000., "1e-4"), "Time/Cycle stop = {}", stop)), 20. * one, 1e-4, stop);
}

TEST(Events, EventsOfFormulasAreNotMissed)
{
  for (const double width : {1e-4, 2e-4, 3e-4})
    for (const double time : {0.2222, 0.51371, 0.9})
    {
      const auto settings = event(time, width, "1e-4");
      expect_within(answer_to(settings), with_short_steps(settings, width), 1e-4, fmt::format("{} at {}", width, time));
    }
}

TEST(Events, EachPointOfASweepHasItsEvents)
{
  std::vector<Task> tasks(12);
  for (std::size_t i = 0; i < tasks.size(); ++i)
    tasks[i].parameters = test::parameters_with(event(0.1 + 0.07 * static_cast<double>(i), 2e-4, "1e-4"));
  std::vector<Task> examples(3);
  for (std::size_t i = 0; i < examples.size(); ++i)
    examples[i].parameters = tasks[5 * i].parameters;
  const auto shared = shared_numerics(examples, []() { return true; });
  ASSERT_TRUE(shared);
  const std::vector<bool> done =
    compute_similar(tasks, *shared, std::vector<double>(tasks.size(), shared->sizes.front()), HUGE_VAL, never);
  EXPECT_GE(std::count(done.begin(), done.end(), true), 10) << "most of them share their numerics";
  for (std::size_t i = 0; i < tasks.size(); ++i)
    if (done[i])
      expect_within(tasks[i].computed.result,
                    with_short_steps(event(0.1 + 0.07 * static_cast<double>(i), 2e-4, "1e-4"), 2e-4),
                    1e-4,
                    fmt::format("point {}", i));
}

TEST(Events, GaitsOfHundredsOfStrides)
{
  for (const auto &[settings, exact] :
       {std::pair("k = 30.199100422087973; T = 588.9260921199359; p = -3.41351959351645; chi = 0.061243176350007436; "
                  "c = -0.7964371869725007",
                  5.843672328812725),
        {"k = 37.47944457885461; T = 728.6483162675148; p = 3.524307968745102; chi = 0.02106611885423389; "
         "c = -0.4481391340392069",
         -0.9093776532489591},
        {"k = 12.354832814752847; T = 778.1620910319035; p = -0.4855237198344735; chi = 0.1360261489749871; "
         "c = -0.9408009676664544",
         11.223218696811003}})
    expect_within(answer_to(test::with(test::set(settings), {{"Accuracy", "1e-5"}})), exact, 1e-5, settings);
}

/// Samples of the stress saw nothing but the far end of its decay, so that steps were a million times too short.
TEST(Events, OneInALongRest)
{
  const auto settings = [](const std::string &time, const std::string &end_time) {
    return test::set("k = 0.93; p = 2.89; Accuracy = 1e-5; T = {}; expression; "
                     "Active stress = 0.53*sin(3*s-(t-q)/w)*exp(-((t-q)/w)^2); Constants = w = 0.07403, q = {}",
                     end_time,
                     time);
  };
  const SimulationResult rested = answer_to(settings("713.5928", "1000"));
  expect_within(rested, answer_to(settings("1.5", "50")).displacement, 1e-5, "after a long rest");
  EXPECT_LT(rested.time.steps, 1000u);
}

/// The displacement that a strain brings about: theory.md ("Prescribed strain") by Gauss's rule along the body and the
/// trapezoidal rule in time, with 40 000 and 80 000 steps (twice as many change no digit).
TEST(Events, OfGivenStrains)
{
  struct
  {
    const char *strain;
    double T, displacement;
  } const cases[] = {
    {"0.2*sin(2*pi*(s+t))*tanh(t)", 400., 8.0613681819049},
    {"0.2*sin(2*pi*(s+t))*tanh(5*t)+0.3*sin(pi*s)*sin(2*pi*s)*exp(-((t-13.126)/0.003)^2)", 20., 0.40019794627599}};
  for (const auto &[strain, T, displacement] : cases)
    for (const char *accuracy : {"1e-2", "1e-4", "1e-6"})
      expect_within(answer_to(test::set(
                      "Model = kinematic; T = {}; Accuracy = {}; prescribed strain; Strain = {}", T, accuracy, strain)),
                    displacement,
                    std::stod(accuracy),
                    fmt::format("{}, {}", strain, accuracy));
}

/// Both ends invert when m = k, on any mesh; pilots on finer and finer ones took minutes.
TEST(Events, EndsThatInvertInALongRun)
{
  const SimulationResult result =
    answer_to(test::set("k = 1.49; p = 2.24; T = 1000; Accuracy = 1e-5; expression; "
                        "Active stress = 0.2*sin(pi*s)*sin(2*pi*(s+t))*(1-exp(-t))+6*exp(-((t-815.9)/0.4)^2)"));
  ASSERT_EQ(result.time.reason, "inverted_at_end") << result.time.message;
  EXPECT_NEAR(result.inversion->t, 815.9 - 0.4 * std::sqrt(std::log(6. / 1.49)), 1e-9 * 815.9);
  EXPECT_LT(result.time.steps, 30000u);
}

/// The stress has hardly reached the body: no error is wanted to be smaller than round-off of the length.
TEST(Events, NothingHasHappenedYet)
{
  const SimulationResult result = answer_to(test::set("pulse; T = 0.05; Accuracy = 1e-4"));
  EXPECT_EQ(result.time.status, Status::finished) << result.time.message;
  EXPECT_LT(std::abs(result.displacement), 1e-15);
}

TEST(Events, TheTailOfAPulseHasHardlyCome)
{
  // Bounds of its rate that do not become as small as the tail and the ramp made steps of 1e-13 of the duration.
  const SimulationResult result =
    answer_to(test::set("k = 1e7; T = 0.3; pulse; Amplitude = 1e6; Width = 0.5; Speed = 1; Ramp duration = 0.3"));
  EXPECT_EQ(result.time.status, Status::finished) << result.time.message;
  EXPECT_LT(result.time.steps, 1000u);
  EXPECT_LT(std::abs(result.displacement), result.error->total);
}

/// Sixty strides that all have to be computed, since the ground varies or the body is too soft to settle: the first
/// three choose mesh and tolerance, and the bounds are about all sixty.
TEST(Events, FirstStridesChooseForLongRuns)
{
  const auto settings = [](const bool on_ground, const std::string &accuracy) {
    return test::with(test::wave(-1., 0.3, 1., 60., on_ground ? 1. : 0.01),
                      "Accuracy = {}; Ground/Profile = {}",
                      accuracy,
                      on_ground ? "1+0.2*sin(x)" : "1");
  };
  for (const bool on_ground : {false, true})
  {
    const std::string what      = on_ground ? "ground" : "soft body";
    const Parameters parameters = test::parameters_with(settings(on_ground, "1e-5"));
    const NumericsChoice choice = *choose_numerics({parameters, parameters.create_scene()});
    EXPECT_TRUE(std::isfinite(choice.min_size)) << what << ": " << choice.explanation;
    const SimulationResult exact = answer_to(settings(on_ground, "1e-8"));
    ASSERT_EQ(exact.time.status, Status::finished) << what << ": " << exact.time.message;
    for (const std::string accuracy : {"1e-3", "1e-5"})
      expect_within(answer_to(settings(on_ground, accuracy)), exact.displacement, std::stod(accuracy), what);
  }
}

/// A thousand strides and a single event in them; and three thousand, of which a grid over the duration shows 40 as
/// one.
TEST(Events, FormulasInLongRuns)
{
  const std::string wave = "0.2*sin(2*pi*(s+t))";
  const auto long_run    = [](const std::string &formula, const double end_time, const std::string &accuracy) {
    return answer_to(test::set("T = {}; Accuracy = {}; expression; Active stress = {}", end_time, accuracy, formula));
  };
  const auto with_event = long_run(wave + "+0.5*sin(pi*s)*sin(2*pi*s)*exp(-((t-530.126)/0.01)^2)", 1000., "1e-5");
  expect_within(with_event, 17.788083, 1e-5, "an event in 1000 strides");
  const auto all_alike = long_run(wave, 3000., "1e-4");
  for (const SimulationResult &result : {with_event, all_alike})
  {
    ASSERT_TRUE(result.gait && result.gait->wave_speed());
    EXPECT_NEAR(result.gait->period, 1., 1e-12);
    EXPECT_NEAR(*result.gait->wave_speed(), -0.9827, 1e-3);
    EXPECT_NEAR(*result.gait->slip(), 0.9819, 1e-3);
  }
  // A millionth of the run, and a burst of many periods in as little.
  const auto short_event = long_run(wave + "+0.4*sin(pi*s)*sin(2*pi*s)*exp(-((t-149.055)/0.00165)^2)", 2000., "1e-5");
  expect_within(short_event, 35.57588231, 1e-5, "an event in 2000 strides");
  const auto burst =
    long_run(wave + "+0.45*sin(pi*s)*sin(2*pi*s)*sin(40*t)*exp(-((t-959.169)/0.00145)^2)", 1000., "1e-5");
  expect_within(burst, 17.7872769, 1e-5, "a burst in 1000 strides");
}

/// A body that rests but for an event, whose start no step may pass over: all runs of an answer would have the same
/// error there. Its samples may be as small as those of a Gaussian far from its middle.
TEST(Events, EventsOfABodyAtRest)
{
  const auto answer = [](const std::string &formula, const std::string &constants, const std::string &end_time) {
    return answer_to(test::set("Accuracy = 1e-5; k = 0.59; p = 2.88; T = {}; expression; "
                               "Active stress = {}*exp(-((t-t0)/w)^2); Constants = {}",
                               end_time,
                               formula,
                               constants));
  };
  const std::string turning   = "0.336*sin(3*s-(t-t0)/w)";
  const SimulationResult late = answer(turning, "t0 = 850.6329, w = 0.05414", "1000");
  expect_within(late, -0.0055608451, 1e-5, "an event at 850 of 1000");
  const SimulationResult early = answer(turning, "t0 = 5.6329, w = 0.05414", "20");
  EXPECT_NEAR(late.displacement, early.displacement, late.error->total + early.error->total);
  const SimulationResult tiny = answer(turning, "t0 = 3850.6329, w = 0.02787", "5000");
  EXPECT_NEAR(
    tiny.displacement, answer(turning, "t0 = 5.6329, w = 0.02787", "20").displacement, 3. * tiny.error->total);
}
