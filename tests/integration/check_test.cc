// gauntlet corpus and gauntlet check with real processes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "tests/integration/campaign_driver.h"
#include "tests/integration/question_drill.h"

namespace gauntlet::testing_support {
namespace {

std::string ReadText(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

void Replace(const std::string& file, const std::string& what, const std::string& with) {
  std::string text = ReadText(file);
  const auto at = text.find(what);
  ASSERT_NE(at, std::string::npos) << what << " in " << text;
  std::ofstream(file) << text.replace(at, what.size(), with);
}

// A campaign whose cases were confirmed, and a corpus of two of them that fail in every run.
class CheckTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(Gauntlet({"random", "flocking", "--cases", "60", "--dir", dir_, "--quiet"}).exit_code, 0);
    const ProcessResult confirmed = Gauntlet({"confirm", dir_, "--all-failing", "--json", "--quiet"});
    ASSERT_EQ(confirmed.exit_code, 0) << confirmed.err;
    const nlohmann::json known = nlohmann::json::parse(confirmed.out);
    for (const nlohmann::json& one : known["cases"]) {
      const std::string run = one["run"].dump();
      (one["k"] == one["n"] ? failing_ : one["k"] == 0 ? harmless_ : flaky_).push_back(run);
    }
    ASSERT_GE(failing_.size(), 2U);
    const ProcessResult added = Gauntlet({"corpus", "add", dir_, failing_[0], failing_[1], "--to", corpus_});
    ASSERT_EQ(added.exit_code, 0) << added.err;
    file_ = corpus_ + "/run-" + failing_[0] + ".json";
  }

  ProcessResult Check(std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"check", corpus_, "--quiet"});
    return Gauntlet(more);
  }
  nlohmann::json CheckJson() const {
    const ProcessResult result = Check({"--json"});
    EXPECT_LE(result.exit_code, 1) << result.err;
    return nlohmann::json::parse(result.out);
  }
  std::string Refused(const std::vector<std::string>& more = {}) const {
    const ProcessResult result = Check(more);
    EXPECT_EQ(result.exit_code, 2) << result.out << result.err;
    EXPECT_EQ(result.out, "");
    return result.err;
  }

  const TemporaryDirectory scratch_;
  const std::string dir_ = scratch_ / "found";
  const std::string corpus_ = scratch_ / "corpus";
  std::vector<std::string> failing_, harmless_, flaky_;
  std::string file_;  // of its first case
};

TEST_F(CheckTest, FindsWhatFailsAgainAndUpdatesWhatIsExpected) {
  EXPECT_TRUE(std::filesystem::exists(corpus_ + "/run-" + failing_[0] + ".svg"));
  const nlohmann::json kept = nlohmann::json::parse(ReadText(file_));
  EXPECT_EQ(kept["expected"], "fail");
  EXPECT_EQ(kept["found"]["k"], kept["found"]["n"]);
  const ProcessResult known = Check();
  EXPECT_EQ(known.exit_code, 0) << known.out;

  Replace(file_, "\"expected\": \"fail\"", "\"expected\": \"pass\"");  // somebody says it is mended
  const ProcessResult again = Check({"--junit", scratch_ / "check.xml"});
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_EQ(ReadText(scratch_ / "check.xml"),
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<testsuites>\n"
            "<testsuite name=\"flocking.flocking\" tests=\"2\" failures=\"1\" errors=\"0\">\n"
            "<testcase classname=\"flocking.flocking\" name=\"run-23\"/>\n"
            "<testcase classname=\"flocking.flocking\" name=\"run-4\"><failure message=\"fails in 5 of 7 "
            "runs with fresh seeds, expected: pass\">" +
                (scratch_ / "corpus/run-4.json") +
                "</failure></testcase>\n"
                "</testsuite>\n"
                "</testsuites>\n");
  const nlohmann::json json = CheckJson();
  EXPECT_EQ(json["failed"], 1);
  EXPECT_EQ(json["passed"], 1);

  const ProcessResult updated = Check({"--update"});
  EXPECT_EQ(updated.exit_code, 0) << updated.err;
  EXPECT_EQ(nlohmann::json::parse(ReadText(file_)), kept);
  EXPECT_EQ(CheckJson()["failed"], 0);
}

TEST_F(CheckTest, AnotherControllerIsCheckedAndTakenOver) {
  const std::vector<std::string> improved = {"--set", "controller=flocking-improved"};
  const ProcessResult result = Check(improved);
  EXPECT_EQ(result.out,
            (scratch_ / "corpus") +
                ": flocking with the controller flocking-improved\n"
                "\n"
                "  case    expected  failed  probability (95 %)  now\n"
                "  run-23  fail      0 of 6    0 to  39 %        pass   better\n"
                "  run-4   fail      2 of 8    7 to  59 %        flaky  better\n"
                "\n"
                "2 of 2 cases as expected or better; 2 better: --update expects that from now on.\n");
  EXPECT_EQ(nlohmann::json::parse(ReadText(file_))["experiment"]["controller"], "flocking");
  const ProcessResult updated = Check({improved[0], improved[1], "--update"});
  EXPECT_EQ(CheckJson()["controller"], "flocking-improved");
  EXPECT_EQ(CheckJson()["failed"], 0);
}

TEST_F(CheckTest, EndsAsUndisturbedWhenItIsKilled) {
  const nlohmann::json whole = CheckJson();
  const std::vector<std::string> hashes = StateHashesIn(corpus_ + "/.check");
  std::filesystem::remove_all(corpus_ + "/.check");
  AskThroughKills({"check", corpus_, "--workers", "1", "--quiet"}, corpus_ + "/.check", 3);
  EXPECT_EQ(CheckJson(), whole);
  EXPECT_EQ(StateHashesIn(corpus_ + "/.check"), hashes);
}

}  // namespace
}  // namespace gauntlet::testing_support
