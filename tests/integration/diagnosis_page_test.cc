// Every command of docs/diagnose.md, run in its order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/integration/campaign_driver.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

struct Page {
  std::vector<std::string> commands;
  std::vector<std::string> quoted;  // output: the other indented lines, but those of fenced blocks
};

Page ReadPage() {
  Page page;
  std::ifstream file(GAUNTLET_SOURCE_DIR "/docs/diagnose.md");
  bool fenced = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("```")) fenced = !fenced;
    if (fenced) continue;
    if (line.starts_with("    gauntlet ")) {
      page.commands.push_back(line.substr(4));
    } else if (line.starts_with("    ")) {
      page.quoted.push_back(line);
    }
  }
  return page;
}

std::vector<std::string> Words(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

// With one blank between words, as somebody sees it who works in `folder` and calls the program `gauntlet`.
std::string AsRead(const std::string& text, const std::string& folder) {
  std::string read;
  for (std::string word : Words(text)) {
    if (word == GauntletPath()) word = "gauntlet";
    if (word.starts_with(folder + "/")) word.erase(0, folder.size() + 1);
    read += word + " ";
  }
  return read;
}

// The parts of a quoted line between its "...", in a pattern for HasSubstr each.
std::vector<std::string> PartsOf(const std::string& quoted) {
  std::vector<std::string> parts(1);
  for (const std::string& word : Words(quoted)) {
    const std::size_t left_out = word.find("...");
    parts.back() += left_out == std::string::npos ? word + " " : word.substr(0, left_out);
    if (left_out != std::string::npos) parts.emplace_back();
  }
  std::erase(parts, "");
  return parts;
}

TEST(DiagnosisPageTest, EveryCommandOnItWorksAndSaysWhatItQuotes) {
  const TemporaryDirectory scratch;
  const Page page = ReadPage();
  for (const char* command :
       {"evolve", "confirm", "show", "replay", "minimise", "blame", "corpus add", "check"})
    EXPECT_THAT(page.commands, Contains(StartsWith(std::string("gauntlet ") + command)));
  std::string said;
  for (const std::string& command : page.commands) {
    SCOPED_TRACE(command);
    std::vector<std::string> arguments = Words(command);
    arguments.erase(arguments.begin());
    for (std::string& argument : arguments) {
      // What the page keeps in the reader's folder is kept in the scratch directory.
      const bool of_reader = argument.starts_with("campaigns/") || argument.ends_with(".svg") ||
                             argument.ends_with(".xml") || argument == "corpus";
      if (of_reader && &argument != &arguments.front()) argument = scratch / argument;
    }
    const ProcessResult result = Gauntlet(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    said += AsRead(result.out, scratch.path());
  }
  EXPECT_GE(page.quoted.size(), 8U);
  for (const std::string& line : page.quoted) {
    for (const std::string& part : PartsOf(line)) EXPECT_THAT(said, HasSubstr(part));
  }
  EXPECT_TRUE(std::filesystem::exists(scratch / "corpus/run-8.json"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "check.xml"));
}

}  // namespace
}  // namespace gauntlet::testing_support
