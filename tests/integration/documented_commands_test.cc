// The front page is run, and what other pages say of commands is held against their help.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/integration/campaign_driver.h"
#include "tests/integration/documented_page.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::SizeIs;

TEST(FrontPageTest, EveryCommandOnItWorksAndSaysWhatItQuotes) {
  const TemporaryDirectory scratch;
  DocumentedPage page = ReadPage("../README.md");
  // What begins with ./dev builds first; of these one runs gauntlet.
  const std::string build_and_run = "./dev run ";
  std::vector<std::string> commands;
  std::erase_if(page.quoted, [&](const std::string& line) {
    if (line.starts_with(build_and_run)) commands.push_back("gauntlet " + line.substr(build_and_run.size()));
    return line.starts_with("./dev ");
  });
  ASSERT_THAT(commands, SizeIs(1));
  page.commands.insert(page.commands.begin(), commands.front());
  EXPECT_THAT(page.commands, SizeIs(4));
  EXPECT_GE(page.quoted.size(), 10U);
  const ProcessResult result = RunCommands(page, scratch.path());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(fs::exists(scratch / "report.html"));
  ExpectQuoted(page, AsRead(result.out, scratch.path()));
}

TEST(CaseFilesPageTest, ShowsAFileAsItIsReadAndWritten) {
  const std::string shown = FencedText("case-files.md", "json");
  const TemporaryDirectory scratch;
  std::ofstream(scratch / "one-wall.json") << shown;
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"evaluate", "flocking", "--case", scratch / "one-wall.json", "--dir",
                                 scratch / "campaign"},
        {"export", scratch / "campaign", "--format", "json", "--what", "cases", "--out",
         scratch / "cases"}}) {
    const ProcessResult result = Gauntlet(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  const auto written = nlohmann::json::parse(ReadFile(scratch / "cases/case-1.json"));
  EXPECT_EQ(written.at("obstacles"), nlohmann::json::parse(shown).at("obstacles"));
}

// "evolve flocking --dir DIR" of each `gauntlet evolve flocking --dir DIR` in the text, and of each line that
// is one.
std::vector<std::string> CommandsIn(const std::string& text) {
  std::vector<std::string> commands;
  static const std::regex quoted("`gauntlet ([a-z][^`]*)`");
  static const std::regex line("\n    gauntlet ([a-z][^\n#&]*)");
  for (const std::regex& form : {quoted, line}) {
    const std::sregex_iterator end;
    for (std::sregex_iterator i(text.begin(), text.end(), form); i != end; ++i) commands.push_back((*i)[1]);
  }
  return commands;
}

std::string HelpOf(const std::vector<std::string>& command) {
  static std::map<std::vector<std::string>, std::string> known;
  std::string& help = known[command];
  if (!help.empty()) return help;
  std::vector<std::string> arguments = command;
  arguments.emplace_back("--help");
  const ProcessResult result = Gauntlet(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return help = result.out;
}

TEST(DocumentedCommandsTest, HaveTheOptionsThatPagesName) {
  std::size_t options = 0;
  const fs::path root = GAUNTLET_SOURCE_DIR;
  for (auto entry = fs::recursive_directory_iterator(root); entry != fs::end(entry); ++entry) {
    const std::string path = fs::relative(entry->path(), root).string();
    if (entry->is_directory() && (path == "build" || path.starts_with(".")))
      entry.disable_recursion_pending();
    if (!path.ends_with(".md")) continue;
    for (const std::string& command : CommandsIn(ReadFile(entry->path().string()))) {
      SCOPED_TRACE(path + ": gauntlet " + command);
      const std::vector<std::string> words = Words(command);
      std::vector<std::string> name = {words[0]};
      if (words.size() > 1 && words[0] == "corpus") name.push_back(words[1]);
      for (const std::string& word : words) {
        if (!word.starts_with("--")) continue;
        const std::string option = word.substr(0, word.find_first_not_of("abcdefghijklmnopqrstuvwxyz-"));
        EXPECT_THAT(HelpOf(name), testing::AnyOf(HasSubstr(option + " "), HasSubstr(option + "\n"),
                                                 HasSubstr(option + ",")));
        ++options;
      }
    }
  }
  EXPECT_GT(options, 100U);
}

TEST(DocumentedCommandsTest, AreAllInTheirTable) {
  const std::string page = ReadFile(GAUNTLET_SOURCE_DIR "/docs/commands.md");
  std::istringstream lines(HelpOf({}));
  bool listed = false;
  std::size_t commands = 0;
  for (std::string line; std::getline(lines, line) && !(listed && line.empty());) {
    if (listed) {
      EXPECT_THAT(page, testing::AnyOf(HasSubstr("| `gauntlet " + Words(line)[0] + " "),
                                       HasSubstr("| `gauntlet " + Words(line)[0] + "`")));
      ++commands;
    }
    listed = listed || line == "Subcommands:";
  }
  EXPECT_GT(commands, 20U);
}

}  // namespace
}  // namespace gauntlet::testing_support
