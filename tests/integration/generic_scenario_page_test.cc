// Every command of docs/generic-scenario.md, run in its order, and its tables held against the code.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "controllers/registry.h"
#include "tests/integration/campaign_driver.h"
#include "tests/integration/documented_page.h"
#include "tests/support/paths.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;

std::string TextOf(const std::string& file) {
  std::ifstream in(std::string(GAUNTLET_SOURCE_DIR) + "/" + file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(GenericScenarioPageTest, EveryCommandOnItWorksAndSaysWhatItQuotes) {
  ExpectCommandsSayWhatIsQuoted("generic-scenario.md", 7, 6);
}

TEST(GenericScenarioPageTest, ItsFileIsTheShippedOne) {
  std::istringstream lines(FencedText("generic-scenario.md", "toml"));
  const std::string shipped = TextOf("experiments/gathering.toml");
  for (std::string line; std::getline(lines, line);) EXPECT_THAT(shipped, HasSubstr(line));
}

TEST(GenericScenarioPageTest, NamesEveryMeasure) {
  const std::string page = TextOf("docs/generic-scenario.md");
  for (const controllers::MetricInfo& metric : controllers::FindScenario("generic")->metrics) {
    const bool of_time =
        metric.name.ends_with("_mean") || metric.name.ends_with("_min") || metric.name.ends_with("_max");
    if (of_time) continue;
    EXPECT_THAT(page, HasSubstr("`" + std::string(metric.name) + "`"));
  }
}

}  // namespace
}  // namespace gauntlet::testing_support
