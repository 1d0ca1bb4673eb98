// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/complaint.h"
#include "../../support/run_text.h"
#include "../../support/temporary_folder.h"
#include "../../support/test.h"

#include <crawler/base/exceptions.h>

using namespace crawler;

namespace
{
  Parameters
  read(const std::string &text)
  {
    ParameterFile file = ParameterFile::from_text(text, "file.prm");
    Parameters parameters;
    Declarations declarations;
    parameters.add_parameters(declarations);
    file.apply(declarations);
    return parameters;
  }

  std::string
  error_of(const std::string &text)
  {
    return test::complaint_of([&]() { read(text); });
  }
} // namespace

TEST(ParameterFile, ReadsSectionsCommentsAndContinuedLines)
{
  const Parameters parameters = read("# a comment\n"
                                     "set Accuracy = 1e-4 # another\n"
                                     "subsection Active stress\n"
                                     "  subsection Optimal wave\n"
                                     "    set Sine coefficients = 1, \\\n"
                                     "      0.5, \\\n"
                                     "      0.25\n"
                                     "  end\n"
                                     "end\r\n"
                                     "subsection Body\n  set Length = 3\nend");
  EXPECT_EQ(parameters.accuracy, 1e-4);
  EXPECT_EQ(parameters.active_stress.optimal_wave.sine_coefficients, (std::vector<double>{1., 0.5, 0.25}));
  EXPECT_EQ(parameters.body.length, 3.);
}

TEST(ParameterFile, WhatStandsBelowAnIncludeReplacesWhatItSets)
{
  const test::TemporaryFolder folder;
  const std::string body = (folder.path / "body.prm").string(), soft = (folder.path / "soft.prm").string();
  write_file(body, "set Accuracy = 1e-4\nsubsection Body\n set Length = 3\n set Elastic modulus = 2\nend\n");
  write_file(soft, "include body.prm\nsubsection Body\n set Elastic modulus = 0.5\nend\n");
  const Parameters parameters = read("include " + soft + "\nsubsection Body\n set Length = 7\nend\n");
  EXPECT_EQ(parameters.accuracy, 1e-4);
  EXPECT_EQ(parameters.body.elastic_modulus, 0.5);
  EXPECT_EQ(parameters.body.length, 7.);
  // Which of these is meant nobody can tell.
  EXPECT_NE(error_of("subsection Body\n set Length = 7\nend\ninclude " + body + "\n").find("second time"),
            std::string::npos);
  EXPECT_NE(error_of("include " + body + "\ninclude " + body + "\n").find("second time"), std::string::npos);
}

/// Whoever mixes files and overrides must tell them apart, however they are written.
TEST(ParameterFile, KnowsWhatStandsAboveFiles)
{
  ParameterFile file = ParameterFile::from_text("subsection Body\n  set Length = 3\nend\n", "file.prm");
  EXPECT_FALSE(file.assignment_of("Body/Length")->is_override);
  file.add_override(" Body / Length = 4");
  EXPECT_TRUE(file.assignment_of("Body/Length")->is_override);
  file.add_override("List[7] = 1"); // which makes a list too long
  EXPECT_EQ(file.with_place(InputError("too long", "List")).what(), std::string("--set \"List[7] = 1\": too long"));
  EXPECT_EQ(file.assignment_of("Body/Length")->value, "4");
  EXPECT_EQ(file.assignment_of("Body/Elastic modulus"), nullptr);
  const InputError error = file.with_place(InputError("too long", "Body/Length"));
  EXPECT_EQ(std::string(error.what()).find("--set"), 0u);
}
