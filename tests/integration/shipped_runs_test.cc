// Every run of the shipped experiments gives the result that it gave before (shipped_runs.txt), whoever
// rearranges the code. When results are meant to change, the list is replaced by what this test prints.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "tests/integration/campaign_database.h"
#include "tests/integration/campaign_driver.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

struct RecordedRuns {
  std::string command;            // arguments of gauntlet
  std::vector<std::string> runs;  // "12 2784cf76d5400fa7"
};

// As the list has them.
std::string Lines(const RecordedRuns& recorded) {
  std::string lines = recorded.command + "\n";
  for (const std::string& run : recorded.runs) lines += "  " + run + "\n";
  return lines;
}

void PrintTo(const RecordedRuns& recorded, std::ostream* os) {
  *os << recorded.command;
}

std::vector<RecordedRuns> Recorded() {
  std::ifstream file(GAUNTLET_SOURCE_DIR "/tests/integration/shipped_runs.txt");
  std::vector<RecordedRuns> all;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#")) continue;
    if (line.starts_with("  ")) {
      all.back().runs.push_back(line.substr(2));
    } else {
      all.push_back({line, {}});
    }
  }
  return all;
}

class ShippedRunsTest : public testing::TestWithParam<RecordedRuns> {};

TEST_P(ShippedRunsTest, GiveTheRecordedResults) {
  const TemporaryDirectory scratch;
  // The example ships without an experiment file; its README gives this line.
  const std::string example = scratch / "light-flocking.toml";
  std::ofstream(example) << "scenario = 'light-flocking'\n";
  std::vector<std::string> arguments;
  std::istringstream words(GetParam().command);
  for (std::string word; words >> word;) arguments.push_back(word == "light-flocking.toml" ? example : word);
  const std::string dir = scratch / "campaign";
  arguments.insert(arguments.end(), {"--dir", dir, "--workers", "2", "--quiet"});
  const ProcessResult result = Gauntlet(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const RecordedRuns found = {GetParam().command, StoredRuns(dir)};
  EXPECT_EQ(found.runs, GetParam().runs) << "found, as the list has it:\n" << Lines(found);
}

INSTANTIATE_TEST_SUITE_P(ShippedRuns, ShippedRunsTest, testing::ValuesIn(Recorded()));

TEST(ShippedRunsList, HasEveryShippedExperimentAndAtLeast200Runs) {
  std::size_t runs = 0;
  std::string commands;
  for (const RecordedRuns& recorded : Recorded()) {
    runs += recorded.runs.size();
    commands += recorded.command + "\n";
  }
  EXPECT_GE(runs, 200u);
  for (const ShippedExperiment& shipped : ListExperiments(BuiltInCatalogue())) {
    const std::string& name = shipped.name;
    EXPECT_THAT(commands, testing::HasSubstr("evolve " + name + " "));
  }
}

}  // namespace
}  // namespace gauntlet::testing_support
