// Covers: search/repair/repair_search.cc
#include "study/repairs/repair_result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "sim/random/random_stream.h"
#include "tests/study/repairs/repaired_swarm.h"

namespace gauntlet {
namespace {

using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
using testing_support::RepairedSwarm;

std::vector<std::string> SentencesOf(const Repair& repair) {
  return TellRepair(repair, "dir", "gauntlet").front().sentences;
}

TEST(RepairResult, NamesTheParameterThatIsAtFaultAndProvesIt) {
  const Repair repair = RepairedSwarm(testing_support::FactorIsAtFault);
  ASSERT_TRUE(repair.finished);
  EXPECT_TRUE(IsMended(repair));
  const RepairChange change = ChangeInHeldOut(repair).value();
  EXPECT_EQ(change.cases, 12U);
  EXPECT_EQ(change.before, 1.0);
  EXPECT_EQ(change.after, 0.0);
  EXPECT_GT(change.less_interval.low, 0.5);
  EXPECT_EQ(ChangeInRandom(repair)->less, 0.0);
  const std::vector<std::string> sentences = SentencesOf(repair);
  EXPECT_EQ(
      sentences[0],
      "Mended: of held-out runs 0.0 % fail with the repaired parameters, 100.0 % with the original ones.");
  EXPECT_THAT(sentences[1], StartsWith("turning_speed_factor: 0.5 to "));
  EXPECT_THAT(sentences[1],
              HasSubstr("alone mends 12 of 12 held-out cases; no other parameter alone mends more than 0."));
  const std::vector<RepairedKey> keys = KeysOf(repair);
  EXPECT_EQ(keys[0].mended_alone, 12);
  EXPECT_EQ(keys[0].failing_without, 1.0);
  EXPECT_THAT(keys[0].flags, Not(Contains("without effect")));
  EXPECT_THAT(keys[1].flags, Contains("without effect"));
}

TEST(RepairResult, SaysWhereNoParameterMendsAnything) {
  const Repair repair = RepairedSwarm([](double, double, std::size_t of_case) { return of_case % 4 != 0; });
  EXPECT_FALSE(IsMended(repair));
  EXPECT_THAT(OutcomeOf(repair),
              StartsWith("Not mended by its parameters: no settings that were tried fail less"));
  EXPECT_THAT(SentencesOf(repair), Contains("No parameter alone mends a held-out case."));
  EXPECT_THAT(SentencesOf(repair), Contains(HasSubstr("which need other rules: case 25, case 26, case 27")));
}

TEST(RepairResult, SaysWhereOneParameterDoesBetterThanTheRepair) {
  const Repair repair = RepairedSwarm([](double factor, double rate, std::size_t of_case) {
    if (of_case >= 2 * testing_support::kTrainingCases) return factor < 0.9;
    return of_case < testing_support::kTrainingCases && rate < 1.5 && (factor < 0.9 || of_case % 2 == 0);
  });
  EXPECT_FALSE(IsMended(repair));
  EXPECT_THAT(OutcomeOf(repair),
              StartsWith("Not mended by its parameters: held-out failures are fewer by 0.0 %"));
  EXPECT_THAT(OutcomeOf(repair), EndsWith("One of them alone does better, which fresh cases have to judge."));
}

TEST(RepairResult, WhatDoesNotFailIsNotRepaired) {
  const Repair repair = RepairedSwarm([](double, double, std::size_t) { return false; });
  ASSERT_TRUE(repair.finished);
  EXPECT_FALSE(IsMended(repair));
  EXPECT_EQ(OutcomeOf(repair), "Nothing to repair: the controller does not fail in the training cases.");
  EXPECT_EQ(repair.course().generations(), 0U);
}

TEST(RepairResult, NothingWorseThanTheOriginalIsRecommended) {
  const Repair repair = RepairedSwarm([](double factor, double rate, std::size_t of_case) {
    return of_case == 0 || factor != 0.5 || rate < 0.78 || rate > 0.79;
  });
  ASSERT_TRUE(repair.finished);
  EXPECT_EQ(repair.course().repaired(), RepairCourse::kOriginal);
}

TEST(RepairResult, ChanceMendsNothing) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    sim::RandomStream random(seed, sim::StreamPurpose::kVariation);
    const Repair repair = RepairedSwarm([&](double, double, std::size_t) { return random.Chance(0.8); });
    EXPECT_FALSE(IsMended(repair)) << "seed " << seed << ": " << OutcomeOf(repair);
  }
}

TEST(RepairResult, WarnsOfWhatTrainingAloneHasGained) {
  const Repair repair = RepairedSwarm([](double factor, double rate, std::size_t of_case) {
    return of_case < testing_support::kTrainingCases ? factor < 0.7 : of_case % 2 == 0 || rate < 0.01;
  });
  EXPECT_THAT(
      SentencesOf(repair),
      Contains("Overfitted: failures are fewer by 100.0 % in training cases and by 0.0 % in held-out ones."));
}

TEST(RepairResult, WarnsWhereItFailsLessByDoingLess) {
  const auto guarded = [](std::size_t of_case) { return of_case >= testing_support::kTrainingCases; };
  const Repair repair = RepairedSwarm(testing_support::FactorIsAtFault,
                                      [&](double factor, double, std::size_t of_case) -> RunOutcome {
                                        const bool faster = factor > 0.6 && guarded(of_case);
                                        RunOutcome run{.fitness = faster ? 0.5 : 1.0};
                                        run.effects = {.contacts = faster ? 2.1 : 2.0};
                                        return run;
                                      });
  EXPECT_THAT(SentencesOf(repair), Contains(StartsWith("In random cases it fails less and yet does less")));
}

TEST(RepairResult, AParameterThatHelpsAloneMayBeMadeUpForByOthers) {
  const std::vector<RepairedKey> keys =
      KeysOf(RepairedSwarm([](double factor, double rate, std::size_t of_case) {
        return testing_support::FactorIsAtFault(factor, rate, of_case) && rate < 1.5;
      }));
  EXPECT_GE(NumberOf(keys[0].repaired), 0.7);
  EXPECT_LT(NumberOf(keys[1].repaired), 1.5);
  EXPECT_EQ(keys[1].mended_alone, 12);
  EXPECT_THAT(keys[1].flags, Contains("made up for by others"));
  EXPECT_THAT(keys[0].flags, Not(Contains("made up for by others")));
}

TEST(RepairResult, TheExperimentHasTheRepairedParameters) {
  const Repair repair = RepairedSwarm(testing_support::FactorIsAtFault);
  const Experiment repaired =
      ParseExperiment(RepairedToml(repair, "dir"), "repaired.toml", {}, BuiltInCatalogue()).value();
  EXPECT_EQ(repaired.name, "toy-repaired");
  EXPECT_EQ(repaired.search.algorithm, "genetic");
  EXPECT_EQ(repaired.controller_parameters.at("turning_speed_factor"), NumberOf(KeysOf(repair)[0].repaired));
}

TEST(RepairResult, ProgramsAreToldTheSame) {
  const auto json = nlohmann::json::parse(RepairJson(RepairedSwarm(testing_support::FactorIsAtFault), "dir"));
  EXPECT_EQ(json["mended"], true);
  EXPECT_EQ(json["changes"][0]["cases"], "held out");
  EXPECT_EQ(json["changes"][0]["after"], 0.0);
  EXPECT_EQ(json["parameters"][0]["mended_alone"], 12);
  EXPECT_EQ(json["side_effects"][0]["before"], 2.0);
  EXPECT_THAT(json["never_mended"], IsEmpty());
}

}  // namespace
}  // namespace gauntlet
