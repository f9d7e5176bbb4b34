// Covers: cli/output/summary_json.cc, cli/output/summary_text.cc, master/campaign/verdict_text.cc
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/output/summary.h"
#include "master/campaign/verdict_text.h"
#include "tests/support/golden.h"

namespace gauntlet {
namespace {

using Json = nlohmann::json;

MeanAndRange FitnessOf(std::initializer_list<double> values) {
  MeanAndRange fitness;
  for (const double value : values) fitness.Add(value);
  return fitness;
}

CampaignSummary CampaignOf(const SearchSummary& search) {
  CampaignSummary summary;
  static_cast<SearchTally&>(summary) = search;
  summary.experiment = "flocking";
  summary.searches = {search};
  return summary;
}

SearchSummary EvolvedSearch() {
  SearchSummary summary;
  summary.search = "genetic";
  summary.seed = 18446744073709551615U;
  summary.progress = {50, 50, 1000, 1000, 0, true};
  summary.runs_done = 1000;
  summary.runs_failed = 0;
  summary.distinct_individuals = 372;
  summary.fitness = FitnessOf({0.0, 0.0045, 0.633});
  summary.total_failures = summary.failing_runs = 231;
  for (int type = 0; type < 20; ++type)
    summary.types.types.push_back({type, type == 12 ? "slowly apart" : "apart"});
  summary.runs_of_type = {{3, 30}, {12, 200}};
  summary.untyped_failures = 1;
  summary.types.untyped = "without a split";
  summary.statistics = {{"clone_rate", 0.61}};
  for (std::uint32_t g = 1; g <= 50; ++g)
    summary.generations.push_back({g, 20, g, FitnessOf({0.3 - 0.006 * g, 0.3 + 0.006 * g, 0.9})});
  summary.population = {{17, {3, 9}, 5, 0.25, {{1.0, 2.0, 0.5, 0.2, 30.0}}, {80, 812}},
                        {18, {}, 1, 0.0, {{1.5, 2.0, 0.5, 0.2, 31.0}, {0, 0, 1, 0.1, 0}}, {81, 813}},
                        {19, {}, 1, std::numeric_limits<double>::infinity(), {}, {82}}};
  summary.state_hash = "00ff00ff00ff00ff";
  summary.finished = true;
  return summary;
}

CampaignSummary Evolved() {
  return CampaignOf(EvolvedSearch());
}

TEST(SummaryText, GivenCasesAreNamedByTheirFiles) {
  CampaignSummary summary = Evolved();
  summary.searches[0].population[0].name = "three-walls.json";
  testing_support::ExpectGolden("tests/cli/texts/summary_given_cases_are_named_by_their_files.txt",
                                SummaryText(summary, {}, {"gauntlet", "d"}));
  EXPECT_EQ(Json::parse(SummaryJson(summary, {}, "d")).at("population").at(0).at("name"), "three-walls.json");
}

TEST(SummaryJson, HasTheKeysOfTheContract) {
  const Json json = Json::parse(SummaryJson(Evolved(), {}, "campaigns/x"));
  EXPECT_EQ(json.at("experiment"), "flocking");
  EXPECT_EQ(json.at("search"), "genetic");
  EXPECT_EQ(json.at("generation"), 50);
  EXPECT_EQ(json.at("runs_done"), 1000);
  EXPECT_EQ(json.at("runs_failed"), 0);
  EXPECT_EQ(json.at("distinct_individuals"), 372);
  EXPECT_EQ(json.at("best_fitness"), 0.0);
  EXPECT_EQ(json.at("mean_fitness"), 0.2125);
  EXPECT_EQ(json.at("total_failures"), 231);
  EXPECT_EQ(json.at("finished"), true);
  EXPECT_EQ(json.at("failure_types").size(), 20U);
  EXPECT_EQ(json.at("failure_types")[12], Json({{"type", 12}, {"name", "slowly apart"}, {"runs", 200}}));
  EXPECT_EQ(json.at("failure_types")[0].at("runs"), 0);
  EXPECT_EQ(json.at("unclassified_failures"), 1);
  EXPECT_EQ(json.at("history").size(), 50U);
  const Json& member = json.at("population").at(0);
  EXPECT_EQ(member.at("id"), 17);
  EXPECT_EQ(member.at("fitness"), 0.25);
  EXPECT_EQ(member.at("runs"), Json({80, 812}));
  EXPECT_EQ(member.at("genome").at(0),
            Json({{"x", 1.0}, {"y", 2.0}, {"length", 0.5}, {"width", 0.2}, {"orientationDeg", 30.0}}));
}

TEST(SummaryJson, SeedsAndHashesAreStrings) {
  const Json json = Json::parse(SummaryJson(Evolved(), {}, "campaigns/x"));
  EXPECT_EQ(json.at("seed"), "18446744073709551615");
  EXPECT_EQ(json.at("state_hash"), "00ff00ff00ff00ff");
}

TEST(SummaryJson, IdsThatReadersWouldRoundAreStrings) {
  CampaignSummary summary = Evolved();
  summary.searches[0].population[0].runs = {1ULL << 53, (1ULL << 53) + 1};
  const Json runs = Json::parse(SummaryJson(summary, {}, "d")).at("population").at(0).at("runs");
  EXPECT_EQ(runs.at(0), 9007199254740992U);
  EXPECT_EQ(runs.at(1), "9007199254740993");
}

TEST(SummaryJson, AFitnessThatDoesNotExistIsNull) {
  CampaignSummary summary = Evolved();
  summary.searches[0].fitness = {};
  const Json json = Json::parse(SummaryJson(summary, {}, "d"));
  EXPECT_TRUE(json.at("best_fitness").is_null());
  EXPECT_TRUE(json.at("mean_fitness").is_null());
  EXPECT_TRUE(json.at("population").at(2).at("fitness").is_null());
}

TEST(SummaryText, EndsWithCommandsOnTheToughestCase) {
  const std::string text = SummaryText(Evolved(), {}, {"gauntlet", "campaigns/my runs"});
  testing_support::ExpectGolden("tests/cli/texts/summary_ends_with_commands_on_the_toughest_case.txt", text);

  const std::size_t hints = text.find("Next commands to try");
  ASSERT_NE(hints, std::string::npos);
  EXPECT_EQ(
      text.substr(hints),
      "Next commands to try\n"
      "  gauntlet replay 'campaigns/my runs' 813 --svg case-18.svg           # see what happened in the "
      "toughest case\n"
      "  gauntlet confirm 'campaigns/my runs' --all-failing --replicates 20  # how many different failures "
      "are "
      "these?\n"
      "  gauntlet show 'campaigns/my runs' --json                            # everything, for scripts\n");
}

TEST(SummaryText, SpeaksOfNoFailureTypesWhereTheScenarioHasNone) {
  CampaignSummary summary = Evolved();
  summary.searches[0].types.types.clear();
  testing_support::ExpectGolden(
      "tests/cli/texts/summary_speaks_of_no_failure_types_where_the_scenario_has_none.txt",
      SummaryText(summary, {}, {"gauntlet", "d"}));
}

TEST(TypesText, TellsEveryTypeAndWhatHasNone) {
  SearchSummary search = EvolvedSearch();
  search.types.types.resize(4);
  search.types.note = "Types do not tell failures apart.";
  EXPECT_EQ(TypesText(CampaignOf(search)),
            "  type  total failure  runs\n"
            "     0  apart             0\n"
            "     1  apart             0\n"
            "     2  apart             0\n"
            "     3  apart            30\n"
            "  and 1 total failures without a split\n"
            "  Types do not tell failures apart.\n");
  search.types = {};
  search.untyped_failures = 0;
  EXPECT_EQ(TypesText(CampaignOf(search)), "  Its scenario tells no types of failures apart.\n");
}

TEST(SummaryText, ToughestCaseStandsFirstAndCasesWithoutFitnessAreLeftOut) {
  const std::string text = SummaryText(Evolved(), {}, {"gauntlet", "d"});
  const std::size_t tough = text.find("\n         18    0.000");
  const std::size_t next = text.find("\n         17    0.250");
  EXPECT_NE(tough, std::string::npos) << text;
  EXPECT_NE(next, std::string::npos) << text;
  EXPECT_LT(tough, next);
}

TEST(SummaryText, ShowsFirstAndLastAndAtMostTwelveGenerations) {
  const std::string text = SummaryText(Evolved(), {}, {"gauntlet", "d"});
  const std::size_t begin = text.find("  generation  runs");
  ASSERT_NE(begin, std::string::npos) << text;
  const std::string table = text.substr(begin, text.find("\n\n", begin) - begin);
  testing_support::ExpectGolden(
      "tests/cli/texts/summary_shows_first_and_last_and_at_most_twelve_generations.txt", table);

  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 12);
}

TEST(SummaryText, UnfinishedCampaignOffersToResume) {
  CampaignSummary summary = Evolved();
  summary.finished = false;
  testing_support::ExpectGolden("tests/cli/texts/summary_unfinished_campaign_offers_to_resume.txt",
                                SummaryText(summary, {}, {"./dev run", "d"}));
}

TEST(SummaryText, AnEmptyCampaignIsNoProblem) {
  SearchSummary search;
  search.search = "random";
  const std::string text = SummaryText(CampaignOf(search), {}, {"gauntlet", "d"});
  testing_support::ExpectGolden("tests/cli/texts/summary_an_empty_campaign_is_no_problem.txt", text);
}

TEST(SummaryText, OfAProgramItIsSaidWhetherItIsReproducible) {
  CampaignSummary summary = Evolved();
  EXPECT_THAT(SummaryText(summary, {}, {"gauntlet", "d"}), Not(HasSubstr("reproducible")));
  EXPECT_FALSE(Json::parse(SummaryJson(summary, {}, "d")).contains("reproducible"));
  summary.reproducibility = {Reproducible::kYes, "hosts a, b"};
  EXPECT_THAT(SummaryText(summary, {}, {"gauntlet", "d"}),
              HasSubstr("\n  reproducible    yes (hosts a, b)\n"));
  const Json json = Json::parse(SummaryJson(summary, {}, "d"));
  EXPECT_EQ(json.at("reproducible"), "yes");
  EXPECT_EQ(json.at("reproducible_hosts"), Json({"a", "b"}));
  EXPECT_EQ(json.at("nondeterministic"), false);
  summary.reproducibility = {Reproducible::kUnknown, ""};
  EXPECT_EQ(Json::parse(SummaryJson(summary, {}, "d")).at("reproducible"), "unknown");
}

TEST(SummaryText, NondeterminismIsShouted) {
  CampaignSummary summary = Evolved();
  summary.nondeterministic = 1;
  testing_support::ExpectGolden("tests/cli/texts/summary_nondeterminism_is_shouted.txt",
                                SummaryText(summary, {}, {"gauntlet", "d"}));
  summary.plugin_controllers = {"mine"};
  testing_support::ExpectGolden("tests/cli/texts/summary_nondeterminism_is_shouted_2.txt",
                                SummaryText(summary, {}, {"gauntlet", "d"}));
}

TEST(RuleOf, TakesTheNameInFrontOfTheColon) {
  EXPECT_EQ(RuleOf("no-room-to-spawn: 3 of 10 robots placed"), "no-room-to-spawn");
  EXPECT_EQ(RuleOf("The thing: broke"), "");
  EXPECT_EQ(RuleOf("nothing"), "");
}

}  // namespace
}  // namespace gauntlet
