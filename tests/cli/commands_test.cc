// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../support/program.h"
#include "../support/run_text.h"

#include <deal.II/base/parameter_handler.h>

#include <boost/property_tree/xml_parser.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <regex>
#include <utility>

using namespace crawler::test;
using nlohmann::json;
namespace fs = std::filesystem;

namespace
{
  /// A cheap run: the default wave, a few output times.
  const std::string scene = "# the default wave\n"
                            "set Accuracy = 1e-3\n"
                            "subsection Output\n"
                            "  set Number of snapshots = 3\n"
                            "end\n";

  bool
  contains(const std::string &text, const std::string &part)
  {
    return text.find(part) != std::string::npos;
  }

  json
  summary_of(const fs::path &folder)
  {
    return json::parse(read_text(folder / "summary.json"));
  }

  std::vector<std::string>
  cells_of(const std::string &line)
  {
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');)
      cells.push_back(cell);
    return cells;
  }

  boost::property_tree::ptree
  xml(const fs::path &path)
  {
    boost::property_tree::ptree tree;
    boost::property_tree::read_xml(path.string(), tree); // throws if it is not well formed
    return tree;
  }

  /// The times that solution.pvd lists for the body; every file that it lists must be well-formed VTK.
  std::vector<double>
  output_times_of(const fs::path &folder)
  {
    std::vector<double> times;
    const auto tree = xml(folder / "solution.pvd");
    for (const auto &[name, node] : tree.get_child("VTKFile.Collection"))
      if (name == "DataSet")
      {
        if (node.get<std::string>("<xmlattr>.name") == "body")
          times.push_back(node.get<double>("<xmlattr>.timestep"));
        const auto file = node.get<std::string>("<xmlattr>.file");
        EXPECT_EQ(xml(folder / file).get<std::string>("VTKFile.<xmlattr>.type"), "UnstructuredGrid") << file;
      }
    return times;
  }

  void
  expect_output_times(const fs::path &folder, const std::vector<double> &wanted)
  {
    const std::vector<double> times = output_times_of(folder);
    ASSERT_EQ(times.size(), wanted.size());
    for (std::size_t i = 0; i < times.size(); ++i)
      EXPECT_NEAR(times[i], wanted[i], 1e-11) << i;
    const std::size_t files = std::distance(fs::directory_iterator(folder / "solution"), fs::directory_iterator());
    EXPECT_EQ(files, 3 * wanted.size() + 2); // body, grip and line; ground and scale; and nothing half-written
  }

  /// Rows of statistics.csv; every row is complete and every number finite.
  std::vector<std::vector<double>>
  statistics_of(const fs::path &folder)
  {
    const std::vector<std::string> lines = lines_of(read_text(folder / "statistics.csv"));
    std::vector<std::vector<double>> rows;
    for (std::size_t i = 1; i < lines.size(); ++i)
    {
      rows.emplace_back();
      for (const std::string &cell : cells_of(lines[i]))
      {
        rows.back().push_back(std::stod(cell));
        EXPECT_TRUE(std::isfinite(rows.back().back())) << lines[i];
      }
      EXPECT_EQ(rows.back().size(), cells_of(lines[0]).size()) << lines[i];
    }
    return rows;
  }

  /// The keys are a contract, and what is known must be a number.
  void
  expect_complete_summary(const json &summary, const bool with_energy_balance = true)
  {
    for (const char *key : {"status", "reason", "displacement_error", "model", "seconds", "versions", "command_line"})
      EXPECT_TRUE(summary.contains(key)) << key;
    for (const std::string &key :
         cells_of("displacement,end_time,cells,degree,degrees_of_freedom,steps,rejected_steps,newton_iterations"))
      EXPECT_TRUE(summary.at(key).is_number()) << key;
    for (const std::string &key :
         cells_of("stress_power,dissipation,elastic_energy,ledger_residual,paper_energy,positive_power,net_friction"))
      EXPECT_TRUE(with_energy_balance ? summary.at(key).is_number() : summary.at(key).is_null()) << key;
    for (const char *key : {"min_stretch", "max_stretch"})
      for (const char *part : {"value", "s", "t"})
        EXPECT_TRUE(summary.at(key).at(part).is_number()) << key << ' ' << part;
    for (const char *key : {"total", "space", "time", "model"})
      EXPECT_TRUE(summary.at("displacement_error").contains(key)) << key;
    for (const char *key : {"setup", "solve", "output"})
      EXPECT_TRUE(summary.at("seconds").at(key).is_number()) << key;
    for (const char *key : {"crawler", "deal.II", "PETSc"})
      EXPECT_TRUE(summary.at("versions").contains(key)) << key;
  }

  class Commands : public testing::Test
  {
  protected:
    ProgramResult
    run(const std::vector<std::string> &more, const std::string &file = scene)
    {
      write_text(folder.path / "scene.prm", file);
      std::vector<std::string> arguments = {"run", "scene.prm", "--output", "results"};
      arguments.insert(arguments.end(), more.begin(), more.end());
      return run_program(folder.path, arguments);
    }

    TemporaryFolder folder;
    const fs::path results = folder.path / "results";
  };

  /// Does something with the entry of that name in its section.
  template <typename Action>
  void
  visit(dealii::ParameterHandler &handler, const std::string &path, const Action &action)
  {
    std::vector<std::string> words;
    std::istringstream in(path);
    for (std::string word; std::getline(in, word, '/');)
      words.push_back(word);
    for (std::size_t i = 0; i + 1 < words.size(); ++i)
      handler.enter_subsection(words[i]);
    action(words.back());
    for (std::size_t i = 0; i + 1 < words.size(); ++i)
      handler.leave_subsection();
  }
} // namespace

/// Parameter files are what ParameterHandler itself would write, byte for byte: the defaults, and those of a run (which
/// has no terms of a sum if there is none).
TEST_F(Commands, DealIIWritesTheSameParameterFiles)
{
  const json list = json::parse(run_program(folder.path, {"parameters", "--format", "json"}).out);
  const std::vector<std::pair<std::string, std::string>> values = {{"Accuracy", "1e-2"},
                                                                   {"Body/Anchoring exponent", "2.25"},
                                                                   {"Active stress/Optimal wave/Wave speed", "1"},
                                                                   {"Output/Number of snapshots", "0"}};
  const auto printed                                            = [&](const bool is_run) {
    dealii::ParameterHandler handler;
    for (const json &entry : list)
    {
      const std::string path = entry.at("entry"), unit = entry.at("unit");
      for (const char *key : {"expected", "documentation"})
        EXPECT_FALSE(entry.at(key).get<std::string>().empty()) << path << ", " << key;
      if (is_run && path.starts_with("Active stress/Sum/"))
        continue;
      visit(handler, path, [&](const std::string &name) {
        handler.declare_entry(name,
                              entry.at("default"),
                              dealii::Patterns::Anything(),
                              entry.at("documentation").get<std::string>() +
                                " Expected: " + entry.at("expected").get<std::string>() + "." +
                                (unit.empty() ? "" : " Unit: " + unit + "."));
      });
    }
    if (is_run)
      for (const auto &[entry, value] : values)
        visit(handler, entry, [&, text = value](const std::string &name) { handler.set(name, text); });
    std::ostringstream text;
    handler.print_parameters(text, dealii::ParameterHandler::PRM | dealii::ParameterHandler::KeepDeclarationOrder);
    return text.str();
  };
  const auto expect_same = [](const std::string &found, const std::string &expected) {
    const auto [here, there] = std::ranges::mismatch(found, expected);
    EXPECT_TRUE(found == expected) << "found: " << std::string(here, found.end()).substr(0, 200)
                                   << "\nexpected: " << std::string(there, expected.end()).substr(0, 200);
  };
  expect_same(run_program(folder.path, {"parameters"}).out, printed(/*is_run=*/false));
  expect_same(run_program(folder.path, {"parameters", "--format", "prm"}).out, printed(/*is_run=*/false));

  std::vector<std::string> entries;
  for (const auto &[entry, value] : values)
    entries.push_back(entry + "=" + value);
  EXPECT_EQ(run_program(folder.path, sets(entries, {"run", "-", "--quiet", "--output", "out"}), "set Accuracy = 1e-2\n")
              .exit_code,
            0);
  expect_same(read_text(folder.path / "out/parameters.prm"), printed(/*is_run=*/true));
}

TEST_F(Commands, CheckListsTheWavesAndWritesNothing)
{
  write_text(folder.path / "scene.prm", scene);
  const auto before          = folder.content();
  const ProgramResult result = run_program(
    folder.path, {"check", "scene.prm", "--output", "results", "--set", "Active stress/Optimal wave/Energy=0.51"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  for (const char *part :
       {"Model nonlinear", "Mesh: ", "index", "speed", "displacement", "<- chosen", "no files were written"})
    EXPECT_TRUE(contains(result.out, part)) << part << "\nin: " << result.out;
  EXPECT_GE(std::count(result.out.begin(), result.out.end(), '\n'),
            10); // several waves spend this energy
  EXPECT_EQ(folder.content(), before);
}

TEST_F(Commands, RunWritesEveryFile)
{
  const ProgramResult result = run({});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_TRUE(contains(lines_of(result.out).back(), "results/solution.pvd")) << result.out;

  EXPECT_EQ(read_text(results / "original.prm"), scene);
  const std::string log = read_text(results / "log.txt");
  EXPECT_EQ(log, result.out);
  const json summary = summary_of(results);
  expect_complete_summary(summary);
  EXPECT_EQ(summary.at("status"), "finished");
  EXPECT_TRUE(summary.at("reason").is_null());
  EXPECT_EQ(summary.at("end_time"), 1.);
  EXPECT_NEAR(summary.at("displacement"), 0.0900726, 1e-4);
  EXPECT_EQ(summary.at("command_line"), "crawler run scene.prm --output results");

  const std::string header = lines_of(read_text(results / "statistics.csv"))[0];
  for (const std::string &cell : cells_of(header))
    EXPECT_TRUE(std::regex_match(cell, std::regex("[a-z ]+ \\[[a-z0-9/ ^]+\\]"))) << cell;
  const auto rows = statistics_of(results);
  EXPECT_EQ(rows.size(), summary.at("steps").get<std::size_t>() + 1 + 2); // two snapshots are within steps
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end(), [](const auto &a, const auto &b) { return a[1] < b[1]; }));
  EXPECT_EQ(rows.back()[1], 1.);
  EXPECT_EQ(rows.back()[3], summary.at("displacement").get<double>());

  expect_output_times(results, {0., 1. / 3., 2. / 3., 1.});
  const auto kymograph = xml(results / "kymograph.vts");
  EXPECT_EQ(kymograph.get<std::string>("VTKFile.<xmlattr>.type"), "StructuredGrid");
  for (const char *field : {"stretch", "velocity", "active_stress", "friction_force"})
    EXPECT_TRUE(contains(read_text(results / "kymograph.vts"), "\"" + std::string(field) + "\"")) << field;

  // The effective parameters give the same displacement, to the last bit.
  fs::copy_file(results / "parameters.prm", folder.path / "again.prm");
  ASSERT_EQ(run_program(folder.path, {"run", "again.prm"}).exit_code, 0);
  EXPECT_EQ(summary_of(folder.path / "output-again").at("displacement"), summary.at("displacement"));
}

/// Without a mesh the files and their names are the same; fields are at 201 points.
TEST_F(Commands, RunsWithoutAMeshWriteEveryFile)
{
  const std::string waves =
    in_section("Output", "set Number of snapshots = 3") +
    "subsection Active stress\nset Generator = prescribed strain\nsubsection Prescribed strain\n"
    "set Given by = wave\nend\nend\n";
  const ProgramResult result = run(sets({"Model=auto"}), waves);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "Model kinematic: the strain is prescribed")) << result.out;
  EXPECT_TRUE(contains(result.out, "displacement      0.04606079858 +- ")) << result.out;
  EXPECT_EQ(read_text(results / "log.txt"), result.out);
  EXPECT_EQ(read_text(results / "original.prm"), waves);
  json summary = summary_of(results);
  EXPECT_TRUE(summary.at("degree").is_null());
  summary["degree"] = 0;
  expect_complete_summary(summary);
  EXPECT_EQ(summary.at("model"), "kinematic");
  EXPECT_EQ(summary.at("cells"), 0);
  for (const char *part : {"total", "space", "time", "model"})
    EXPECT_TRUE(summary.at("displacement_error").at(part).is_number()) << part;
  expect_output_times(results, {0., 1. / 3., 2. / 3., 1.});
  const auto rows = statistics_of(results);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_NEAR(rows.back()[3], summary.at("displacement"), 1e-10);
  EXPECT_TRUE(contains(read_text(results / "kymograph.vts"), "\"friction_force\""));
}

TEST_F(Commands, AModelThatCannotMeetAccuracySaysSo)
{
  const ProgramResult result = run(sets({"Model=perturbation"}), "set Accuracy = 1e-4\n");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(result.err.starts_with("crawler: accuracy_not_met: the estimated error of the displacement is 0.01"))
    << result.err;
  const json summary = summary_of(results);
  EXPECT_EQ(summary.at("status"), "failed");
  EXPECT_EQ(summary.at("reason"), "accuracy_not_met");
  EXPECT_NEAR(summary.at("displacement"), 0.08, 1e-15);
  EXPECT_GE(summary.at("displacement_error").at("total"), 9.00725298e-2 - 0.08);
  EXPECT_TRUE(summary.at("positive_power").is_null());
}

TEST_F(Commands, OverridesBeatTheFileAndStandardInputIsRead)
{
  const ProgramResult result = run_program(
    folder.path,
    {"run", "-", "--set", "Output/Number of snapshots=0", "--set", "Time/End time=2", "--set", "Time/End time = 0.5"},
    scene);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const fs::path output = folder.path / "output-stdin";
  EXPECT_EQ(summary_of(output).at("end_time"), 0.5); // the last one counts
  EXPECT_EQ(read_text(output / "original.prm"), scene);
  EXPECT_TRUE(std::regex_search(read_text(output / "parameters.prm"), std::regex("set End time += 0.5\\b")));
  for (const char *name : {"solution", "solution.pvd", "kymograph.vts"}) // no snapshots
    EXPECT_FALSE(fs::exists(output / name)) << name;
  EXPECT_EQ(lines_of(result.out).back(), "Results are in output-stdin/.");
}

/// A profile beside the file that an include names; what was run can be run again from anywhere.
TEST_F(Commands, FilesCountFromTheFolderOfTheParameterFile)
{
  fs::create_directories(folder.path / "scenes");
  write_text(folder.path / "scenes" / "ground.csv", "x,value\n-5,1\n0,2\n2,1.5\n5,1\n");
  write_text(folder.path / "scenes" / "rough.prm", in_section("Ground", "set Profile = ground.csv"));
  ASSERT_EQ(run({"--quiet"}, "include scenes/rough.prm\n" + scene).exit_code, 0);
  const double displacement = summary_of(results)["displacement"];

  const auto again = run_program(folder.path / "scenes", {"run", "../results/parameters.prm", "--output", "again"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(summary_of(folder.path / "scenes" / "again")["displacement"], displacement);

  const auto here = run(sets({"Ground/Profile=scenes/ground.csv"}, {"--quiet", "--overwrite"}));
  ASSERT_EQ(here.exit_code, 0) << here.err;
  EXPECT_EQ(summary_of(results)["displacement"], displacement);
}

TEST_F(Commands, AByteOrderMarkDoesNotMatter)
{
  EXPECT_EQ(run({"--quiet"}, "\xef\xbb\xbf" + scene).exit_code, 0);
  EXPECT_TRUE(fs::exists(results / "summary.json"));
}

/// Waves at p = 1 move nothing, by 0 and not by -0.
TEST_F(Commands, NothingIsMinusZero)
{
  const auto result = run(sets({"Body/Anchoring exponent=1"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "leading-order displacement 0,")) << result.out;
  const std::regex minus("(^|[^a-z0-9.])-(0|0[.]0*|nan)([^0-9.]|$)");
  for (const std::string &text : {result.out, read_text(results / "log.txt"), read_text(results / "statistics.csv")})
    EXPECT_FALSE(std::regex_search(text, minus)) << text;
}

/// Tables beyond the body are in millimetres instead of metres, most likely. A cycle stop needs three cycles, and only
/// one is in the scene; a series has no energy balance to check.
TEST_F(Commands, WhatHasNoEffectIsNoted)
{
  write_text(folder.path / "skin.csv", "s,value\n0,1\n1,2\n3,2\n4,1\n");
  write_text(folder.path / "m.csv", "s,t,m\n0,0,0\n0,1,0.1\n4,0,0\n4,1,0.2\n");
  const std::string tables = in_section("Body", "set Friction profile = skin.csv") +
                             in_section("Active stress", "set Generator = table") +
                             in_section("Active stress/Table", "set File = m.csv\nset Interpolation = linear"),
                    strain = in_section("Active stress", "set Generator = prescribed strain") +
                             in_section("Active stress/Expression", "set Active stress = sin(s)"),
                    formula = in_section("Active stress", "set Generator = expression") +
                              in_section("Active stress/Expression",
                                         "set Active stress = A*sin(2*pi*(s+t))\nset Constants = A = 0.1, B = 2"),
                    wave       = in_section("Active stress/Optimal wave", "set Choose wave by = wave speed");
  const std::string expression = "Active stress/Expression/";
  struct Row
  {
    std::string lines;
    std::vector<std::string> settings, notes; ///< without notes nothing is without an effect
  };
  const std::vector<Row> rows = {
    {tables,
     {},
     {"Note: the table of \"Body/Friction profile\" reaches to s = 4, but the body ends at 1",
      "Note: the table reaches to s = 4, but the body ends at 1; check \"Active stress/Table/Unit"}},
    {strain, {"Model=kinematic"}, {"\"Active stress/Expression/Active stress\" has no effect with"}},
    {formula, {}, {"\"B\" of \"Active stress/Expression/Constants\" has no effect with"}},
    {formula,
     {expression + "Active stress=sin(2*pi*(s+t))/10"},
     {"\"Active stress/Expression/Constants\" has no effect with"}},
    {formula, {expression + "Constants=A = 0.1"}, {}},
    {wave, {"Time/Cycle stop=off"}, {"\"Time/Cycle stop\" has no effect"}},
    {wave, {"Time/Cycle stop=off", "Time/End time=4"}, {}},
    {wave,
     {"Time/Cycle stop=off", "Time/End time=4", "Time/Step control=fixed", "Time/Initial step=0.1"},
     {"\"Time/Cycle stop\" has no effect"}},
    {wave, {"Output/Ledger tolerance=0.1", "Model=perturbation"}, {"\"Output/Ledger tolerance\" has no effect"}},
    {wave, {"Output/Ledger tolerance=0.1", "Model=nonlinear"}, {}},
    {wave, {"Time/Engine=petsc", "Time/Integrator=bdf"}, {"\"Time/Engine\" has no effect"}},
    {wave, {"Time/Engine=petsc"}, {}},
  };
  for (const Row &row : rows)
  {
    const auto checked = run_program(folder.path, sets(row.settings, {"check", "-"}), scene + row.lines);
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
    for (const std::string &note : row.notes)
      EXPECT_TRUE(contains(checked.out, note)) << note << "\nin: " << checked.out;
    EXPECT_TRUE(!row.notes.empty() || !contains(checked.out, "has no effect")) << checked.out;
  }
}

TEST_F(Commands, QuietPrintsNothing)
{
  const ProgramResult result = run({"--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
  EXPECT_TRUE(contains(read_text(results / "log.txt"), "Finished at t = 1"));
}

TEST_F(Commands, OverwriteReplacesOwnFilesOnly)
{
  ASSERT_EQ(run({"--quiet"}).exit_code, 0);
  write_text(results / "notes.txt", "mine\n");
  write_text(results / "solution" / "figure.png", "mine too\n");
  ASSERT_EQ(run({"--quiet"}).exit_code, 2);
  ASSERT_EQ(
    run(sets({"Output/Number of snapshots=1", "Output/Statistics=false"}, {"--quiet", "--overwrite"})).exit_code, 0);
  EXPECT_EQ(read_text(results / "notes.txt"), "mine\n");
  EXPECT_EQ(read_text(results / "solution" / "figure.png"), "mine too\n");
  EXPECT_EQ(output_times_of(results), (std::vector<double>{0., 1.}));
  EXPECT_FALSE(fs::exists(results / "solution" / "000002.vtu"));
  EXPECT_FALSE(fs::exists(results / "statistics.csv"));
  ASSERT_EQ(run(sets({"Output/Snapshot format=xdmf"}, {"--quiet", "--overwrite"})).exit_code, 0);
  for (const char *name : {"solution.pvd", "line.pvd", "solution/000000.vtu"})
    EXPECT_FALSE(fs::exists(results / name)) << name;
  ASSERT_EQ(run({"--quiet", "--overwrite"}).exit_code, 0);
  for (const char *name : {"solution.xdmf", "line.xdmf", "solution.h5"})
    EXPECT_FALSE(fs::exists(results / name)) << name;
}

TEST_F(Commands, WithoutLedgerTheWorksAreUnknown)
{
  ASSERT_EQ(run(sets({"Output/Ledger=false"})).exit_code, 0);
  expect_complete_summary(summary_of(results), /*with_energy_balance=*/false);
  EXPECT_FALSE(contains(read_text(results / "statistics.csv"), "dissipation"));
}

TEST_F(Commands, ExplicitNumericsAreUsed)
{
  const ProgramResult result = run(
    {"--set", "Discretization/Degree=3", "--set", "Discretization/Number of cells=17", "--set", "Time/Tolerance=1e-7"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json summary = summary_of(results);
  EXPECT_EQ(summary.at("degree"), 3);
  EXPECT_EQ(summary.at("cells"), 17);
  EXPECT_EQ(summary.at("degrees_of_freedom"), 52);
  EXPECT_TRUE(contains(result.out, "tolerance 1e-07")) << result.out;
}

TEST_F(Commands, UnusedPetscOptionsAreReported)
{
  const ProgramResult result =
    run({"--set", "Output/Statistics=false", "--", "-ts_adapt_clp", "0.1;2", "-ts_type", "bdf"});
  EXPECT_EQ(result.exit_code, 0);
  const std::string warning = "warning: nothing used the PETSc option -ts_adapt_clp\n";
  EXPECT_EQ(result.err, "crawler: " + warning);
  EXPECT_TRUE(contains(read_text(results / "log.txt"), warning));
  EXPECT_EQ(
    summary_of(results).at("command_line"),
    "crawler run scene.prm --output results --set Output/Statistics=false -- -ts_adapt_clp '0.1;2' -ts_type bdf");

  EXPECT_EQ(summary_of(results).at("integrator"), "bdf");
  write_text(folder.path / "scene.prm", scene + in_section("Sweep", "set Axes = Body/Elastic modulus : 1, 2"));
  const ProgramResult sweep = run_program(
    folder.path, {"sweep", "scene.prm", "--quiet", "--", "-ts_adapt_clp", "-1", "-ts_max_snes_failures", "3"});
  EXPECT_EQ(sweep.exit_code, 0);
  EXPECT_EQ(sweep.err, "crawler: " + warning);
}

/// For -1 < a < 0 only the stretch form is believed when it says that a body inverts.
TEST_F(Commands, InversionOfThePositionFormIsNotBelieved)
{
  const ProgramResult result = run(sets({"Active stress/Optimal wave/Choose wave by=wave speed",
                                         "Active stress/Optimal wave/Wave speed=1",
                                         "Active stress/Optimal wave/Perturbation parameter=0.7",
                                         "Body/Anchoring exponent=1.5",
                                         "Discretization/Formulation=position"}));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.err, "Discretization/Formulation = stretch")) << result.err;
  const json summary = summary_of(results);
  EXPECT_EQ(summary.at("reason"), "under_resolved");
  EXPECT_TRUE(summary.at("inversion").is_null());
}

TEST_F(Commands, StatisticsOfABodyThatInvertsEndWithTheAnswer)
{
  const std::string lines = in_section("Active stress", "set Generator = travelling wave") +
                            in_section("Active stress/Travelling wave", "set Amplitude = 1.2");
  const auto result = run(sets({"Output/Number of snapshots=64"}), scene + lines);
  ASSERT_EQ(result.exit_code, 4) << result.err;
  const json summary = summary_of(results);
  ASSERT_EQ(summary.at("status"), "inverted");
  const auto last = cells_of(lines_of(read_text(results / "statistics.csv")).back());
  EXPECT_DOUBLE_EQ(std::stod(last.at(1)), summary.at("end_time")); // the table has 16 digits
  EXPECT_DOUBLE_EQ(std::stod(last.at(3)), summary.at("displacement"));
  EXPECT_GT(output_times_of(results).back(), summary.at("end_time")); // pictures go on until it inverts
}

/// With a = 1 and chi = 0.6 the body really inverts, inside, near t = 0.308 (ends: verification/extremes_test.cc).
TEST_F(Commands, InversionIsNamed)
{
  const auto result = run(sets({"Active stress/Optimal wave/Choose wave by=wave speed",
                                "Active stress/Optimal wave/Wave speed=-1",
                                "Active stress/Optimal wave/Perturbation parameter=0.6",
                                "Body/Anchoring exponent=0",
                                "Output/Number of snapshots=10"}));
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
  EXPECT_TRUE(contains(result.err, "the body inverted")) << result.err;
  const json summary = summary_of(results);
  expect_complete_summary(summary);
  EXPECT_EQ(summary.at("status"), "inverted");
  EXPECT_EQ(summary.at("reason"), "inverted_inside");
  EXPECT_NEAR(summary.at("inversion").at("t"), 0.30812, 1e-3);
  EXPECT_NEAR(summary.at("inversion").at("s"), 0.667, 0.01);
  EXPECT_GT(summary.at("min_stretch").at("value"), 0.); // no inverted state is counted
  for (const auto &row : statistics_of(results))
    EXPECT_GT(row[4], 0.);
  expect_output_times(results, {0., 0.1, 0.2, 0.3});
  xml(results / "kymograph.vts");
}

TEST_F(Commands, ExitCodesAndStatusAgree)
{
  struct Case
  {
    std::vector<std::string> entries;
    int exit_code;
    std::string status, reason;
  };
  const std::vector<Case> cases = {
    {{"Time/Maximum number of steps=3"}, 5, "stopped", "step_limit"},
    {{"Output/Ledger tolerance=1e-15"}, 7, "failed", "ledger_residual"},
    {{"Active stress/Generator=expression",
      "Active stress/Expression/Active stress=0.1*s*t + 0*sqrt((t-0.58)^2-1e-4)",
      "Output/Number of snapshots=50"}, // a step ends at 0.58
     3,
     "failed",
     "nonfinite"},
  };
  for (const Case &c : cases)
  {
    const ProgramResult result = run(sets(c.entries, {"--quiet", "--overwrite"}));
    EXPECT_EQ(result.exit_code, c.exit_code) << result.err;
    const json summary = summary_of(results);
    expect_complete_summary(summary);
    EXPECT_EQ(summary.at("status"), c.status);
    EXPECT_EQ(summary.at("reason"), c.reason);
    EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
    EXPECT_TRUE(result.err.starts_with("crawler: " + summary.at("reason").get<std::string>() + ": ")) << result.err;
    EXPECT_TRUE(contains(result.err, summary.at("message").get<std::string>())) << result.err;
    statistics_of(results);
  }
}

TEST_F(Commands, SignalsStopARunInOrder)
{
  // A million steps, and no pilot runs. The signal comes with the tenth of a thousand pictures.
  write_text(folder.path / "scene.prm",
             in_section("Discretization", "set Number of cells = 50") +
               in_section("Time", "set Step control = fixed\nset Initial step = 1e-6") +
               in_section("Output", "set Number of snapshots = 1000"));
  for (const std::string name : {"TERM", "INT"})
  {
    fs::remove_all(results);
    Program program(folder.path, {"run", "scene.prm", "--output", "results"}, "", "write:000009.vtu:" + name);
    EXPECT_EQ(program.exit_code(), 5) << program.err();
    EXPECT_TRUE(program.err().starts_with("crawler: signal: stopped by a signal at t = ")) << program.err();
    const json summary = summary_of(results);
    expect_complete_summary(summary);
    EXPECT_EQ(summary.at("status"), "stopped");
    EXPECT_EQ(summary.at("reason"), "signal");
    const auto rows = statistics_of(results);
    EXPECT_EQ(rows.size(), summary.at("steps").get<std::size_t>() + 1);
    EXPECT_DOUBLE_EQ(rows.back()[1], summary.at("end_time").get<double>());
    const std::vector<double> output_times = output_times_of(results);
    EXPECT_EQ(output_times.size(), 10u);
    EXPECT_LE(output_times.back(), summary.at("end_time").get<double>() + 1e-11);
    xml(results / "kymograph.vts");
    EXPECT_TRUE(contains(read_text(results / "log.txt"), "Stopped at t = "));
  }
}
