#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

TEST_F(CommandLine, EvaluateRefusesByRuleAndSimulatesTheRest) {
  const std::string good =
      Write("good.json", R"({"obstacles": [{"x": 0, "y": 1.5, "length": 1, "width": 0.2}]})");
  const std::string blocked =
      Write("blocked.json", R"({"obstacles": [{"x": 2.5, "y": 2.5, "length": 1, "width": 0.4}]})");
  const std::string broken = Write("broken.json", "{\"obstacles\": [}");
  EXPECT_EQ(Run({"evaluate", "flocking", "--case", blocked, good, broken, "--replicates", "2", "--json",
                 "--dir", Path("c")}),
            kExitUsage)
      << "the campaign of this test simulates nothing";
  EXPECT_EQ(campaigns_.experiment.search.algorithm, "cases");
  EXPECT_EQ(campaigns_.experiment.search.replicates, 2);
  ASSERT_EQ(campaigns_.cases.size(), 1U);
  EXPECT_EQ(campaigns_.cases[0].name, "good.json");
  const Json cases = Json::parse(out_.str()).at("cases");
  ASSERT_EQ(cases.size(), 3U);
  EXPECT_EQ(cases[0].at("file"), blocked);
  EXPECT_EQ(cases[0].at("refused"), "start-blocked");
  EXPECT_TRUE(cases[0].at("fitness").is_null());
  EXPECT_EQ(cases[1].at("file"), good);
  EXPECT_TRUE(cases[2].at("refused").is_null());
  EXPECT_EQ(cases[2].at("error").get<std::string>(),
            Path("broken.json") + ":1:16: unexpected '}'; expected '[', '{', or a literal");
  EXPECT_EQ(Messages(),
            "gauntlet: 100 runs in 4.0 s (25.0/s; master 0 us of CPU per run)\n"
            "gauntlet: " +
                Path("blocked.json") +
                ": refused, start-blocked: obstacle 1 (x 2.5 m, y 2.5 m, 1 x 0.4 m at 0 degrees) blocks the "
                "start (2.5, 2.5); a robot's centre needs 0.1 m of room there\n"
                "gauntlet: " +
                Path("broken.json") + ":1:16: unexpected '}'; expected '[', '{', or a literal\n");
}

TEST_F(CommandLine, CasesAreKnownByTheirFilesAndTheirOwnNames) {
  const std::string file = Write("bend.json", R"({"name": "a narrow bend", "obstacles": []})");
  (void)Run({"evaluate", "flocking", "--case", file, "--dir", Path("c")});
  ASSERT_EQ(campaigns_.cases.size(), 1U);
  EXPECT_EQ(campaigns_.cases[0].name, "bend.json (a narrow bend)");
}

TEST_F(CommandLine, NoticesOfManyFilesAreGivenOnce) {
  const std::string argos = R"(<argos-configuration><framework/><arena size="6,6,1"/></argos-configuration>)";
  const std::vector<std::string> files = {Write("a.argos", argos), Write("b.argos", argos),
                                          Write("c.argos", argos)};
  EXPECT_EQ(Run({"evaluate", "flocking", "--case", files[0], files[1], files[2], "--dir", Path("c")}),
            kExitUsage)
      << "the campaign of this test simulates nothing";
  const std::string text = err_.str();
  EXPECT_THAT(text, HasSubstr(files[0] + " and 2 more: 0 of 4 walls are in the file"));
  EXPECT_EQ(text.find("0 of 4 walls"), text.rfind("0 of 4 walls"));
}

TEST_F(CommandLine, EvaluateSweepsTheSameCasesInASearchForEachCombination) {
  const std::string a = Write("a.json", R"({"obstacles": []})");
  const std::string blocked =
      Write("blocked.json", R"({"obstacles": [{"x": 2.5, "y": 2.5, "length": 1, "width": 0.4}]})");
  EXPECT_EQ(Run({"evaluate", "flocking", "--case", a, blocked, a, "--sweep", "random_faults.count=11,0,3",
                 "--seeds", "4,8", "--dir", Path("c")}),
            kExitUsage)
      << "the campaign of this test simulates nothing";
  // Nothing can be simulated with more faulty robots than there are.
  ASSERT_EQ(campaigns_.searches.size(), 4U);
  EXPECT_EQ(campaigns_.searches[0].settings, "random_faults.count=0, seed 4");
  EXPECT_EQ(campaigns_.searches[3].settings, "random_faults.count=3, seed 8");
  for (const SearchPlan& search : campaigns_.searches) {
    EXPECT_EQ(search.experiment.search.algorithm, "cases");
    EXPECT_EQ(search.cases.size(), 2U);
  }
  EXPECT_EQ(campaigns_.searches[3].experiment.disturbances.random_faults.count, 3);
  EXPECT_EQ(campaigns_.searches[3].experiment.seed, 8U);
}

TEST_F(CommandLine, EvaluateRefusesSweepsThatMakeNoSense) {
  const std::string a = Write("a.json", R"({"obstacles": []})");
  const auto refusal = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"evaluate", "flocking", "--case", a, "--dir", Path("c")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    err_.str("");
    EXPECT_EQ(Run(arguments), kExitUsage);
    EXPECT_EQ(campaigns_.starts, 0);
    return err_.str();
  };
  EXPECT_EQ(
      refusal({"--sweep", "genome.genes=1,2"}),
      "gauntlet: 'genome.genes=1' and 'genome.genes=2' would be the same runs of the given cases: sweep "
      "what runs depend on, such as parameters, physics, noise and faults\n");
  EXPECT_THAT(refusal({"--sweep", "random_faults.what=wheels,leds"}), HasSubstr("would be the same runs"));
  EXPECT_THAT(refusal({"--sweep", "search.population=4,6"}),
              HasSubstr("--sweep search.population=4,6: the search 'cases' does not read search.population"));
  EXPECT_THAT(refusal({"--sweep", "search.algorithm=random,genetic"}),
              HasSubstr("--sweep search.algorithm already says search.algorithm=random; give one of them"));
  EXPECT_THAT(refusal({"--replicates", "3", "--sweep", "search.replicates=1,2"}),
              HasSubstr("give one of them"));
  EXPECT_THAT(refusal({"--seed", "3", "--seeds", "1..2"}),
              HasSubstr("--seed 3 and --seeds 1..2: give one of them"));
}

TEST_F(CommandLine, EvaluateExitsTwoWhenNothingCouldBeSimulated) {
  const std::string blocked =
      Write("blocked.json", R"({"obstacles": [{"x": 2.5, "y": 2.5, "length": 1, "width": 0.4}]})");
  EXPECT_EQ(Run({"evaluate", "flocking", "--case", blocked, "none.json", "--json", "--dir", Path("c")}),
            kExitUsage);
  EXPECT_EQ(campaigns_.starts, 0);
  const Json cases = Json::parse(out_.str()).at("cases");
  EXPECT_EQ(cases[0].at("refused"), "start-blocked");
  EXPECT_EQ(cases[1].at("error").get<std::string>(), "none.json: no such file");
  EXPECT_FALSE(std::filesystem::exists(Path("c")));
}

}  // namespace
}  // namespace gauntlet
