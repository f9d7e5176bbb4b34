// The thesis' chapters, as `gauntlet study` repeats them in full: what docs/thesis.md says came out.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <initializer_list>
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
  void ExpectHolds(std::initializer_list<const char*> analyses) const {
    for (const char* analysis : analyses) EXPECT_TRUE(claims_.at(analysis)) << analysis;
  }
  double Figure(const std::string& name) const { return report_["figures"].at(name); }
  // As docs/thesis.md tells them, bit for bit the same runs on every machine.
  void ExpectShown(const std::string& set, double mean, double sd) const {
    EXPECT_NEAR(Figure(set + ".mean"), mean, 0.0006) << set;
    EXPECT_NEAR(Figure(set + ".sd"), sd, 0.0006) << set;
  }

  TemporaryDirectory scratch_;
  json report_;
  std::map<std::string, bool> claims_;
};

TEST_F(ThesisStudy, EvolvedCoursesBreakFlocks) {
  Run("thesis-flocking");
  ExpectHolds({"severity-3", "severity-5", "severity-7", "worst-3", "worst-5", "worst-7"});
  ExpectShown("severity-5.second", 0.640, 0.228);
  ExpectShown("severity-5.first", 0.153, 0.282);
  ExpectShown("pair-1.second", 0.145, 0.267);
  ExpectShown("pair-2.second", 0.176, 0.303);
  ExpectShown("pair-3.first", 0.157, 0.300);
  EXPECT_EQ(Figure("diversity-5.first.failures"), 250.0);
}

TEST_F(ThesisStudy, EvolvedCoursesStarveTheNestAndTheImprovedControllerStandsThemBetter) {
  Run("thesis-foraging");
  ExpectHolds({"vp-severity", "vp-worst", "vp-pair-1", "condition-1", "condition-2"});
  ExpectShown("vp-severity.second", 4.830, 1.505);
  ExpectShown("vp-severity.first", 1.270, 1.309);
  ExpectShown("vp-pair-1.second", 2.040, 1.601);
  ExpectShown("vp-pair-2.second", 1.580, 1.759);
  ExpectShown("vp-pair-3.first", 1.600, 1.723);
  EXPECT_EQ(Figure("condition-2.first.percent"), 35.0);
}

TEST_F(ThesisStudy, EvolvedCoursesStopTheRelayBugSStandsThemBetterAndConvergenceSuffers) {
  Run("thesis-partitioning");
  ExpectHolds({"sps-severity", "sps-worst", "sps-pair-1", "sps-pair-2", "failures"});
  ExpectShown("sps-severity.second", 4.560, 1.274);
  ExpectShown("sps-severity.first", 0.400, 0.899);
  ExpectShown("sps-pair-1.second", 3.000, 1.752);
  ExpectShown("sps-pair-2.second", 1.700, 1.744);
  ExpectShown("sps-pair-3.first", 1.640, 1.910);
  EXPECT_EQ(Figure("failures.first.percent"), 78.0);
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
