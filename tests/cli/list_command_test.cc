#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

TEST_F(CommandLine, ListNamesEverythingWithUnitsDefaultsAndRanges) {
  EXPECT_EQ(Run({"list", "--json"}), kExitDone);
  const Json json = Json::parse(out_.str());
  ASSERT_FALSE(json.at("experiments").empty());
  EXPECT_TRUE(std::any_of(json.at("experiments").begin(), json.at("experiments").end(),
                          [](const Json& e) { return e.at("name") == "flocking"; }));
  for (const char* section : {"scenarios", "controllers"}) {
    for (const Json& entry : json.at(section)) {
      for (const Json& parameter : entry.at("parameters")) {
        EXPECT_LE(parameter.at("min"), parameter.at("default")) << parameter;
        EXPECT_GE(parameter.at("max"), parameter.at("default")) << parameter;
        EXPECT_TRUE(parameter.contains("unit"));
      }
    }
  }
  for (const Json& scenario : json.at("scenarios")) EXPECT_FALSE(scenario.at("metrics").empty());
  const Json& disturbances = json.at("disturbances");
  EXPECT_TRUE(std::any_of(disturbances.begin(), disturbances.end(), [](const Json& key) {
    return key.at("name") == "noise.range_and_bearing.drop" && key.at("default") == 0.0 &&
           key.at("max") == 1.0;
  }));
  EXPECT_TRUE(std::any_of(disturbances.begin(), disturbances.end(),
                          [](const Json& key) { return key.at("name") == "faults"; }));
  const Json& genetic = json.at("searches").at(0);
  EXPECT_EQ(genetic.at("name"), "genetic");
  const Json& population = genetic.at("parameters").at(0);
  EXPECT_EQ(population.at("name"), "search.population");
  EXPECT_EQ(population.at("default"), 20);
}

}  // namespace
}  // namespace gauntlet
