// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../support/program.h"

#include <ostream>

using namespace crawler::test;

namespace
{
  using Words = std::vector<std::string>;

  /// A file or command line with a mistake, and what the program must say about it.
  struct BadInput
  {
    std::string name;
    std::string file; ///< content of bad.prm
    Words message;    ///< must be in the one line on standard error
    int exit_code   = 2;
    Words arguments = {"run", "bad.prm", "--output", "results"};
  };

  void
  PrintTo(const BadInput &input, std::ostream *out)
  {
    *out << input.name;
  }

  const std::string good = "set Accuracy = 1e-3\n";

  BadInput
  bad_arguments(const std::string &name, const Words &arguments, const Words &message, const int exit_code = 2)
  {
    return {name, good, message, exit_code, arguments};
  }

  /// A bad formula of the active stress; the constants stand in line 5.
  BadInput
  bad_formula(const std::string &name, const std::string &formula, const std::string &constants, const Words &message)
  {
    return {name,
            "subsection Active stress\nset Generator = expression\nsubsection Expression\nset Active "
            "stress = " +
              formula + "\nset Constants = " + constants + "\nend\nend\n",
            message};
  }

  BadInput
  bad_wave(const std::string &name, const std::string &lines, const Words &message)
  {
    return {name, in_section("Active stress/Optimal wave", lines), message};
  }

  /// The stretch form with what it does not have.
  std::vector<BadInput>
  stretch_form()
  {
    const std::string chosen = in_section("Discretization", "set Formulation = stretch");
    const auto with          = [&](const std::string &section, const std::string &line) {
      return chosen + in_section(section, line);
    };
    const std::string feedback = in_section("Active stress", "set Generator = strain feedback");
    return {
      {"FormulationOfOldTimes",
       in_section("Discretization", "set Formulation = log stretch"),
       {"bad.prm, line 2", "\"log stretch\"", "the nearest is \"stretch\""}},
      {"StretchOnAdaptiveMesh",
       with("Discretization", "set Mesh = adaptive"),
       {"bad.prm, line 5", "Formulation is stretch and Mesh is adaptive, but automatic or uniform is expected"}},
      {"StretchOfDegree3",
       with("Discretization", "set Degree = 3"),
       {"bad.prm, line 5", "Formulation is stretch and Degree is 3, but 1 is expected"}},
      {"StretchByPetsc",
       with("Time", "set Engine = petsc"),
       {"bad.prm, line 5", "Formulation is stretch and Engine is petsc, but automatic is expected"}},
      {"StretchByBdf",
       with("Time", "set Integrator = bdf"),
       {"bad.prm, line 5",
        "Formulation is stretch and Integrator is bdf, but automatic, radau 5 or radau 9 is expected"}},
      {"StretchByFixedSteps",
       with("Time", "set Step control = fixed\nset Initial step = 0.1"),
       {"bad.prm, line 5", "Formulation is stretch and Step control is fixed, but adaptive is expected"}},
      {"StretchOnSharedCells",
       with("Discretization", "set Share cells = yes"),
       {"bad.prm, line 5", "Formulation is stretch and Share cells is yes, but automatic or no is expected"}},
      {"StretchOnAGround",
       with("Ground", "set Profile = 1+0.1*x"),
       {"bad.prm, line 2", "Formulation is stretch, but position or automatic is expected", "place of each cell"}},
      {"StretchWithDelay",
       feedback +
         in_section("Active stress/Strain feedback", "set Active stress = 0.1*(w_delayed-1)\nset Delay = 0.2") + chosen,
       {"bad.prm, line 11", "Formulation is stretch, but position or automatic is expected", "other places or times"}},
      {"StretchWithSensors",
       feedback +
         in_section("Active stress/Strain feedback", "set Active stress = 0.1*(w_near-1)\nset Distance = 0.2") + chosen,
       {"bad.prm, line 11", "Formulation is stretch, but position or automatic is expected", "other places or times"}},
    };
  }

  /// Actuators of robots, and measurements.
  std::vector<BadInput>
  generators()
  {
    return {
      {"SegmentsAmplitudes",
       in_section("Active stress", "set Generator = segments") +
         in_section("Active stress/Segments", "set Amplitude = 1, 2"),
       {"bad.prm, line 6", "the list of amplitudes has 2 numbers", "1 or 8"}},
      {"TableFile",
       in_section("Active stress", "set Generator = table") + in_section("Active stress/Table", "set File = none.csv"),
       {"bad.prm, line 6", "cannot read \"none.csv\"", "header s,t,m"}},
      {"TableHeader",
       in_section("Active stress", "set Generator = table") + in_section("Active stress/Table", "set File = bad.prm"),
       {"the first row of \"bad.prm\" is \"subsection Active stress\"", "header s,t,m is expected"}},
      {"TableWithSemicolons",
       in_section("Active stress", "set Generator = table") + in_section("Active stress/Table", "set File = semi.csv"),
       {"\"s;t;m\"", "header s,t,m is expected", "separated by commas"}},
      {"ProfileOfASpreadsheet",
       in_section("Ground", "set Profile = zip.csv"),
       {"bad.prm, line 2", "\"zip.csv\" is a zip archive, as .xlsx", "a CSV file in UTF-8 with the header x,value"}},
    };
  }

  std::vector<BadInput>
  names()
  {
    return {
      {"UnknownSection", "subsection Boddy\nend\n", {"bad.prm, line 1", "\"Boddy\"", "nearest", "\"Body\""}},
      {"UnknownInnerSection",
       in_section("Active stress/Optimal wafe", ""),
       {"bad.prm, line 2", "\"Active stress/Optimal wafe\"", "\"Active stress/Optimal wave\""}},
      {"MisspeltEntry",
       in_section("Body", "\nset Lenght = 1"),
       {"bad.prm, line 3", "unknown entry \"Lenght\"", "in section \"Body\"", "nearest name is \"Length\""}},
      {"MisspeltEntryAtTop", "set Accuracie = 1e-3\n", {"bad.prm, line 1", "at the top level", "\"Accuracy\""}},
      {"EntryInWrongSection",
       in_section("Body", "set End time = 1"),
       {"bad.prm, line 2", "\"End time\"", "\"Time/End time\""}},
      {"EntryOfTheTopLevel",
       in_section("Output", "set Error estimate = false"),
       {"bad.prm, line 2", "in section \"Output\"; it is expected at the top level of the file"}},
      {"EntryOutsideItsSection", "set Length = 1\n", {"bad.prm, line 1", "at the top level", "\"Body/Length\""}},
      {"UnknownGenerator",
       in_section("Active stress", "set Generator = optimal waves"),
       {"bad.prm, line 2", "\"optimal waves\"", "\"none\"", "\"expression\"", "the nearest is \"optimal wave\""}},
      {"UnknownModel",
       "set Model = linaer\n",
       {"bad.prm, line 1", "\"Model\" is \"linaer\"", "\"kinematic\"", "the nearest is \"linear\""}},
      {"LinearModelForANonlinearEquation",
       "set Model = linear\n",
       {"bad.prm, line 1", "Model is linear", "a = 1 - p is -1", "a = 0 is expected"}},
      {"SeriesForAnExpression",
       "set Model = perturbation\n" + in_section("Active stress", "set Generator = expression"),
       {"bad.prm, line 1", "Model is perturbation", "series for the optimal wave", "Generator is expression"}},
      {"StrainThatDoesNotStartFromRest",
       in_section("Active stress",
                  "set Generator = prescribed strain\nsubsection Prescribed strain\nset Given by = wave\nend"),
       {"bad.prm, line 2", "the strain at t = 0 is", "0 is expected everywhere", "starts from rest"}},
      {"StrainThatInverts",
       in_section("Active stress",
                  "set Generator = prescribed strain\nsubsection Prescribed strain\nset Strain = -2*s*t\nend"),
       {"bad.prm, line 4", "the strain is -2 at s = 1, t = 1", "more than -1 is expected"}},
      {"MissingTableOfStrain",
       in_section("Active stress",
                  "set Generator = prescribed strain\nsubsection Prescribed strain\nset Given by = table\nset File = "
                  "no.csv\nend"),
       {"bad.prm, line 5", "cannot read \"no.csv\"", "header s,t,strain"}},
      {"UnknownIntegrator",
       in_section("Time", "set Integrator = bfd"),
       {"bad.prm, line 2", "unknown integrator \"bfd\"", "the nearest is \"bdf\""}},
      {"UnsoundRosw",
       in_section("Time", "set Integrator = rosw"),
       {"bad.prm, line 2", "\"rosw\" is refused", "constant mass matrix", "\"bdf\""}},
      {"UnsoundIrk", in_section("Time", "set Integrator = irk"), {"line 2", "\"irk\" is refused", "order here is 0"}},
      {"UnsoundGlle",
       in_section("Time", "set Integrator = glle"),
       {"line 2", "\"glle\" is refused", "control its error"}},
      {"IntegratorOfPetscThatIsNotOffered",
       in_section("Time", "set Integrator = backward euler"),
       {"bad.prm, line 2",
        "unknown integrator \"backward euler\"; \"automatic\", \"bdf\", \"radau 5\" or \"radau 9\" is expected"}},
    };
  }

  std::vector<BadInput>
  values()
  {
    const std::string positive = "a positive number is expected";
    return {
      {"NegativeLength", in_section("Body", "set Length = -1"), {"line 2", "\"Body/Length\" is \"-1\"", positive}},
      {"ZeroModulus",
       in_section("Body", "set Elastic modulus = 0"),
       {"line 2", "Elastic modulus\" is \"0\"", positive}},
      {"ZeroFriction",
       in_section("Body", "set Friction coefficient = 0"),
       {"line 2", "Friction coefficient", positive}},
      {"ExponentOutOfRange",
       in_section("Body", "set Anchoring exponent = 101"),
       {"\"101\"", "a number from -100 to 100"}},
      {"AccuracyTooSmall", "set Accuracy = 0\n", {"bad.prm, line 1", "\"Accuracy\" is \"0\"", "from 1e-12 to 0.1"}},
      {"AccuracyTooLarge", "\n\nset Accuracy = 0.2 # large\n", {"bad.prm, line 3", "\"0.2\"", "from 1e-12 to 0.1"}},
      {"NaN", in_section("Body", "set Length = nan"), {"line 2", "\"nan\"", positive}},
      {"Infinity", in_section("Body", "set Length = inf"), {"line 2", "\"inf\"", positive}},
      {"Overflow", in_section("Body", "set Length = 1e999"), {"line 2", "\"1e999\"", positive, "largest number"}},
      {"TextForNumber",
       in_section("Time", "set End time = soon"),
       {"line 2", "\"Time/End time\" is \"soon\"", positive}},
      {"UnitBehindNumber",
       in_section("Time", "set End time = 1 s"),
       {"line 2", "\"1 s\"", positive, "without its unit: 1"}},
      {"DecimalComma",
       in_section("Time", "set End time = 0,4"),
       {"line 2", "\"0,4\"", positive, "written with a point: 0.4"}},
      {"Hexadecimal", in_section("Body", "set Length = 0x10"), {"line 2", "\"0x10\"", positive}},
      {"EmptyValue", in_section("Body", "set Length ="), {"line 2", "\"Body/Length\" is \"\"", positive}},
      {"DegreeTooHigh", in_section("Discretization", "set Degree = 9"), {"\"9\"", "from 1 to 8", "\"automatic\""}},
      {"NoCells", in_section("Discretization", "set Number of cells = 0"), {"\"0\"", "whole number from 1"}},
      {"CellTooLarge",
       in_section("Discretization", "set Smallest cell = 10"),
       {"line", "Smallest cell is 10", "less than the Length, 1, is expected"}},
      {"NegativeCells", in_section("Discretization", "set Number of cells = -4"), {"\"-4\"", "whole number from 1"}},
      {"MillionMillionCells",
       in_section("Discretization", "set Number of cells = 1e12"),
       {"line 2", "\"1e12\"", "whole number from 1 to 10000000"}},
      {"HalfACell", in_section("Discretization", "set Number of cells = 4.5"), {"\"4.5\"", "whole number"}},
      {"OrderTooHigh", in_section("Time", "set Order = 6"), {"\"Time/Order\" is \"6\"", "from 1 to 5"}},
      {"ZeroTolerance",
       in_section("Time", "set Tolerance = 0"),
       {"\"0\"", "a positive number or the word \"automatic\""}},
      {"NegativeSnapshots", in_section("Output", "set Number of snapshots = -1"), {"\"-1\"", "from 0 to 1000000"}},
      {"HugeCount", in_section("Output", "set Number of snapshots = 99999999999999999999"), {"from 0 to 1000000"}},
      {"FlagAsNumber", in_section("Output", "set Ledger = 1"), {"\"Output/Ledger\" is \"1\"", "\"true\" or \"false\""}},
      {"StepControlMisspelt",
       in_section("Time", "set Step control = adaptiv"),
       {"\"adaptiv\"", "the nearest is \"adaptive\""}},
      {"CycleStopWithSnapshots",
       in_section("Time", "set Cycle stop = on"),
       {"line 2", "snapshots until the end time are wanted", "0 is expected for Output/Number of snapshots"}},
      {"FixedWithoutStep",
       in_section("Time", "set Step control = fixed"),
       {"line 2", "fixed", "number is expected for Initial step"}},
      {"ToleranceTooSmall",
       in_section("Time", "set Tolerance = 1e-300"),
       {"line 2", "Tolerance is 1e-300", "from 1e-100 to 1e+100 times the Length"}},
      {"StepTooSmall",
       in_section("Time", "set End time = 10\nset Initial step = 1e-300"),
       {"line 3", "Initial step is 1e-300", "from 1e-100 to 1e+100 times the End time"}},
      {"DenormalLength", in_section("Body", "set Length = 4e-320"), {"Body/Length is 4e-320", "from 1e-100 to 1e+100"}},
      {"HugeFriction",
       in_section("Body", "set Friction coefficient = 1e308"),
       {"gamma L^2/T is 1e+308", "from 1e-100 to 1e+100"}},
      {"StepBeyondEnd",
       in_section("Time", "set End time = 1\nset Initial step = 2"),
       {"line 3", "Initial step is 2", "at most the End time, 1"}},
    };
  }

  std::vector<BadInput>
  formulas()
  {
    return {
      bad_formula(
        "FormulaNotClosed", "sin(2*pi*s", "", {"bad.prm, line 4", "\"sin(2*pi*s\"", "position 11", "parenthesis"}),
      bad_formula("FormulaOperators", "sin(s) + * t", "", {"bad.prm, line 4", "position 10", "\"*\""}),
      bad_formula("FormulaNotComplete", "2*+", "", {"bad.prm, line 4", "position 4", "not complete"}),
      bad_formula("FormulaUnknownFunction",
                  "2*sine(s)",
                  "",
                  {"bad.prm, line 4", "position 3", "\"sine\"", "nearest name is \"sin\""}),
      bad_formula("FormulaUnknownVariable",
                  "A*s",
                  "B = 1",
                  {"bad.prm, line 4", "position 1", "\"A\"", "\"Active stress/Expression/Constants\", like A=1"}),
      bad_formula("FormulaPowerOfPython", "1+s**2", "", {"bad.prm, line 4", "position 4", "\"^\" is expected"}),
      bad_formula(
        "FormulaArguments", "sin(s, t)", "", {"bad.prm, line 4", "position", "Too many parameters", "\"sin\""}),
      bad_formula("FormulaEmpty", "", "", {"bad.prm, line 4", "empty", "expression of s and t is expected"}),
      bad_formula("FormulaAssigns", "s = 3", "", {"bad.prm, line 4", "position 3", "\"==\" is expected"}),
      bad_formula("TwoFormulas", "s, t", "", {"bad.prm, line 4", "position 2", "one formula is expected"}),
      bad_formula("FormulaInfinite", "1/s", "", {"bad.prm, line 4", "\"1/s\"", "s = 0", "finite number is expected"}),
      bad_formula(
        "FormulaLogarithm", "log(s)", "", {"bad.prm, line 4", "\"log(s)\"", "s = 0", "finite number is expected"}),
      bad_formula("FormulaNotReal", "sqrt(0.5-t)", "", {"bad.prm, line 4", "t = 0.5625", "finite number is expected"}),
      bad_formula("ConstantsWithoutValue", "x*s", "x", {"bad.prm, line 5", "found \"x\"", "name=number"}),
      bad_formula("ConstantsWithText", "x*s", "x = one", {"bad.prm, line 5", "found \"x = one\"", "name=number"}),
      bad_formula("ConstantsTrailingComma", "x*s", "x = 1,", {"bad.prm, line 5", "found \"\"", "name=number"}),
      bad_formula("ConstantTwice", "x*s", "x = 1, x = 2", {"bad.prm, line 5", "\"x\" is already defined"}),
      bad_formula("ConstantIsVariable", "s", "s = 1", {"bad.prm, line 5", "\"s\" is a variable"}),
    };
  }

  std::vector<BadInput>
  waves()
  {
    return {
      bad_wave("CoefficientCounts",
               "set Sine coefficients = 1, 2\nset Cosine coefficients = 1, 2, 3",
               {"bad.prm, line 4", "2 sine and 3 cosine", "or a single 0"}),
      bad_wave("AllCoefficientsZero",
               "set Sine coefficients = 0, 0",
               {"bad.prm, line 3", "are 0", "at least one that is not"}),
      bad_wave(
        "TrailingComma", "set Sine coefficients = 1,", {"bad.prm, line 3", "\"1,\"", "numbers separated by commas"}),
      bad_wave(
        "Semicolon", "set Cosine coefficients = 1; 2", {"bad.prm, line 3", "\"1; 2\"", "numbers separated by commas"}),
      bad_wave("NoWaveOfThisEnergy", "set Energy = 0.49", {"bad.prm, line 3", "H = 0.49", "the smallest, 0.5,"}),
      bad_wave(
        "EnergyTooLarge", "set Energy = 100", {"bad.prm, line 3", "H = 100", "the smallest, 0.5, to below 10.3696"}),
      bad_wave("RootIndexTooLarge",
               "set Energy = 5\nset Root = index\nset Root index = 3",
               {"bad.prm, line 5", "Root index is 3", "from 1 to 1 is expected"}),
      bad_wave("RootIndexZero", "set Root index = 0", {"bad.prm, line 3", "\"0\"", "whole number from 1"}),
      bad_wave(
        "NoneAdmissible",
        "set Perturbation parameter = 5\nset Energy = 5",
        {"bad.prm, line 3", "Perturbation parameter is 5", "a smaller one", "no wave of energy H = 5", "admissible"}),
      bad_wave("WaveStandsStill",
               "set Choose wave by = wave speed\nset Wave speed = 0",
               {"bad.prm, line 4", "wave speed is 0", "not 0 is expected"}),
      bad_wave("WaveOfTooManyStrides",
               "set Choose wave by = wave speed\nset Wave speed = 1e200",
               {"bad.prm, line 4", "1e+200 strides", "at most 1e+08"}),
      bad_wave("WaveAlmostStandsStill",
               "set Choose wave by = wave speed\nset Wave speed = 1e-200",
               {"bad.prm, line 4", "speed 1e-200", "faster", "is expected"}),
      bad_wave("StressTooLarge",
               "set Perturbation parameter = 1e100\nset Choose wave by = wave speed",
               {"bad.prm", "largest active stress", "0 or a number from 1e-20 to 1e+20"}),
      bad_wave("StressTooSmall",
               "set Perturbation parameter = 4e-320\nset Choose wave by = wave speed",
               {"bad.prm", "largest active stress", "0 or a number from 1e-20 to 1e+20"}),
      bad_wave("PerturbationIsText",
               "set Perturbation parameter = small",
               {"bad.prm, line 3", "\"small\"", "a number is expected"}),
    };
  }

  /// A sum with the lines @p first in its first term.
  BadInput
  bad_sum(const std::string &name, const std::string &first, const Words &message, const std::string &more = "")
  {
    return {name,
            "subsection Active stress\nset Generator = sum\nsubsection Sum\nsubsection Term 1\n" + first + "\nend\n" +
              more + "end\nend\n",
            message};
  }

  std::vector<BadInput>
  sums()
  {
    const std::string term = "Active stress/Sum/Term 1/";
    return {
      {"SumWithoutTerms", in_section("Active stress", "set Generator = sum"), {"the sum has no terms", "\"Term 1\""}},
      bad_sum("SumOfFactors", "set Combine = multiply", {"bad.prm, line 5", "all terms of the sum multiply"}),
      bad_sum("SumWithinSum",
              "set Generator = sum",
              {"bad.prm, line 5", "\"" + term + "Generator\"", "\"sum\"", "\"expression\""}),
      bad_sum("SumSectionWithinTerm",
              "subsection Sum\nsubsection Term 1\nend\nend",
              {"bad.prm, line 5", "\"" + term + "Sum\""}),
      bad_sum("SumWithGap",
              "set Factor = 1",
              {"\"Active stress/Sum/Term 3\"", "\"Term 2\" is not", "without gaps"},
              "subsection Term 3\nset Factor = 2\nend\n"),
      bad_sum("SumTermZero",
              "set Factor = 1",
              {"\"Active stress/Sum/Term 0\"", "\"Active stress/Sum/Term 1\""},
              "subsection Term 0\nend\n"),
      bad_sum("SumTermMisspelt", "set Factor = 1", {"\"Active stress/Sum/Tern 2\""}, "subsection Tern 2\nend\n"),
      bad_sum("SumWrongFormula",
              "subsection Expression\nset Active stress = sin(q)\nend",
              {"bad.prm, line 6", "term 1: error in the formula \"sin(q)\" at position 5"}),
      bad_sum(
        "SumWindowBackwards", "set Window in s = 0.5, 0.2", {"bad.prm, line 5", "Window in s is from 0.5 to 0.2"}),
      bad_sum(
        "SumWindowOfThree", "set Window in t = 0, 1, 2", {"bad.prm, line 5", "Window in t has 3 numbers, but two"}),
      bad_sum(
        "SumWindowOfWords", "set Window in t = from 0 to 1", {"bad.prm, line 5", "a list of numbers", "or nothing"}),
      bad_sum("SumWindowOutside", "set Window in s = 2, 3", {"bad.prm, line 5", "from 2 to 3", "from 0 to 1"}),
      bad_sum("SumEdgeTooWide",
              "set Window in s = 0.2, 0.6\nset Edge width in s = 0.3",
              {"bad.prm, line 6", "0.3 wide", "at most 0.2"}),
      bad_sum("SumEdgeNegative", "set Edge width in t = -1", {"bad.prm, line 5", "not negative"}),
      {"StrainByItself",
       in_section("Active stress/Prescribed strain", "set Given by = prescribed strain"),
       {"bad.prm, line 3", "\"prescribed strain\"", "\"travelling wave\""}},
      {"StressTableSize",
       in_section("Output", "set Active stress table = 65"),
       {"bad.prm, line 2", "\"65\"", "whole numbers from 2"}},
      {"LibraryMissing",
       "subsection Active stress\nset Generator = library\nsubsection Library\nset File = no.so\nend\nend\n",
       {"bad.prm, line 4", "there is no file", "/no.so"}},
    };
  }

  BadInput
  bad_sweep(const std::string &name, const std::string &lines, const Words &message)
  {
    return {name, in_section("Sweep", lines), message, 2, {"sweep", "bad.prm", "--output", "results"}};
  }

  std::vector<BadInput>
  sweeps()
  {
    return {
      bad_sweep("AxisOfUnknownEntry",
                "set Axes = Body/Lenght : 1, 2",
                {"bad.prm, line 2", "\"Sweep/Axes\"", "in section \"Body\"", "nearest name is \"Length\""}),
      bad_sweep("AxisOfUnknownSection",
                "set Axes = Boddy/Length : 1, 2",
                {"bad.prm, line 2", "\"Sweep/Axes\"", "\"Boddy\"", "\"Body\""}),
      bad_sweep("AxisValueOutOfRange",
                "set Axes = Body/Anchoring exponent : linspace(0, 200, 3)",
                {"bad.prm, line 2", "\"200\"", "a number from -100 to 100 is expected"}),
      bad_sweep("AxisOfHalfCells",
                "set Axes = Discretization/Number of cells : linspace(2, 5, 3)",
                {"bad.prm, line 2", "\"3.5\"", "a whole number"}),
      bad_sweep("AxisWithoutValues", "set Axes = Body/Length", {"bad.prm, line 2", "Section/Entry : VALUES"}),
      bad_sweep("AxisWithUnknownFunction",
                "set Axes = Body/Length : lospace(0, 1, 3)",
                {"bad.prm, line 2", "\"lospace\"", "the nearest is \"logspace\""}),
      bad_sweep("DecimalCommaInAnAxis",
                "set Axes = Body/Elastic modulus : 0,5",
                {"but a positive number is expected; decimals are written with a point: 0.5\n"}),
      bad_sweep("AxisOfTheSweepItself",
                "set Axes = Sweep/Seed : 2, 3",
                {"bad.prm, line 2", "cannot vary", "another section is expected"}),
      bad_sweep("RefinementThatIsNone", "set Cross-check refinement = 0.1", {"bad.prm, line 2", "a number from 1"}),
      {"FormerSection",
       in_section("Atlas", "set First axis = Body/Length : 1, 2"),
       {"bad.prm, line 1", "\"Atlas\" was removed", "Sweep/Axes = FIRST AXIS; SECOND AXIS", "Sweep/Cross-check = true"},
       2,
       {"sweep", "bad.prm", "--output", "results"}},
      bad_arguments("FormerCommand", {"atlas", "good.prm"}, {"\"crawler sweep\"", "\"Sweep/Cross-check = true\""}),
      bad_arguments("FormerEntry",
                    {"run", "good.prm", "--set", "Atlas/Time limit per run=1", "--output", "results"},
                    {"\"Atlas\" was removed", "Sweep/Time limit per point"}),
      bad_arguments("SweepWithoutFile", {"sweep"}, {"the parameter file is missing", "crawler sweep FILE.prm"}),
      bad_arguments("SweepInFullFolder",
                    {"sweep", "good.prm", "--set", "Sweep/Axes=Body/Length : 1, 2", "--output", "full"},
                    {"\"full\" is not empty"}),
    };
  }

  BadInput
  bad_tradeoff(const std::string &name, const std::string &lines, const Words &message)
  {
    return {name, in_section("Tradeoff", lines), message, 2, {"tradeoff", "bad.prm", "--output", "results"}};
  }

  std::vector<BadInput>
  tradeoffs()
  {
    return {
      bad_tradeoff("TradeoffIntegratorUnknown",
                   "set Integrators = radau 5, rado 9",
                   {"bad.prm, line 2", "\"Tradeoff/Integrators\"", "\"rado 9\"", "the nearest is \"radau 9\""}),
      bad_tradeoff("TradeoffIntegratorUnsound",
                   "set Integrators = rosw",
                   {"bad.prm, line 2", "\"rosw\"", "it is refused", "constant mass matrix"}),
      bad_tradeoff("TradeoffIntegratorAutomatic",
                   "set Integrators = automatic",
                   {"bad.prm, line 2", "\"automatic\"", "\"radau 9\""}),
      bad_tradeoff("TradeoffDegreeOutOfRange",
                   "set Degrees = 2, 9",
                   {"bad.prm, line 2", "\"Tradeoff/Degrees\"", "\"9\"", "a whole number from 1 to 8"}),
      bad_tradeoff("TradeoffWithoutDegrees", "set Degrees =", {"bad.prm, line 2", "\"Tradeoff/Degrees\"", "is empty"}),
      bad_tradeoff("TradeoffWithoutEngines", "set Engines =", {"bad.prm, line 2", "\"Tradeoff/Engines\"", "is empty"}),
      bad_tradeoff("TradeoffDegreeTwice", "set Degrees = 2, 2", {"bad.prm, line 2", "the value 2 occurs twice"}),
      bad_tradeoff("TradeoffFormulationUnknown",
                   "set Formulations = position, log stretch",
                   {"bad.prm, line 2", "\"log stretch\"", "the nearest is \"stretch\""}),
      bad_tradeoff("TradeoffHalfCells", "set Cells = 2, 2.5", {"bad.prm, line 2", "\"2.5\"", "a whole number from 1"}),
      bad_tradeoff("TradeoffToleranceTooLarge",
                   "set Tolerances = logspace(0, -2, 3)",
                   {"bad.prm, line 2", "\"1\"", "a number between 0 and 1"}),
      bad_tradeoff("TradeoffWithoutTime", "set Time limit = 0", {"bad.prm, line 2", "a positive number"}),
      bad_arguments("TradeoffInFullFolder", {"tradeoff", "good.prm", "--output", "full"}, {"\"full\" is not empty"}),
      bad_arguments("TradeoffResumesWhatIsNone",
                    {"tradeoff", "good.prm", "--output", "full", "--resume"},
                    {"\"full\" has no tradeoff that can be resumed"}),
      bad_arguments("TradeoffResumedAndOverwritten",
                    {"tradeoff", "good.prm", "--resume", "--overwrite"},
                    {"--resume and --overwrite contradict each other"}),
      bad_arguments("CheckIsNotResumed", {"check", "good.prm", "--resume"}, {"unknown option \"--resume\""}),
      bad_arguments("RunIsResumedOrOverwritten",
                    {"run", "good.prm", "--resume", "--overwrite"},
                    {"--resume and --overwrite contradict each other"}),
    };
  }

  std::vector<BadInput>
  files()
  {
    return {
      {"EmptyFile", "", {"bad.prm: ", "sets nothing", "\"set Entry = value\" is expected"}},
      {"OnlyComments", "# nothing\n\n  # at all\n", {"bad.prm: ", "sets nothing"}},
      {"BinaryFile",
       std::string("\x7f"
                   "ELF\x01\x00\x02",
                   7),
       {"bad.prm: ", "binary file", "text file"}},
      {"Utf16",
       std::string("\xff\xfe"
                   "s\0e\0t\0",
                   8),
       {"bad.prm: ", "text in UTF-16", "UTF-8 is expected"}},
      {"ZipArchive", "PK\x03\x04", {"bad.prm: ", "a zip archive", "text file of parameters"}},
      {"MissingEnd",
       "# c\nsubsection Body\nset Length = 1\n",
       {"bad.prm, line 2", "\"subsection Body\" has no \"end\""}},
      {"ExtraEnd", "subsection Body\nend\nend\n", {"bad.prm, line 3", "\"end\" without a matching \"subsection\""}},
      {"NeitherSetNorEnd",
       good + "Length = 1\n",
       {"bad.prm, line 2", "found \"Length = 1\"", "\"set\", \"subsection\", \"end\""}},
      {"CapitalSet", "Set Accuracy = 1e-3\n", {"bad.prm, line 1", "found \"Set Accuracy", "\"set\""}},
      {"SetWithoutEquals",
       "set Accuracy 1e-3\n",
       {"bad.prm, line 1", "\"set Accuracy 1e-3\"", "\"set Entry = value\""}},
      {"SetWithoutName", "set = 1e-3\n", {"bad.prm, line 1", "\"set Entry = value\" is expected"}},
      {"SectionWithoutName", good + "subsection\nend\n", {"bad.prm, line 2", "\"subsection\" without a name"}},
      {"SetTwice", good + "\n" + good, {"bad.prm, line 3", "\"Accuracy\"", "second time", "first in bad.prm, line 1"}},
      {"SetTwiceInReopenedSection",
       in_section("Body", "set Length = 1") + in_section("Body", "set Length = 2"),
       {"bad.prm, line 5", "\"Body/Length\"", "second time", "first in bad.prm, line 2"}},
      {"LineAfterContinuation",
       in_section("Active stress/Optimal wave", "set Sine coefficients = 1, \\\n 2\nset Root = none"),
       {"bad.prm, line 5", "\"none\""}},
      {"MissingInclude", good + "include missing.prm\n", {"bad.prm, line 2", "\"missing.prm\"", "no such file"}, 6},
      {"IncludeWithoutName", "include\n", {"bad.prm, line 1", "without the name of a file"}},
      {"IncludeInCircle", "include circle.prm\n", {".prm, line 1", "included files are nested"}},
      {"MistakeInInclude", "include wrong.prm\n", {"wrong.prm, line 2", "\"Body/Length\" is \"x\""}},
      {"IncludeInSection", in_section("Body", "include good.prm"), {"bad.prm, line 2", "outside of all subsections"}},
    };
  }

  std::vector<BadInput>
  command_lines()
  {
    const auto set = [](const std::string &name, const std::string &assignment, const Words &message) {
      return bad_arguments(name, {"run", "good.prm", "--output", "results", "--set", assignment}, message);
    };
    const auto petsc = [](const std::string &name, const Words &options, const Words &message) {
      Words arguments = {"run", "good.prm", "--output", "results", "--"};
      arguments.insert(arguments.end(), options.begin(), options.end());
      return bad_arguments(name, arguments, message);
    };
    return {
      bad_arguments("NoCommand", {}, {"command is missing", "\"run\", \"check\""}),
      bad_arguments("UnknownCommand", {"chekc", "good.prm"}, {"unknown command \"chekc\"", "the nearest is \"check\""}),
      bad_arguments("FileWithoutCommand", {"good.prm"}, {"command is missing", "mean \"crawler run good.prm\""}),
      bad_arguments("MissingFileName", {"run"}, {"the parameter file is missing", "\"crawler run FILE.prm\""}),
      bad_arguments("TwoFiles", {"run", "good.prm", "more.prm"}, {"found \"more.prm\"", "one parameter file"}),
      bad_arguments("FileForParameters", {"parameters", "good.prm"}, {"unknown section \"good.prm\""}),
      bad_arguments("UnknownOption",
                    {"run", "good.prm", "--ouptut", "results"},
                    {"unknown option \"--ouptut\"", "the nearest is \"--output\""}),
      bad_arguments("OptionOfAnotherCommand",
                    {"check", "good.prm", "--resume"},
                    {"unknown option \"--resume\" of the command \"check\""}),
      bad_arguments(
        "OptionBeforeCommand", {"--quiet", "run", "good.prm"}, {"\"--quiet\" is before the command \"run\""}),
      bad_arguments("OptionWithoutValue", {"run", "good.prm", "--output"}, {"\"--output\"", "a value is expected"}),
      bad_arguments("OptionTwice",
                    {"run", "good.prm", "--output", "results", "--output", "more"},
                    {"\"--output\" is given 2 times", "is expected only once"}),
      bad_arguments("EmptyOutput", {"run", "good.prm", "--output", ""}, {"\"--output\"", "name of a folder"}),
      bad_arguments("TwoSections", {"parameters", "Body", "Time"}, {"found \"Time\"", "one section"}),
      bad_arguments("MissingTemplate", {"init"}, {"the template is missing", "\"crawler init TEMPLATE\""}),
      bad_arguments("MissingShell", {"completion"}, {"the shell is missing", "\"crawler completion SHELL\""}),
      bad_arguments("EmptyNameOfTemplate", {"init", "robot", "--output", ""}, {"\"--output\"", "name of a file"}),
      bad_arguments("UnknownFormat", {"parameters", "--format", "html"}, {"\"html\"", "\"schema\" or \"results\""}),
      bad_arguments("PetscOptionsForParameters",
                    {"parameters", "--", "-ts_type", "bdf"},
                    {"\"-ts_type\"", "\"parameters\" takes no PETSc options"}),
      bad_arguments(
        "FileThatDoesNotExist", {"run", "missing.prm", "--output", "results"}, {"\"missing.prm\"", "no such file"}, 6),
      bad_arguments(
        "FileIsFolder", {"run", "full", "--output", "results"}, {"\"full\"", "is a folder", "file is expected"}, 6),
      bad_arguments("CheckOfBadFile", {"check", "wrong.prm"}, {"wrong.prm, line 2", "\"x\"", "positive number"}),
      bad_arguments("EmptyStandardInput", {"run", "-", "--output", "results"}, {"standard input: ", "sets nothing"}),
      set("OverrideWithoutEquals", "Body/Length", {"--set \"Body/Length\"", "\"Section/Entry=value\" is expected"}),
      set("OverrideUnknown", "Body/Lenght=1", {"--set \"Body/Lenght=1\"", "unknown entry \"Lenght\"", "\"Length\""}),
      set(
        "OverrideUnknownSection", "Bodi/Length=1", {"--set \"Bodi/Length=1\"", "unknown section \"Bodi\"", "\"Body\""}),
      set("OverrideOfSection", "Body=1", {"--set \"Body=1\"", "\"Body\" is a section", "entry"}),
      set(
        "OverrideBadValue", "Body/Length=-1", {"--set \"Body/Length=-1\"", "\"-1\"", "a positive number is expected"}),
      set("OverrideMakesBadScene",
          "Active stress/Optimal wave/Energy=0.1",
          {"--set \"Active", "H = 0.1", "the smallest, 0.5"}),
      petsc("PetscTypeRosw", {"-ts_type", "rosw"}, {"\"rosw\"", "-ts_type", "is refused", "constant mass matrix"}),
      petsc("PetscTypeNotTested",
            {"-ts_type", "beuler"},
            {"\"beuler\"", "-ts_type", "is refused: it is not tested", "\"bdf\" or \"radau\" is expected"}),
      petsc("PetscTypeUnknown", {"-ts_type", "magic"}, {"PETSc refuses", "\"--\"", "magic"}),
      petsc("PetscNumber", {"-ts_max_steps", "many"}, {"PETSc refuses", "\"--\"", "many"}),
      petsc("PetscOptionsFile", {"-options_file", "missing.txt"}, {"PETSc refuses", "\"--\"", "missing.txt"}),
      petsc("OptionBehindTheDashes",
            {"-ts_monitor", "--set", "Body/Length=2"},
            {"found \"--set\" after \"--\"", "those of crawler go before it"}),
      petsc("PetscStrayWord", {"ts_type", "bdf"}, {"after \"--\"", "\"ts_type\"", "PETSc option is expected"}),
      bad_arguments("OutputNotEmpty",
                    {"run", "good.prm", "--output", "full"},
                    {"\"full\" is not empty", "--output", "--overwrite"}),
      bad_arguments(
        "OutputIsFile", {"run", "good.prm", "--output", "occupied"}, {"\"occupied\"", "is not a folder"}, 6),
      bad_arguments("OutputIsFileOverwrite",
                    {"run", "good.prm", "--output", "occupied", "--overwrite"},
                    {"\"occupied\"", "is not a folder"},
                    6),
      bad_arguments("SnapshotFolderIsFile",
                    {"run", "good.prm", "--output", "odd", "--overwrite"},
                    {"\"odd/solution\"", "is not a folder"},
                    6),
      bad_arguments("OutputUnderFile",
                    {"run", "good.prm", "--output", "occupied/results"},
                    {"\"occupied/results\"", "is not a folder"},
                    6),
    };
  }

  /// What looks right, but has another sign in it, or was cut by the shell.
  std::vector<BadInput>
  slips()
  {
    const auto set = [](const std::string &name, const Words &words, const Words &message) {
      Words arguments = {"run", "good.prm"};
      arguments.insert(arguments.end(), words.begin(), words.end());
      return bad_arguments(name, arguments, message);
    };
    return {
      {"NoBreakSpaceInName",
       in_section("Body", "set Elastic\u00A0modulus = 0.5"),
       {"bad.prm, line 2",
        "there is a no-break space (U+00A0) in \"Body/Elastic\u00A0modulus\"",
        "a blank is expected"}},
      {"NoBreakSpaceBehindSet", "set\u00A0Accuracy = 1e-3\n", {"bad.prm, line 1", "a no-break space (U+00A0)"}},
      {"NoBreakSpaceInSection",
       in_section("Active\u00A0stress", "set Generator = none"),
       {"a no-break space (U+00A0)"}},
      {"TypographicMinus",
       "set Accuracy = 1e\u22123\n",
       {"bad.prm, line 1", "a typographic minus sign (U+2212) in \"1e\u22123\"", "\"-\" is expected"}},
      bad_formula("DashInFormula", "0.1*(s \u2013 t)", "", {"bad.prm, line 4", "a dash (U+2013)", "\"-\" is expected"}),
      {"TypographicQuotes",
       in_section("Ground", "set Friction law = \u201CNewtonian\u201D"),
       {"bad.prm, line 2", "a typographic quote (U+201C)", "the straight quote \" or none is expected"}},
      {"HomeSign",
       in_section("Ground", "set Profile = ~/ground.csv"),
       {"bad.prm, line 2", "\"~/ground.csv\" begins with \"~\", which only a shell replaces"}},
      {"HomeOfAnIncludedFile", "include ~/other.prm\n", {"bad.prm, line 1", "\"~/other.prm\" begins with \"~\""}},
      {"DecimalCommaInAFormula",
       in_section("Ground", "set Profile = 0,1*sin(s)"),
       {"several, separated by a comma; decimals are written with a point"}},
      {"DecimalCommaInAProfile", in_section("Body", "set Initial stretch = 0,9"), {"with a point: 0.9\n"}},
      bad_formula("DecimalCommaInAConstant", "a*sin(t)", "a = 0,1", {"decimals are written with a point: 0.1\n"}),
      bad_formula("NegativeDecimalComma", "-0,1*sin(t)", "", {"in the formula \"-0,1*sin(t)\"", "a point: 0.1\n"}),
      {"DecimalCommaInAListThatIsRefused",
       in_section("Active stress",
                  "set Generator = optimal wave\nsubsection Optimal wave\nset Sine coefficients = 0,5\nend"),
       {"no wave spends the energy", "bad.prm, line 4", "is the two numbers 0 and 5", "with a point, 0.5\n"}},
      bad_formula("LargeNumberInAFormula", "1e400*sin(t)", "", {"; the largest number is 1.8e+308\n"}),
      bad_formula("GreekPi", "sin(2*\u03C0*t)", "", {"a Greek pi (U+03C0)", "but \"pi\" is expected"}),
      {"SmallNumberHasNoUnit", in_section("Body", "set Length = -1e-3"), {"but a positive number is expected\n"}},
      bad_formula("KnownNames", "0.1*velocity", "A=1", {"it may use s, t, pi, L, T, A, and functions"}),
      set("QuotesOnCommandLine",
          {"--set", "\u201CBody/Length=2\u201D"},
          {"a typographic quote (U+201C) in \"\u201CBody/Length\"", "the straight quote"}),
      set("DashOnCommandLine", {"\u2014set", "Body/Length=2"}, {"a long dash (U+2014) in \"\u2014set\""}),
      set("SettingCutAtBlank",
          {"--set", "Body/Elastic", "modulus=2"},
          {"contains blanks, at which a shell splits it", "--set \"Body/Elastic modulus=2\""}),
      set("SettingWithoutEquals",
          {"--set", "Body/Length", "2"},
          {"\"Section/Entry=value\" is expected: --set \"Body/Length=2\""}),
      set("HomeSignOfFolder", {"--output=~/results"}, {"--output: \"~/results\" begins with \"~\""}),
      set("KilledFolder",
          {"--output", "killed"},
          {"\"killed\" has a run or study that was interrupted; the same command with --resume continues it"}),
    };
  }

  /// A folder with everything that the cases speak of.
  void
  fill(const std::filesystem::path &folder, const std::string &file)
  {
    write_text(folder / "bad.prm", file);
    write_text(folder / "good.prm", good);
    write_text(folder / "wrong.prm", "subsection Body\n  set Length = x\nend\n");
    write_text(folder / "circle.prm", "include bad.prm\n");
    write_text(folder / "occupied", "a file\n");
    write_text(folder / "semi.csv", "s;t;m\n0;0;1,5\n");
    write_text(folder / "zip.csv", "PK\x03\x04");
    std::filesystem::create_directory(folder / "full");
    write_text(folder / "full" / "summary.json", "older results\n");
    std::filesystem::create_directory(folder / "killed");
    write_text(folder / "killed" / "study.lock", "");
    std::filesystem::create_directory(folder / "odd");
    write_text(folder / "odd" / "solution", "not a folder\n");
  }

  void
  expect_one_sentence(const std::string &text)
  {
    EXPECT_TRUE(text.starts_with("crawler: ")) << text;
    EXPECT_EQ(lines_of(text).size(), 1u) << text;
    EXPECT_TRUE(text.ends_with('\n')) << text;
    for (const char *dump : {"Error Message", "deal.II", "PETSC ERROR", "terminate called", "MPI_ABORT", "exception"})
      EXPECT_EQ(text.find(dump), std::string::npos) << text;
  }

  class BadInputTest : public testing::TestWithParam<BadInput>
  {
  };
} // namespace

TEST_P(BadInputTest, IsRefusedInOneSentence)
{
  const BadInput &input = GetParam();
  const TemporaryFolder folder;
  fill(folder.path, input.file);
  const auto before = folder.content();

  const ProgramResult result = run_program(folder.path, input.arguments);

  EXPECT_EQ(result.exit_code, input.exit_code) << result.err;
  expect_one_sentence(result.err);
  EXPECT_EQ(result.out, "");
  for (const std::string &part : input.message)
    EXPECT_NE(result.err.find(part), std::string::npos) << "not found: " << part << "\nin: " << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path / "results"));
  EXPECT_EQ(folder.content(), before);
}

const auto name_of = [](const testing::TestParamInfo<BadInput> &info) { return info.param.name; };
INSTANTIATE_TEST_SUITE_P(Names, BadInputTest, testing::ValuesIn(names()), name_of);
INSTANTIATE_TEST_SUITE_P(Values, BadInputTest, testing::ValuesIn(values()), name_of);
INSTANTIATE_TEST_SUITE_P(Formulas, BadInputTest, testing::ValuesIn(formulas()), name_of);
INSTANTIATE_TEST_SUITE_P(Waves, BadInputTest, testing::ValuesIn(waves()), name_of);
INSTANTIATE_TEST_SUITE_P(Generators, BadInputTest, testing::ValuesIn(generators()), name_of);
INSTANTIATE_TEST_SUITE_P(StretchForm, BadInputTest, testing::ValuesIn(stretch_form()), name_of);
INSTANTIATE_TEST_SUITE_P(Sums, BadInputTest, testing::ValuesIn(sums()), name_of);
INSTANTIATE_TEST_SUITE_P(Sweeps, BadInputTest, testing::ValuesIn(sweeps()), name_of);
INSTANTIATE_TEST_SUITE_P(Tradeoffs, BadInputTest, testing::ValuesIn(tradeoffs()), name_of);
INSTANTIATE_TEST_SUITE_P(Files, BadInputTest, testing::ValuesIn(files()), name_of);
INSTANTIATE_TEST_SUITE_P(Slips, BadInputTest, testing::ValuesIn(slips()), name_of);
INSTANTIATE_TEST_SUITE_P(CommandLines, BadInputTest, testing::ValuesIn(command_lines()), name_of);

/// A link to itself is a file that cannot be read; one without permissions can be read by root only.
TEST(BadInput, UnreadableFile)
{
  const TemporaryFolder folder;
  fill(folder.path, good);
  const auto expect_refusal = [&](const std::string &words) {
    const ProgramResult result = run_program(folder.path, {"run", "bad.prm", "--output", "results"});
    EXPECT_EQ(result.exit_code, 6);
    expect_one_sentence(result.err);
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path / "results"));
  };
  if (geteuid() != 0)
  {
    std::filesystem::permissions(folder.path / "bad.prm", std::filesystem::perms::none);
    expect_refusal("permission denied");
  }
  std::filesystem::remove(folder.path / "bad.prm");
  std::filesystem::create_symlink("bad.prm", folder.path / "bad.prm");
  expect_refusal("cannot read \"bad.prm\"");
}
