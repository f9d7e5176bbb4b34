// What `export` and `show --runs` refuse, and what the help of `export` promises; the rest is held against
// real campaigns in tests/integration/export_test.cc.
#include "cli/output/output_file.h"
#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST_F(CommandLine, ExportRefusesWhatItDoesNotKnow) {
  const auto expect = [&](const std::vector<std::string>& more, const std::string& message) {
    std::vector<std::string> arguments = {"export", Path("c"), "--out", Path("out")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ExpectUsageError(arguments, HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(Path("out")));
  };
  expect({}, "--format is required");
  expect({"--format", "xml"}, "--format xml: give csv, json or argos");
  expect({"--format", "csv", "--what", "robots"}, "--what robots: give runs, cases, trajectories or events");
  expect({"--format", "csv", "--run", "x"}, "--run x is no run");
  expect({"--format", "csv", "--what", "events", "--run", "3"}, "events belong to no single run");
  expect({"--format", "argos", "--what", "runs"}, "--what runs: .argos files hold cases");
  expect({"--format", "csv", "--controller-file", "mine.argos"}, "only .argos files hold controllers");
  expect({"--format", "argos", "--controller", "mine"}, "Give --controller-file FILE");
  expect({"--format", "csv"}, Path("c"));
}

TEST_F(CommandLine, TheHelpOfExportNamesItsColumnsWithUnits) {
  ASSERT_EQ(Run({"export", "--help"}), kExitDone);
  for (const char* column :
       {"search_seed", "fitness", "simulated_time  s", "orientation_deg   degrees", "kind"})
    EXPECT_THAT(out_.str(), HasSubstr(column));
}

TEST_F(CommandLine, ShowListsRunsAsJsonOnly) {
  ExpectUsageError({"show", Path("c"), "--runs"}, HasSubstr("--json"));
}

TEST_F(CommandLine, AnOutputDirectoryIsThereAsAWholeOrNotAtAll) {
  const auto write = [&](const std::string& path, bool fails) {
    return WriteOutputDirectory("--out", path, [&](const std::string& draft) -> Result<std::uint64_t> {
      std::ofstream(draft + "/one") << "x";
      EXPECT_FALSE(std::filesystem::exists(path + "/one"));
      if (fails) return Error{ErrorKind::kNoSpace, "full"};
      return std::uint64_t{1};
    });
  };
  EXPECT_EQ(write(Path("failed"), true).error().kind, ErrorKind::kNoSpace);
  EXPECT_TRUE(std::filesystem::is_empty(directory_));
  EXPECT_EQ(write(Path("new/"), false).value(), 1U);
  EXPECT_EQ(Read(Path("new/one")), "x");
  const Result<std::uint64_t> again = write(Path("new"), false);
  ASSERT_FALSE(again.ok());
  EXPECT_THAT(again.error().message, HasSubstr("there is something already"));
  std::filesystem::create_directory(Path("empty"));
  EXPECT_TRUE(write(Path("empty"), false).ok());
  EXPECT_THAT(Read(Path("empty/one")), "x");
}

}  // namespace
}  // namespace gauntlet
