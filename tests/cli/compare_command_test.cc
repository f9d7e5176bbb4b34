#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "tests/cli/command_line_fixture.h"

namespace gauntlet {
namespace {

using Json = nlohmann::json;

constexpr const char* kFirst = "fitness,speed\n0.1,4\n0.2,5\n0.2,6\n";
constexpr const char* kSecond = "fitness,speed\n0.5,4\n0.2,5\n0.7,6\n0.9,8\n";

TEST_F(CommandLine, CompareGivesEveryFieldThatScriptsRelyOn) {
  const std::string a = Write("a.csv", kFirst);
  const std::string b = Write("b.csv", kSecond);
  ASSERT_EQ(Run({"compare", a, b, "--json"}), kExitDone) << err_.str();
  const Json json = Json::parse(out_.str());
  EXPECT_EQ(json.at("n1"), 3);
  EXPECT_EQ(json.at("n2"), 4);
  EXPECT_NEAR(json.at("mean").at(0).get<double>(), 0.5 / 3, 1e-12);
  EXPECT_NEAR(json.at("mean").at(1).get<double>(), 0.575, 1e-12);
  EXPECT_EQ(json.at("median"), Json::parse("[0.2, 0.6]"));
  EXPECT_EQ(json.at("sd").size(), 2U);
  // Ranks 1, 3, 3 against 3, 5, 6, 7.
  EXPECT_EQ(json.at("rank_sum1"), 7);
  EXPECT_EQ(json.at("rank_sum2"), 21);
  EXPECT_EQ(json.at("u1"), 1);
  EXPECT_EQ(json.at("u2"), 11);
  EXPECT_NEAR(json.at("a").get<double>(), 1.0 / 12, 1e-12);
  EXPECT_EQ(json.at("a_interval").size(), 2U);
  EXPECT_TRUE(json.at("a_cluster_interval").is_null());
  for (const char* p : {"p_less", "p_greater", "p_two_sided", "p_exact_less", "p_exact_greater"}) {
    EXPECT_GT(json.at(p).get<double>(), 0.0) << p;
    EXPECT_LE(json.at(p).get<double>(), 1.0) << p;
  }
  // Of the 35 ways to choose three of the ranks, those with a sum of at most 7: 1 3 3 in each of three pairs.
  EXPECT_NEAR(json.at("p_exact_less").get<double>(), 3.0 / 35, 1e-12);
  EXPECT_EQ(json.at("method").get<std::string>(),
            "Mann-Whitney U, normal approximation, corrected for ties and continuity; beside it Mann-Whitney "
            "U, exact distribution of the observed mid-ranks");
  EXPECT_EQ(json.at("effect"), "large");
  EXPECT_EQ(json.at("sets").at(0).at("set"), a);
  EXPECT_EQ(json.at("sets").at(0).at("box").at("lower_whisker"), 0.1);
}

TEST_F(CommandLine, CompareDrawsBothBoxes) {
  const std::string a = Write("a.csv", kFirst);
  const std::string b = Write("b.csv", kSecond);
  ASSERT_EQ(Run({"compare", a, b, "--svg", Path("boxes.svg")}), kExitDone) << err_.str();
  pugi::xml_document document;
  EXPECT_TRUE(document.load_file(Path("boxes.svg").c_str()));
  EXPECT_EQ(err_.str(), "gauntlet: wrote " + Path("boxes.svg") + "\n");
}

TEST_F(CommandLine, CompareSaysThatOneRunHasNoSpreadAndEqualOnesNoDifference) {
  const std::string one = Write("one.csv", "fitness\n0.5\n");
  const std::string equal = Write("equal.csv", "fitness\n0.5\n0.5\n");
  ASSERT_EQ(Run({"compare", one, equal, "--json"}), kExitDone) << err_.str();
  const Json json = Json::parse(out_.str());
  EXPECT_TRUE(json.at("sd").at(0).is_null());
  EXPECT_TRUE(json.at("a_interval").is_null());
  EXPECT_EQ(json.at("method").get<std::string>(),
            "no test: all values are equal; beside it Mann-Whitney U, exact distribution of the observed "
            "mid-ranks");
  EXPECT_EQ(json.at("p_two_sided"), 1.0);
  EXPECT_EQ(json.at("a"), 0.5);
  EXPECT_EQ(json.at("verdict").get<std::string>(), "All values are equal: nothing tells set 1 from set 2.");
}

}  // namespace
}  // namespace gauntlet
