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

using testing::HasSubstr;

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
  EXPECT_THAT(again.out, HasSubstr("FAILS AGAIN"));
  EXPECT_THAT(again.out, HasSubstr("1 of 2 cases WORSE than expected"));
  EXPECT_THAT(ReadText(scratch_ / "check.xml"), HasSubstr("tests=\"2\" failures=\"1\" errors=\"0\""));
  const nlohmann::json json = CheckJson();
  EXPECT_EQ(json["failed"], 1);
  EXPECT_EQ(json["passed"], 1);

  const ProcessResult updated = Check({"--update"});
  EXPECT_EQ(updated.exit_code, 0) << updated.err;
  EXPECT_THAT(updated.out, HasSubstr("-expected: pass\n+expected: fail\n"));
  EXPECT_EQ(nlohmann::json::parse(ReadText(file_)), kept);
  EXPECT_EQ(CheckJson()["failed"], 0);
}

TEST_F(CheckTest, AnotherControllerIsCheckedAndTakenOver) {
  const std::vector<std::string> improved = {"--set", "controller=flocking-improved"};
  const ProcessResult result = Check(improved);
  EXPECT_THAT(result.out, HasSubstr("flocking-improved"));
  EXPECT_EQ(nlohmann::json::parse(ReadText(file_))["experiment"]["controller"], "flocking");
  const ProcessResult updated = Check({improved[0], improved[1], "--update"});
  EXPECT_THAT(updated.out, HasSubstr("+experiment.controller: flocking-improved\n"));
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

TEST_F(CheckTest, SaysWhatIsWrong) {
  const auto not_added = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"corpus", "add", dir_});
    const ProcessResult result = Gauntlet(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.out;
    return result.err;
  };
  EXPECT_THAT(not_added({failing_[0], "--to", corpus_}), HasSubstr("already: give this one another --name"));
  std::filesystem::rename(file_, corpus_ + "/mine.json");  // a case that is called otherwise than its file
  EXPECT_THAT(not_added({failing_[0], "--to", corpus_, "--name", "mine"}),
              HasSubstr("mine.json exists already"));
  std::filesystem::rename(corpus_ + "/mine.json", file_);
  EXPECT_THAT(not_added({"999999", "--to", corpus_}), HasSubstr("there is no run 999999"));
  EXPECT_THAT(not_added({failing_[0]}), HasSubstr("--to"));
  if (!harmless_.empty()) {
    EXPECT_THAT(not_added({harmless_.front(), "--to", corpus_}), HasSubstr("fails in at least half"));
  }

  EXPECT_THAT(Refused({"--set", "controller=foraging"}), HasSubstr("the corpus is for 'flocking'"));
  EXPECT_THAT(Refused({"--set", "controller_parameters.bird_sped=1"}), HasSubstr("bird_speed"));
  EXPECT_THAT(Refused({"--junit", scratch_ / "none/check.xml"}),
              HasSubstr("none/check.xml: cannot be written"));
  const std::string good = ReadText(file_);
  Replace(file_, "\"controller\": \"flocking\"", "\"controller\": \"flocking-improved\"");
  for (const char* ending : {".json", ".svg"})
    std::filesystem::remove(corpus_ + "/run-" + failing_[1] + ending);
  EXPECT_THAT(not_added({failing_[1], "--to", corpus_}),
              HasSubstr("holds cases of the controller 'flocking-improved'"));
  std::ofstream(file_) << good;
  ASSERT_EQ(Gauntlet({"corpus", "add", dir_, failing_[1], "--to", corpus_}).exit_code, 0);
  Replace(file_, "\"format\": 1", "\"format\": 9");
  EXPECT_THAT(Refused(), HasSubstr("newer version"));
  std::ofstream(file_) << good;
  Replace(file_, "\"obstacles\": [",
          "\"obstacles\": [{\"x\": 2.5, \"y\": 2.5, \"length\": 1, \"width\": 0.4},");
  EXPECT_THAT(Refused(), HasSubstr("breaks the rule"));
  std::filesystem::copy(corpus_ + "/run-" + failing_[1] + ".json", file_,
                        std::filesystem::copy_options::overwrite_existing);
  EXPECT_THAT(Refused(), HasSubstr("are both called"));
  EXPECT_THAT(Gauntlet({"check", scratch_ / "none"}).err, HasSubstr("no such folder"));
  EXPECT_THAT(Gauntlet({"check", dir_}).err, HasSubstr("is a campaign, no corpus"));
  EXPECT_THAT(Gauntlet({"check", file_}).err, HasSubstr("is a file: a corpus is a folder"));
  std::filesystem::create_directory(scratch_ / "empty");
  EXPECT_THAT(Gauntlet({"check", scratch_ / "empty"}).err, HasSubstr("holds no case"));
}

}  // namespace
}  // namespace gauntlet::testing_support
