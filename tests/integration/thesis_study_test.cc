// The thesis' chapters, as `gauntlet study` repeats them in full: what has to come out, by effect and
// direction.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;

class ThesisStudy : public testing::Test {
 protected:
  // Runs a shipped study with all cores, which takes minutes.
  void Run(const std::string& name) {
    const ProcessResult result = Gauntlet({"study", name, "--dir", scratch_ / "study", "--json", "--quiet"},
                                          std::chrono::seconds(3500));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    report_ = json::parse(result.out);
    for (const json& claim : report_["claims"]) {
      claims_[claim["analysis"]] = claim["holds"];
      fmt::print("{}: {}\n", claim["claim"].get<std::string>(),
                 claim["holds"].get<bool>() ? "holds" : "does not hold");
    }
  }
  bool Holds(const std::string& analysis) const { return claims_.at(analysis); }
  double Figure(const std::string& name) const { return report_["figures"].at(name); }

  TemporaryDirectory scratch_;
  json report_;
  std::map<std::string, bool> claims_;
};

TEST_F(ThesisStudy, EvolvedCoursesBreakFlocksAndTheImprovedControllerStandsThemBetter) {
  Run("thesis-flocking");
  for (const char* claim : {"severity-3", "severity-5", "severity-7", "pair-1"})
    EXPECT_TRUE(Holds(claim)) << claim;
  EXPECT_GE(Figure("severity-5.second.mean"), 0.55);
  EXPECT_LE(Figure("severity-5.second.mean"), 0.75);
}

TEST_F(ThesisStudy, EvolvedCoursesStarveTheNestAndTheImprovedControllerStandsThemBetter) {
  Run("thesis-foraging");
  for (const char* claim : {"vp-severity", "vp-pair-1", "condition-1", "condition-2"})
    EXPECT_TRUE(Holds(claim)) << claim;
  EXPECT_GE(Figure("vp-severity.second.mean"), 3.0);
  EXPECT_LE(Figure("vp-severity.second.mean"), 7.0);
  EXPECT_LE(Figure("condition-2.second.percent"), 20.0);
}

TEST_F(ThesisStudy, EvolvedCoursesStopTheRelayBugSStandsThemBetterAndConvergenceSuffers) {
  Run("thesis-partitioning");
  for (const char* claim : {"sps-severity", "sps-pair-1", "failures"}) EXPECT_TRUE(Holds(claim)) << claim;
  EXPECT_GE(Figure("sps-severity.second.mean"), 3.0);
  EXPECT_LE(Figure("sps-severity.second.mean"), 10.0);
  for (const auto& [speed, suffix] : {std::pair(0.05, ""), std::pair(0.10, "-fast")}) {
    const auto plateau = [&, ending = suffix](const char* cases) {
      return Figure(fmt::format("hour-{}{}.plateau", cases, ending));
    };
    // Six robots, each at most one item per way of nest to source and back, edges of both off.
    const double round_trip = 2.0 * (4.0 - 0.5 - 0.36) / speed;
    EXPECT_LE(plateau("empty"), 6.0 * 120.0 / round_trip);
    EXPECT_LT(plateau("random"), plateau("empty"));
    EXPECT_LT(plateau("evolved"), plateau("random"));
  }
}

}  // namespace
}  // namespace gauntlet::testing_support
