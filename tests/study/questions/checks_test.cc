// Whether the cases of a corpus still fail, held against what their files expect.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

#include "search/cases/corpus_file.h"
#include "study/questions/corpus_experiment.h"
#include "study/questions/question_table.h"
#include "tests/study/questions/answering.h"
#include "tests/support/process.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;
using namespace testing_support;  // NOLINT(google-build-using-namespace)

// Three cases, which are expected to fail, to pass and to fail: the first does, the second fails again, the
// third is better.
class ChecksTest : public testing::Test {
 protected:
  void SetUp() override {
    for (std::size_t walls = 1; walls <= 3; ++walls) {
      CorpusCase one;
      one.name = "case-" + std::to_string(walls);
      one.expected = walls == 2 ? "pass" : "fail";
      one.settings = SettingsOf(Flocking());
      one.document.test_case = Walls(walls);
      for (sim::ObstacleGene& wall : one.document.test_case.obstacles) wall.y = 1.0;
      std::ofstream(corpus_ / (one.name + ".json")) << WriteCorpusCase(one);
    }
  }

  Told Check(Asking asking) {
    asking.place = corpus_.path();
    Call call = PlanCall(CheckQuestion(), asking).value();
    MemoryStore store;
    Answer(
        call.searches, [](const auto& request) { return Ended(request.individual < 3); }, store);
    const auto stored = AnswersIn(call.searches, store, call.directory, KeyOfCase).value();
    for (std::size_t i = 0; i < stored.size(); ++i) call.cases[i].runs = stored[i].runs;
    call.directory = "c/.check/1";
    return CheckQuestion().tell(asking, call, call.cases).value();
  }

  const TemporaryDirectory corpus_;
};

TEST_F(ChecksTest, SaysWhatIsWorseAndHowToSeeIt) {
  const Told told = Check({});
  EXPECT_EQ(ToText(told.section),
            "  " + corpus_.path() +
                ": flocking with the controller flocking\n"
                "  case    expected  failed  probability (95 %)  now\n"
                "  case-1  fail      5 of 5   57 to 100 %        fail\n"
                "  case-2  pass      5 of 5   57 to 100 %        fail  FAILS AGAIN\n"
                "  case-3  fail      0 of 6    0 to  39 %        pass  better\n"
                "  1 of 3 cases WORSE than expected; 1 better: --update expects that from now on.\n"
                "  gauntlet replay c/.check/1 6 --svg case-2.svg  # see what happened\n");
  EXPECT_EQ(told.conclusion, Conclusion::kNegative);
  const auto json = nlohmann::json::parse(told.json);
  EXPECT_EQ(json.at("failed"), 1);
  EXPECT_EQ(json.at("cases").at(2).at("outcome"), "better");
}

TEST_F(ChecksTest, TellsMachinesThatRunTests) {
  EXPECT_EQ(
      Check({}).outputs.at("--junit"),
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuites>\n"
      "<testsuite name=\"flocking.flocking\" tests=\"3\" failures=\"1\" errors=\"0\">\n"
      "<testcase classname=\"flocking.flocking\" name=\"case-1\"/>\n"
      "<testcase classname=\"flocking.flocking\" name=\"case-2\"><failure message=\"fails in 5 of 5 runs "
      "with fresh seeds, expected: pass\">" +
          (corpus_ / "case-2.json") +
          "</failure></testcase>\n"
          "<testcase classname=\"flocking.flocking\" name=\"case-3\"/>\n"
          "</testsuite>\n"
          "</testsuites>\n");
}

TEST_F(ChecksTest, WritesWhatWasSeenIntoTheFilesThatExpectedSomethingElse) {
  const Told told = Check({.options = {{"--update", {}}}});
  EXPECT_EQ(told.conclusion, Conclusion::kDone);
  EXPECT_THAT(told.messages, ElementsAre("2 of 3 files changed"));
  ASSERT_EQ(told.files.size(), 2U);
  EXPECT_TRUE(told.files[0].replaces);
  EXPECT_EQ(ParseCorpusCase(told.files[0].content, "case-2").value().expected, "fail");
  const std::string file = corpus_ / "case-3.json";
  EXPECT_THAT(told.details,
              testing::EndsWith("--- " + file + "\n+++ " + file + "\n-expected: fail\n+expected: pass\n"));
}

TEST_F(ChecksTest, ItsSeedsAreThoseOfNoOtherQuestion) {
  const Asking asking{.place = corpus_.path()};
  const Call call = PlanCall(CheckQuestion(), asking).value();
  EXPECT_TRUE(call.anew);
  ASSERT_EQ(call.searches.size(), 1U);
  EXPECT_EQ(RowOf(call.searches[0].experiment).purpose, sim::SeedPurpose::kCheck);
}

}  // namespace
}  // namespace gauntlet
