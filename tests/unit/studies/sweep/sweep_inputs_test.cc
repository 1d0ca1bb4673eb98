// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../../support/temporary_folder.h"
#include "../../../support/test.h"

#include <crawler/base/exceptions.h>
#include <crawler/studies/sweep/sweep_inputs.h>

namespace
{
  using namespace crawler;

  /// A folder of its own in which the program "was started".
  class Inputs : public testing::Test
  {
  protected:
    Inputs()
    {
      std::filesystem::current_path(folder_.path);
    }
    ~Inputs() override
    {
      std::filesystem::current_path(before_);
    }

    static SweepInputs
    inputs(const std::string &text)
    {
      const ParameterFile file = ParameterFile::from_text(text, "test.prm");
      return sweep_inputs(SweepPoints(MPI_COMM_SELF, file));
    }

    static std::vector<std::string>
    changes(const SweepInputs &before, const SweepInputs &now)
    {
      return differences(before, now, {"Sweep/Time limit"});
    }

  private:
    const std::filesystem::path before_ = std::filesystem::current_path();
    const test::TemporaryFolder folder_;
  };

  TEST_F(Inputs, ScenesAreKeptAsWhatTheySetAndComparedEntryByEntry)
  {
    write_file("soft.prm", "subsection Body\n set Elastic modulus = 2\nend\n");
    write_file("plain.prm", "subsection Body\n set Length = 1 # the default\nend\n");
    const std::string text =
      "subsection Sweep\n set Axes = File : soft.prm, plain.prm; Body/Friction coefficient : 1, 2\n"
      " set Time limit = 5\nend\n";
    const SweepInputs before = inputs(text);
    EXPECT_EQ(before.at("scene files"), R"({"soft.prm":{"Body/Elastic modulus":"\"2\""}})");
    EXPECT_TRUE(changes(before, before).empty());

    for (const auto &[name, damage] :
         {std::pair("scene files", "{\"soft.prm\": "), {"parameters.prm", "subsection Bo\xff"}})
    {
      SweepInputs damaged = before;
      damaged[name]       = damage;
      EXPECT_THROW(changes(damaged, before), InputError);
    }

    write_file("plain.prm", "subsection Body\n set Length = 2\n set Friction coefficient = 7\nend\n");
    const auto changed = changes(before, inputs(text)); // the friction coefficient is that of the axis anyway
    EXPECT_EQ(changed, std::vector<std::string>{"Body/Length in plain.prm was not set and is \"2\""});
    write_file("plain.prm", "set Accuracy = 1e-6\n");
    EXPECT_EQ(changes(inputs(text), before).size(), 1u);
  }

  TEST_F(Inputs, EachPointHasItsFileHoweverManyThereAre)
  {
    constexpr int n = 150;
    std::string names;
    for (int i = 0; i < n; ++i)
    {
      const std::string name = std::to_string(i) + ".prm";
      write_file(name, "subsection Body\n set Length = " + std::to_string(i + 1) + "\nend\n");
      names += (i > 0 ? ", " : "") + name;
    }
    const std::string text   = "subsection Sweep\n set Axes = Body/Elastic modulus : 1, 2; File : " + names + "\nend\n";
    const ParameterFile file = ParameterFile::from_text(text, "test.prm");
    SweepPoints points(MPI_COMM_SELF, file);
    for (unsigned long point = 0; point < 2 * n; ++point)
    {
      EXPECT_EQ(points.parameters(point).body.length, static_cast<double>(point % n + 1));
      EXPECT_EQ(points.parameters(point).body.elastic_modulus, point < n ? 1. : 2.);
    }
    // A mistake in any of them is found before the first point.
    write_file("149.prm", "subsection Body\n set Longness = 1\nend\n");
    EXPECT_THROW(SweepPoints(MPI_COMM_SELF, file), InputError);
  }

  TEST_F(Inputs, FilesThatEntriesNameHaveFingerprints)
  {
    write_file("ground.csv", "x,value\n-9,1\n0,2\n2,1\n9,1\n");
    write_file("other.csv", "x,value\n-9,1\n0,2\n2,1\n9,3\n");
    const std::string text = "subsection Sweep\n set Axes = Ground/Profile : ground.csv, other.csv, 1 + 0.1*x^2\nend\n";
    const SweepInputs before = inputs(text);
    EXPECT_EQ(
      before.at("data files"),
      fmt::format(R"({{"ground.csv":"{}","other.csv":"{}"}})", fingerprint("ground.csv"), fingerprint("other.csv")));
    EXPECT_NE(fingerprint("ground.csv"), fingerprint("other.csv"));
    write_file("other.csv", "x,value\n-9,1\n0,2\n2,1\n9,4\n");
    const auto changed = changes(before, inputs(text));
    ASSERT_EQ(changed.size(), 1u);
    EXPECT_TRUE(changed[0].starts_with("the file \"other.csv\" was 25 bytes, CRC-32")) << changed[0];
    const std::string one = "subsection Ground\n set Profile = ground.csv\nend\n";
    EXPECT_EQ(
      inputs(one + "subsection Sweep\n set Axes = Body/Length : 1, 2\nend\n").at("data files"),
      fmt::format(R"({{"{}":"{}"}})", std::filesystem::absolute("ground.csv").string(), fingerprint("ground.csv")));
  }

  TEST_F(Inputs, TheChecksumIsThatOfZlib)
  {
    write_file("check", "123456789");
    EXPECT_EQ(fingerprint("check"), "9 bytes, CRC-32 cbf43926"); // the check value of CRC-32
    write_file("empty", "");
    EXPECT_EQ(fingerprint("empty"), "0 bytes, CRC-32 00000000");
    EXPECT_THROW(fingerprint("nothing"), FileError);
  }
} // namespace
