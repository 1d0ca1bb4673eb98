// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Parameter files are what deal.II's ParameterHandler itself would write, byte for byte.
#include "../../support/run_text.h"
#include "../../support/test.h"

#include <crawler/parameters/entry_lists.h>

#include <deal.II/base/parameter_handler.h>

using namespace crawler;

namespace
{
  /// Does something with the entry of that name in its section.
  template <typename Action>
  void
  visit(dealii::ParameterHandler &handler, const std::string &path, const Action &action)
  {
    std::vector<std::string> words = split_path(path);
    const std::string name         = words.back();
    words.pop_back();
    for (const std::string &section : words)
      handler.enter_subsection(section);
    action(name);
    for (std::size_t i = 0; i < words.size(); ++i)
      handler.leave_subsection();
  }

  /// All entries, those of one term of a sum among them, with these values.
  void
  expect_same_text(const test::Settings &values)
  {
    Parameters parameters;
    Declarations declarations;
    parameters.count_terms(ParameterFile::from_text(test::in_section("Active stress/Sum/Term 1", ""), "test"));
    parameters.add_parameters(declarations);
    dealii::ParameterHandler handler;
    for (const EntryInfo &entry : declarations.entries())
    {
      EXPECT_NE(entry.expected, "") << entry.path;
      EXPECT_NE(entry.documentation, "") << entry.path;
      const std::string unit = entry.unit.empty() ? "" : " Unit: " + entry.unit + ".";
      visit(handler, entry.path, [&](const std::string &name) {
        handler.declare_entry(name,
                              entry.default_value,
                              dealii::Patterns::Anything(),
                              entry.documentation + " Expected: " + entry.expected + "." + unit);
      });
    }
    for (const auto &[entry, value] : values)
    {
      declarations.set(entry, value);
      visit(handler, entry, [&, text = value](const std::string &name) { handler.set(name, text); });
    }
    std::ostringstream found, expected;
    print_prm(declarations, found);
    handler.print_parameters(expected, dealii::ParameterHandler::PRM | dealii::ParameterHandler::KeepDeclarationOrder);
    const std::string here = found.str(), there = expected.str();
    const auto [a, b] = std::ranges::mismatch(here, there);
    EXPECT_TRUE(here == there) << "found: " << std::string(a, here.end()).substr(0, 200)
                               << "\nexpected: " << std::string(b, there.end()).substr(0, 200);
  }
} // namespace

TEST(EntryLists, DealIIWritesTheSameParameterFiles)
{
  expect_same_text({});
  expect_same_text({{"Accuracy", "1e-2"},
                    {"Body/Anchoring exponent", "2.25"},
                    {"Active stress/Optimal wave/Wave speed", "1"},
                    {"Output/Number of snapshots", "0"}});
}
