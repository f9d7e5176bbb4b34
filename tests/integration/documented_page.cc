#include "tests/integration/documented_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/integration/campaign_driver.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

constexpr const char* kPrograms[] = {"gauntlet ", "argos3 ", "cd ", "cmake ", "cp ", "printf "};

bool IsCommand(const std::string& line) {
  return std::ranges::any_of(kPrograms, [&](const char* program) { return line.starts_with(program); });
}

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

}  // namespace

DocumentedPage ReadPage(const std::string& file) {
  DocumentedPage page;
  std::ifstream text(GAUNTLET_SOURCE_DIR "/docs/" + file);
  bool fenced = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```")) fenced = !fenced;
    if (fenced || !line.starts_with("    ")) continue;
    line.erase(0, 4);
    (IsCommand(line) ? page.commands : page.quoted).push_back(line);
  }
  return page;
}

ProcessResult RunCommands(const DocumentedPage& page, const std::string& folder) {
  {
    std::ofstream script(folder + "/script");
    // The system's programs before those of a version manager, whose python3 takes a second to start.
    script << "cd '" << folder << "'\nPATH='" << GAUNTLET_BINARY_DIR << "':/usr/bin:/bin:$PATH\n";
    for (const std::string& command : page.commands) script << command << "\n";
  }
  return RunProcess({"/bin/bash", "-eux", folder + "/script"}, {}, std::chrono::seconds(400));
}

std::string FencedText(const std::string& file, const std::string& language) {
  const std::string page = ReadFile(std::string(GAUNTLET_SOURCE_DIR "/docs/") + file);
  const std::string fence = "```" + language + "\n";
  const std::size_t begin = page.find(fence) + fence.size();
  return page.substr(begin, page.find("```", begin) - begin);
}

std::vector<std::string> Words(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), {}};
}

std::string AsRead(const std::string& output, const std::string& folder) {
  std::string read;
  for (std::string word : Words(output)) {
    if (word == GauntletPath()) word = "gauntlet";
    if (word.starts_with(folder + "/")) word.erase(0, folder.size() + 1);
    read += word + " ";
  }
  return read;
}

void ExpectQuoted(const DocumentedPage& page, const std::string& said) {
  for (const std::string& line : page.quoted) {
    for (const std::string& part : PartsOf(line)) EXPECT_THAT(said, testing::HasSubstr(part));
  }
}

void ExpectCommandsSayWhatIsQuoted(const std::string& file, std::size_t least_commands,
                                   std::size_t least_quoted) {
  const TemporaryDirectory scratch;
  const DocumentedPage page = ReadPage(file);
  EXPECT_GE(page.commands.size(), least_commands);
  EXPECT_GE(page.quoted.size(), least_quoted);
  const ProcessResult result = RunCommands(page, scratch.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  ExpectQuoted(page, AsRead(result.out, scratch.path()));
}

}  // namespace gauntlet::testing_support
