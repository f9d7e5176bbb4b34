#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

constexpr const char* kFile = R"(<argos-configuration><loop_functions library="x"/>
  <arena size="6,6,1"><box id="b" size="1,0.2,1"><body position="1,1,0"/></box></arena></argos-configuration>)";

TEST_F(CommandLine, ImportWritesCaseFilesAndSaysWhatItIgnored) {
  const std::string one = Write("one.argos", kFile);
  ASSERT_EQ(Run({"import", one, "--out", Path("one.json")}), kExitDone) << err_.str();
  ExpectText("import_import_writes_case_files_and_says_what_it_ignored", Read(Path("one.json")));
  EXPECT_EQ(err_.str(), "gauntlet: " + Path("one.argos") +
                            ": 0 of 4 walls are in the file, the others were added; no foot-bots, so the "
                            "scenario's number is taken; ignored: loop_functions\n"
                            "gauntlet: wrote " +
                            Path("one.json") + "\n");
  ASSERT_EQ(Run({"import", one, Write("two.argos", kFile), "--dir", Path("cases")}), kExitDone) << err_.str();
  EXPECT_EQ(Read(Path("cases/one.json")), Read(Path("one.json")));
  EXPECT_TRUE(std::filesystem::exists(Path("cases/two.json")));
}

TEST_F(CommandLine, ImportWritesAllFilesOrNone) {
  const std::string one = Write("one.argos", kFile);
  const std::string broken = Write("broken.argos", "<argos-configuration>\n<arena");
  EXPECT_EQ(Run({"import", one, broken, "--dir", Path("cases")}), kExitUsage);
  EXPECT_EQ(err_.str(), "gauntlet: " + Path("one.argos") +
                            ": 0 of 4 walls are in the file, the others were added; no foot-bots, so the "
                            "scenario's number is taken; ignored: loop_functions\n"
                            "gauntlet: " +
                            Path("broken.argos") + ":2:6: malformed XML: Error parsing start element tag\n");
  EXPECT_FALSE(std::filesystem::exists(Path("cases")));
}

}  // namespace
}  // namespace gauntlet
