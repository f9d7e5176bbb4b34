// Every indented command of docs/probability.md, run in its order, and its example of conditions read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"
#include "tests/integration/documented_page.h"

namespace gauntlet::testing_support {
namespace {

constexpr const char* kProbabilityPage = "probability.md";

TEST(ProbabilityPageTest, EveryCommandOnItWorksAndSaysWhatItQuotes) {
  ExpectCommandsSayWhatIsQuoted(kProbabilityPage, 2, 4);
}

TEST(ProbabilityPageTest, ItsConditionsAreOnesAndAreWrittenBackAsTheyMean) {
  const auto experiment = ParseExperiment("scenario = \"flocking\"\n" + FencedText(kProbabilityPage, "toml"),
                                          "page.toml", {}, BuiltInCatalogue());
  ASSERT_TRUE(experiment) << experiment.error().message;
  const std::string written = WriteExperiment(*experiment, {}, BuiltInCatalogue());
  EXPECT_THAT(written, testing::HasSubstr("[conditions]\n"));
  EXPECT_THAT(written, testing::HasSubstr("physics = \"impulse:3|box2d:1\"\n"));
  const auto again = ParseExperiment(written, "written.toml", {}, BuiltInCatalogue());
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->conditions, experiment->conditions);
}

}  // namespace
}  // namespace gauntlet::testing_support
