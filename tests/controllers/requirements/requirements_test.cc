// The table [requirements] as a whole: what is required, what a failure is, what a run reports.
#include "controllers/requirements/requirements.h"

#include <gmock/gmock.h>

#include "tests/controllers/requirements/recorded_run.h"

namespace gauntlet::controllers::requirements {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing_support::RecordedRun;

Requirements Read(const std::string& text) {
  return Requirements::Parse(text, {{"items", "", {}, ""}}).value();
}
std::string WrongIn(const std::string& text) {
  const auto parsed = Requirements::Parse(text, {{"items", "", {}, ""}});
  return parsed ? "" : parsed.error().message;
}

// Four robots; after 20 s of 40 one of them is 2 m from the others, for 5 s.
const RecordedRun& Excursion() {
  static const RecordedRun run(4, 400, [](sim::Tick tick, int robot) {
    return sim::Vec2(robot == 3 && tick >= 200 && tick < 250 ? 2.5 : 0.25 * robot, 0.0);
  });
  return run;
}

TEST(RequirementsTest, ARunFailsWhenOneThatNoOtherUsesDoesNotHold) {
  const Judgement judgement = Read(
                                  "there = count(distance_to(start) < 4) >= 4\n"
                                  "back = always (there or eventually[0,10] there)\n"
                                  "near = always greatest(distance_to(0, 0)) < 2\n")
                                  .Judge(Excursion().trace(), {});
  EXPECT_TRUE(judgement.failed);
  EXPECT_THAT(judgement.metrics,
              ElementsAre(Pair("robustness", testing::DoubleEq(-0.5 / std::sqrt(2 * 5.9 * 5.9))),
                          Pair("robustness.back", 0.0), Pair("robustness.near", testing::Lt(0.0)),
                          Pair("violated_at.back", kNotMeasured), Pair("violated_at.near", 20.0)));
  ASSERT_EQ(judgement.annotations.size(), 1U);
  EXPECT_EQ(judgement.annotations[0].label, "near: greatest(distance_to(0, 0)) < 2");
  EXPECT_EQ(judgement.annotations[0].tick, 200);
}

TEST(RequirementsTest, OrAsFailureSays) {
  const std::string text =
      "near = always greatest(distance_to(0, 0)) < 2\nfailure = not near and items < 3\n";
  const std::vector<std::pair<std::string, double>> many = {{"items", 4.0}};
  const std::vector<std::pair<std::string, double>> few = {{"items", 2.0}};
  EXPECT_FALSE(Read(text).Judge(Excursion().trace(), many).failed);
  const Judgement judgement = Read(text).Judge(Excursion().trace(), few);
  EXPECT_TRUE(judgement.failed);
  EXPECT_LT(judgement.metrics[0].second, 0.0) << "robustness is that of not failing";
}

TEST(RequirementsTest, LooksAtEveryTickWhenAsked) {
  const RecordedRun jump(1, 40, [](sim::Tick tick, int) { return sim::Vec2(tick == 15 ? 2.0 : 0.0, 0.0); });
  EXPECT_FALSE(Read("still = always greatest(x) < 1\n").Judge(jump.trace(), {}).failed);
  const Judgement judgement = Read("step = tick\nstill = always greatest(x) < 1\n").Judge(jump.trace(), {});
  EXPECT_TRUE(judgement.failed);
  EXPECT_EQ(judgement.metrics.back().second, 1.5);
}

TEST(RequirementsTest, DeclaresWhatItReports) {
  const Requirements requirements = Read("a = time > 1\nb = time > 2\nfailure = not a\n");
  std::vector<std::string> declared;
  for (const MetricInfo& info : requirements.Metrics()) declared.push_back(info.name);
  std::vector<std::string> reported;
  for (const auto& [name, value] : requirements.Judge(Excursion().trace(), {}).metrics)
    reported.push_back(name);
  EXPECT_EQ(declared, reported);
  EXPECT_THAT(declared,
              ElementsAre("robustness", "robustness.a", "robustness.b", "violated_at.a", "violated_at.b"));
}

TEST(RequirementsTest, NeedsSomethingThatCanBeViolated) {
  EXPECT_THAT(WrongIn("near = count(x > 1)\n"), HasSubstr("no sentence that could be violated"));
  EXPECT_EQ(WrongIn("near = count(x > 1)\nfailure = near < 2\n"), "");
}

TEST(RequirementsTest, SaysWhichEntryIsWrong) {
  EXPECT_EQ(WrongIn("stay = tim > 1\n"),
            "requirements.stay = \"tim > 1\": character 1: unknown measure 'tim'; did you mean 'time'?");
  EXPECT_THAT(WrongIn("Stay = time > 1\n"), HasSubstr("a name is of up to 40 small letters"));
  EXPECT_THAT(WrongIn("always = time > 1\n"), HasSubstr("no word of the language"));
  EXPECT_THAT(WrongIn("speed = time > 1\n"), HasSubstr("this is the name of a measure"));
  EXPECT_THAT(WrongIn("step = hour\n"), HasSubstr("give second or tick"));
  EXPECT_THAT(WrongIn("step = tick\na = clusters(1) > 1\n"), HasSubstr("'clusters' is measured each second"));
  EXPECT_THAT(WrongIn("a = always[0.2,0.8] time > 1\n"),
              HasSubstr("no whole second lies in the window [0.2,0.8]"));
  EXPECT_EQ(WrongIn("step = tick\na = always[0.2,0.8] time > 1\n"), "");
  EXPECT_THAT(WrongIn("a = b > 1\nb = time\n"), HasSubstr("unknown measure 'b'")) << "b stands below";
  EXPECT_THAT(WrongIn("failure = time\n"), HasSubstr("compare it"));
  std::string many;
  for (int i = 0; i <= 100; ++i) many += "s" + std::to_string(i) + " = time > 1\n";
  EXPECT_THAT(WrongIn(many), HasSubstr("there may be 100 sentences"));
}

TEST(RequirementsTest, TellsWhichWindowsReachBeyondARun) {
  const Requirements requirements =
      Read("a = always[0,700] time < 1\nb = time < 1 until[0,600] time > 1\nc = eventually time > 1\n");
  EXPECT_THAT(requirements.BeyondTheRun(600.0),
              ElementsAre(HasSubstr("the window [0,700] reaches beyond a run, "
                                    "which lasts 600 s at the longest")));
  EXPECT_EQ(requirements.BeyondTheRun(500.0).size(), 2U);
}

}  // namespace
}  // namespace gauntlet::controllers::requirements
