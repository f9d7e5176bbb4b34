// Every command of docs/diagnose.md, run in its order.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/integration/campaign_driver.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using testing::Contains;
using testing::StartsWith;

// Lines that are indented by four blanks and begin with the program's name.
std::vector<std::string> CommandsOfThePage() {
  std::vector<std::string> commands;
  std::ifstream page(GAUNTLET_SOURCE_DIR "/docs/diagnose.md");
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("    gauntlet ")) commands.push_back(line.substr(0, line.find("  #")).substr(4));
  }
  return commands;
}

TEST(DiagnosisPageTest, EveryCommandOnItWorks) {
  const TemporaryDirectory scratch;
  const std::vector<std::string> commands = CommandsOfThePage();
  for (const char* command : {"evolve", "confirm", "show", "replay", "minimise", "corpus add", "check"})
    EXPECT_THAT(commands, Contains(StartsWith(std::string("gauntlet ") + command)));
  for (const std::string& command : commands) {
    SCOPED_TRACE(command);
    std::istringstream text(command);
    std::vector<std::string> arguments;
    std::string program;
    text >> program;
    for (std::string argument; text >> argument;) {
      // What the page keeps in the reader's folder is kept in the scratch directory.
      const bool of_reader = argument.starts_with("campaigns/") || argument.ends_with(".svg") ||
                             argument.ends_with(".xml") || argument == "corpus";
      arguments.push_back(of_reader && !arguments.empty() ? scratch / argument : argument);
    }
    const ProcessResult result = Gauntlet(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  }
  EXPECT_TRUE(std::filesystem::exists(scratch / "corpus/run-8.json"));
  EXPECT_TRUE(std::filesystem::exists(scratch / "check.xml"));
}

}  // namespace
}  // namespace gauntlet::testing_support
