// What compare-controllers says of pairs of runs, and which it asks for.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "study/questions/question_table.h"
#include "tests/study/questions/answering.h"

namespace gauntlet {
namespace {

using Json = nlohmann::json;
using namespace testing_support;  // NOLINT(google-build-using-namespace)

Asking Ask(const Experiment& other, const std::string& on, int runs = 1) {
  Asking asking;
  asking.experiment = Flocking({"search.algorithm=cases", "search.replicates=" + std::to_string(runs)});
  asking.experiment.name = "mine";
  asking.other = other;
  asking.options["--on"] = {on};
  asking.quiet = true;
  return asking;
}

// With the improved flock, which fails where `fails_a` says so, against the plain one.
Json Compared(const Asking& asking, const std::function<bool(const std::string&)>& fails_a,
              const std::function<bool(const std::string&)>& fails_b) {
  const Question question = ControllerQuestion();
  const Call call = question.plan(asking).value();
  std::vector<CaseAnswer> answers;
  for (std::size_t side = 0; side < 2; ++side) {
    MemoryStore store;
    const std::vector<SearchPlan> plans = {call.searches[side]};
    const auto& fails = side == 0 ? fails_a : fails_b;
    Answer(
        plans, [&](const EvaluationRequest& request) { return Ended(fails(request.test_case.name)); }, store);
    auto of_side = AnswersIn(plans, store, "d", KeyOfCase).value();
    std::ranges::move(of_side, std::back_inserter(answers));
  }
  return Json::parse(question.tell(asking, call, answers).value().json);
}

Experiment Plain() {
  return Flocking({"search.algorithm=cases"});
}

bool Never(const std::string& /*name*/) {
  return false;
}

TEST(ControllerQuestion, GivesBothTheSameCasesAndSeeds) {
  const Call call = ControllerQuestion().plan(Ask(Plain(), "random:20")).value();
  ASSERT_EQ(call.searches.size(), 2U);
  EXPECT_EQ(call.searches[0].settings, "A: mine");
  EXPECT_EQ(call.searches[1].settings, "B: flocking");
  ASSERT_EQ(call.searches[0].cases.size(), 20U);
  for (std::size_t i = 0; i < 20; ++i) {
    const EvaluationRequest one{.individual = i + 1, .test_case = call.searches[0].cases[i]};
    const EvaluationRequest other{.individual = i + 1, .test_case = call.searches[1].cases[i]};
    EXPECT_EQ(RunSeed(call.searches[0].experiment, one, 0), RunSeed(call.searches[1].experiment, other, 0));
  }
}

TEST(ControllerQuestion, CallsBetterWhatFailsLessAndNamesWhatChanged) {
  const Json json = Compared(
      Ask(Plain(), "random:40"), [](const std::string& name) { return name == "random 40"; },
      [](const std::string& name) { return name < "random 2"; });
  EXPECT_EQ(json.at("better"), "mine");
  const Json& failure = json.at("failure");
  EXPECT_EQ(json.at("cases"), 40);
  EXPECT_EQ(failure.at("method"), "McNemar, exact");
  EXPECT_LT(failure.at("p"), 0.05);
  EXPECT_EQ(failure.at("mended").size(), 11U) << "random 1, random 10 to 19";
  ASSERT_EQ(failure.at("broken").size(), 1U);
  EXPECT_EQ(failure.at("broken")[0].at("case"), "random 40");
  EXPECT_EQ(failure.at("a").at("k"), 1);
  EXPECT_EQ(failure.at("a").at("n"), 40);
}

TEST(ControllerQuestion, CallsNeitherBetterWhereChanceMayHaveDoneIt) {
  const Json json = Compared(
      Ask(Plain(), "random:20"), [](const std::string& name) { return name == "random 7"; },
      [](const std::string& name) { return name == "random 8"; });
  EXPECT_TRUE(json.at("better").is_null());
  EXPECT_EQ(json.at("failure").at("p"), 1.0);
}

TEST(ControllerQuestion, OfSeveralRunsTheCaseIsTheUnit) {
  const Json json = Compared(Ask(Plain(), "random:12", 5), Never, [](const std::string&) { return true; });
  EXPECT_EQ(json.at("unit"), "case");
  EXPECT_EQ(json.at("failure").at("method"), "exchanged signs, exact");
  EXPECT_EQ(json.at("failure").at("difference"), -1.0);
  EXPECT_EQ(json.at("failure").at("mended")[0].at("runs_b"), 5);
}

TEST(ControllerQuestion, RefusesWhatIsNotAlike) {
  const auto refusal = [](const Experiment& other) {
    return ControllerQuestion().plan(Ask(other, "random:5")).error().message;
  };
  const Experiment foraging = LoadExperiment("foraging", {}, BuiltInCatalogue()).value();
  EXPECT_EQ(
      refusal(foraging),
      "scenario: A has flocking, B has foraging: the two are to do the same, so that their failures compare");
  EXPECT_EQ(refusal(Flocking({"arena.side=7"})),
            "A and B have different arenas, so no case is one of both: --set arena.KEY=VALUE is for both");
  Asking alone = Ask(Plain(), "random:5");
  alone.other.reset();
  EXPECT_EQ(ControllerQuestion().plan(alone).error().message,
            "which is the other controller? A second EXPERIMENT, or --set-b KEY=VALUE");
}

}  // namespace
}  // namespace gauntlet
