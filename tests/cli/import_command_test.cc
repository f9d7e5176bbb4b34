#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

using ::testing::HasSubstr;

constexpr const char* kFile = R"(<argos-configuration><loop_functions library="x"/>
  <arena size="6,6,1"><box id="b" size="1,0.2,1"><body position="1,1,0"/></box></arena></argos-configuration>)";

TEST_F(CommandLine, ImportWritesCaseFilesAndSaysWhatItIgnored) {
  const std::string one = Write("one.argos", kFile);
  ASSERT_EQ(Run({"import", one, "--out", Path("one.json")}), kExitDone) << err_.str();
  EXPECT_THAT(Read(Path("one.json")), HasSubstr("\"length\": 1.0"));
  EXPECT_THAT(err_.str(), HasSubstr("ignored: loop_functions"));
  ASSERT_EQ(Run({"import", one, Write("two.argos", kFile), "--dir", Path("cases")}), kExitDone) << err_.str();
  EXPECT_EQ(Read(Path("cases/one.json")), Read(Path("one.json")));
  EXPECT_TRUE(std::filesystem::exists(Path("cases/two.json")));
}

TEST_F(CommandLine, ImportWritesAllFilesOrNone) {
  const std::string one = Write("one.argos", kFile);
  const std::string broken = Write("broken.argos", "<argos-configuration>\n<arena");
  EXPECT_EQ(Run({"import", one, broken, "--dir", Path("cases")}), kExitUsage);
  EXPECT_THAT(err_.str(), HasSubstr("broken.argos:2:"));
  EXPECT_FALSE(std::filesystem::exists(Path("cases")));
}

TEST_F(CommandLine, ImportRefusesWhatIsUnclear) {
  const std::string one = Write("one.argos", kFile);
  ExpectUsageError({"import", one}, HasSubstr("where to? Either --out CASE.json"));
  ExpectUsageError({"import", "--dir", Path("c")}, HasSubstr("which files?"));
  ExpectUsageError({"import", one, one, "--dir", Path("c")}, HasSubstr("both would become one.json"));
  ExpectUsageError({"import", one, Path("two.argos"), "--out", Path("c")},
                   HasSubstr("2 files want a directory"));
  ExpectUsageError({"import", Path("case.json"), "--dir", Path("c")}, HasSubstr("only .argos"));
  ExpectUsageError({"import", Path("none.argos"), "--dir", Path("c")}, HasSubstr("none.argos: no such file"));
}

}  // namespace
}  // namespace gauntlet
