// Every run that a question about cases asks for gives the result that it gave before (questioned_runs.txt),
// whoever rearranges the code. When results are meant to change, the list is rewritten
// (tests/cli/goldens/README.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/integration/campaign_database.h"
#include "tests/integration/campaign_driver.h"
#include "tests/support/golden.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

const std::string kList = "tests/integration/questioned_runs.txt";

// Runs of every campaign below `folder`, by the campaign's directory.
std::map<std::string, std::vector<std::string>> RunsBelow(const std::string& folder) {
  std::map<std::string, std::vector<std::string>> runs;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::filesystem::path dir = entry.path().parent_path();
    if (entry.path().filename() == "campaign.db") runs[dir] = StoredRuns(dir);
  }
  return runs;
}

// `gauntlet` with the words of a line, in the folder.
void Do(const std::string& line, const std::string& folder) {
  std::vector<std::string> command = {"/usr/bin/env", "-C", folder, GauntletPath()};
  std::istringstream words(line);
  for (std::string word; words >> word;) command.push_back(word);
  if (!line.starts_with("corpus")) command.insert(command.end(), {"--workers", "2", "--quiet"});
  const ProcessResult result = RunProcess(command);
  EXPECT_EQ(result.exit_code, 0) << line << "\n" << result.err;
}

TEST(QuestionedRuns, GiveTheRecordedResults) {
  const TemporaryDirectory scratch;
  std::filesystem::copy(GAUNTLET_SOURCE_DIR "/tests/integration/cases/trap.json", scratch / "trap.json");
  std::map<std::string, std::vector<std::string>> before;
  std::string found;
  std::ifstream list(GAUNTLET_SOURCE_DIR "/" + kList);
  for (std::string line; std::getline(list, line);) {
    if (line.starts_with("  ")) continue;
    found += line + "\n";
    if (line.starts_with("#")) continue;
    Do(line, scratch.path());
    const auto after = RunsBelow(scratch.path());
    for (const auto& [dir, runs] : after) {
      for (std::size_t i = before[dir].size(); i < runs.size(); ++i) found += "  " + runs[i] + "\n";
    }
    before = after;
  }
  ExpectGolden(kList, found);
}

}  // namespace
}  // namespace gauntlet::testing_support
