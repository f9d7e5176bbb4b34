// Whatever is wrong with an experiment is refused with its place, its value and what would be right.
// Covers: base/key.cc, search/experiment/key_assignment.cc, search/experiment/toml_text.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/search/experiment/toy_catalogue.h"

namespace gauntlet {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr std::string_view kMarching = "scenario = 'marching'\n";

constexpr const char* kTop =
    "known: name, description, seed, scenario, controller, physics, faults, arena.*, genome.*, search.*, "
    "fit.*, "
    "margin.*, repair.*, probability.*, random_faults.*, noise.*, store.*, plugin, scenario_plugin, "
    "scenario_parameters.*, controller_parameters.*, plugins, conditions.*, requirements.*, generic.*, "
    "command.*";

std::string Marching(std::string_view more) {
  return std::string(kMarching) + std::string(more);
}

TEST(ExperimentErrorsTest, UnknownKeysComeWithTheNearestKnownOne) {
  EXPECT_EQ(ErrorOf(Marching("[search]\npopultion = 3\n")),
            "toy.toml:3:1: unknown key 'search.popultion'; did you mean 'search.population'?");
  EXPECT_EQ(ErrorOf(Marching("[serach]\ngenerations = 3\n")),
            "toy.toml:3:1: unknown key 'serach.generations'; did you mean 'search.generations'?");
  EXPECT_EQ(ErrorOf(Marching("[controller_parameters]\nsped = 0.1\n")),
            "toy.toml:3:1: unknown key 'controller_parameters.sped'; did you mean "
            "'controller_parameters.speed'?");
  EXPECT_EQ(ErrorOf(Marching("population = 4\n")),
            "toy.toml:2:1: unknown key 'population'; did you mean 'search.population'?");
  EXPECT_EQ(ErrorOf(Marching("[controller_parameters]\nquux = 0.1\n")),
            "toy.toml:3:1: unknown key 'controller_parameters.quux'; known: controller_parameters.speed");
  EXPECT_EQ(ErrorOf(Marching("[search]\nlength_max = 3\n")),
            "toy.toml:3:1: unknown key 'search.length_max'; did you mean 'genome.length_max'?");
  EXPECT_EQ(ErrorOf(Marching("quux = 3\n")), std::string("toy.toml:2:1: unknown key 'quux'; ") + kTop);
  EXPECT_EQ(ErrorOf(kMarching, {"serch.population=4"}),
            "--set serch.population=4: unknown key 'serch.population'; did you mean 'search.population'?");
}

TEST(ExperimentErrorsTest, ParametersOfAnotherControllerAreUnknown) {
  EXPECT_EQ(ErrorOf(Marching("controller = 'runner'\n[controller_parameters]\nspeed = 0.1\n")),
            "toy.toml:4:1: unknown key 'controller_parameters.speed'; known: controller_parameters.gain");
}

TEST(ExperimentErrorsTest, UnknownTablesAreRefusedEvenWhenEmpty) {
  EXPECT_EQ(ErrorOf(Marching("[simulator]\n")),
            std::string("toy.toml:2:2: unknown key 'simulator'; ") + kTop);
  EXPECT_EQ(ErrorOf(Marching("[search]\n[controller_parameters]\n")), "");
  EXPECT_EQ(ErrorOf("scenario = 'waiting'\n[controller_parameters]\n"), "");
}

TEST(ExperimentErrorsTest, KeysOfManyPartsAreRefusedBeforeTheyExhaustTheStack) {
  std::string deep;
  for (int i = 0; i < 50000; ++i) deep += "a.";
  const std::string said = "a key of more than 16 parts";
  EXPECT_THAT(ErrorOf(deep + "b = 1"), StartsWith("toy.toml:1:1: " + said));
  EXPECT_THAT(ErrorOf(Marching("[" + deep + "b]")), StartsWith("toy.toml:2:2: " + said));
  EXPECT_THAT(ErrorOf(Marching("x = { y = 1, " + deep + "b = 1 }")), StartsWith("toy.toml:2:14: " + said));
  std::string spaced;
  for (int i = 0; i < 50; ++i) spaced += "'a' . \"b.c\" .";
  EXPECT_THAT(ErrorOf(spaced + "b = 1"), StartsWith("toy.toml:1:1: " + said));
  EXPECT_THAT(ErrorOf(kMarching, {"seed={" + deep + "b=1}"}), HasSubstr("seed is text"));
}

TEST(ExperimentErrorsTest, DotsInTextsNumbersAndCommentsAreNoKeys) {
  const std::string dots = "1.2.3.4.5.6.7.8.9.0.1.2.3.4.5.6.7.8.9.0";
  const std::string fence = R"(""")";
  for (const std::string& text : {
           "description = \"" + dots + "\"",
           "description = \"\\\"" + dots + "\" # " + dots,
           "description = '" + dots + "'",
           "description = " + fence + "\n" + dots + "\n\\" + fence + dots + fence + "\"",
           "description = '''\n'" + dots + "'''",
           "# " + dots,
       }) {
    EXPECT_THAT(ErrorOf(Marching(text)), testing::Not(HasSubstr("parts"))) << text;
  }
}

TEST(ExperimentErrorsTest, KindsThatWouldPuzzleAreNamedMoreClosely) {
  EXPECT_EQ(ErrorOf(kMarching, {"search.generations=99999999999999999999999"}),
            "--set search.generations=99999999999999999999999: search.generations is a number beyond 64 "
            "bits, expected a whole number, 1 to 1000000");
  EXPECT_EQ(ErrorOf(Marching("seed = -5")),
            "toy.toml:2:1: seed is a negative number, expected a whole number, 0 to 18446744073709551615 (as "
            "text from 9223372036854775808 on)");
  EXPECT_EQ(ErrorOf(Marching("[[search]]\npopulation = 4")),
            "toy.toml:2:1: search is a table of keys such as search.algorithm, not a list of tables");
  EXPECT_EQ(ErrorOf(kMarching, {"search=3"}),
            "--set search=3: search is a table of keys such as search.algorithm, not a whole number");
  EXPECT_EQ(ErrorOf(kMarching, {"search=3.5"}),
            "--set search=3.5: search is a table of keys such as search.algorithm, not a decimal number");
}

TEST(ExperimentErrorsTest, ValuesOutOfRangeComeWithTheRange) {
  EXPECT_EQ(ErrorOf(Marching("[search]\n  crossover_probability = 1.5\n")),
            "toy.toml:3:3: search.crossover_probability = 1.5 is out of range, allowed 0 to 1");
  EXPECT_EQ(ErrorOf(Marching("[search]\npopulation = 2\n")),
            "toy.toml:3:1: search.population = 2 is out of range, allowed 4 to 10000");
  EXPECT_EQ(ErrorOf(Marching("[controller_parameters]\nspeed = 3\n")),
            "toy.toml:3:1: controller_parameters.speed = 3.0 is out of range, allowed 0.01 to 0.3 m/s");
  EXPECT_EQ(ErrorOf(Marching("[search]\nmutation_probability = nan\n")),
            "toy.toml:3:1: search.mutation_probability = nan is out of range, allowed 0 to 1");
  EXPECT_EQ(ErrorOf(kMarching, {"search.generations=0"}),
            "--set search.generations=0: search.generations = 0 is out of range, allowed 1 to 1000000");
  EXPECT_EQ(ErrorOf(Marching("[search]\ncrossover = 'triple-point'\n")),
            "toy.toml:3:1: search.crossover = \"triple-point\" is unknown, allowed single-point, "
            "double-point, uniform");
}

TEST(ExperimentErrorsTest, WrongTypesNameWhatWasExpected) {
  EXPECT_EQ(ErrorOf(Marching("[search]\npopulation = 'many'\n")),
            "toy.toml:3:1: search.population is text (\"many\"), expected a whole number, 4 to 10000");
  EXPECT_EQ(ErrorOf(Marching("[search]\npopulation = 20.5\n")),
            "toy.toml:3:1: search.population is a decimal number, expected a whole number, 4 to "
            "10000");
  EXPECT_EQ(ErrorOf(Marching("[arena]\nside = [6, 6]\n")),
            "toy.toml:3:1: arena.side is an array, expected a number, 1 to 50 m");
  EXPECT_EQ(ErrorOf(Marching("[scenario_parameters]\nheadwind = 2\n")),
            "toy.toml:3:1: scenario_parameters.headwind is a whole number, expected true or false");
  EXPECT_EQ(ErrorOf("scenario = 5"), "toy.toml:1:1: scenario is a whole number, expected text");
  EXPECT_EQ(ErrorOf(Marching("seed = -1\n")),
            "toy.toml:2:1: seed is a negative number, expected a whole number, 0 to 18446744073709551615 (as "
            "text from 9223372036854775808 on)");
  EXPECT_EQ(ErrorOf(Marching("seed = '18446744073709551616'\n")),
            "toy.toml:2:1: seed is text (\"18446744073709551616\"), expected a whole number, 0 to "
            "18446744073709551615 (as text from "
            "9223372036854775808 on)");
  EXPECT_EQ(ErrorOf(kMarching, {"seed=12x"}),
            "--set seed=12x: seed is text, expected a whole number, 0 to 18446744073709551615 (as text from "
            "9223372036854775808 on)");
  EXPECT_EQ(
      ErrorOf(kMarching, {"search.population=4\nseed=3"}),
      "--set search.population=4\\nseed=3: search.population is text, expected a whole number, 4 to 10000");
}

TEST(ExperimentErrorsTest, MalformedTomlIsPlacedByLineAndColumn) {
  EXPECT_THAT(ErrorOf("scenario = 'marching'\n[search\npopulation = 4\n"), StartsWith("toy.toml:2:8: "));
  EXPECT_THAT(ErrorOf("scenario = \n"), StartsWith("toy.toml:1:"));
  EXPECT_THAT(ErrorOf("scenario = 'marching'\nseed = 1\nseed = 2\n"), StartsWith("toy.toml:3:"));
  EXPECT_THAT(ErrorOf("scenario = \"\xFF\xFE\"\n"), StartsWith("toy.toml:1:"));
}

TEST(ExperimentErrorsTest, TheFirstErrorOfTheFileIsReported) {
  EXPECT_THAT(ErrorOf(Marching("[search]\nzzz = 1\naaa = 1\n")), StartsWith("toy.toml:3:1: "));
}

TEST(ExperimentErrorsTest, SetsNeedAKeyAndAValue) {
  EXPECT_EQ(ErrorOf(kMarching, {"generations"}),
            "--set generations: expected key=value, such as search.generations=10");
  EXPECT_THAT(ErrorOf(kMarching, {"=3"}), StartsWith("--set =3: expected key=value"));
  EXPECT_EQ(ErrorOf(kMarching, {"description=\xFF"}),
            "--set description=\\xff: the value is not valid UTF-8 text");
}

TEST(ExperimentErrorsTest, DisturbancesAreCheckedBeforeAnythingStarts) {
  EXPECT_EQ(ErrorOf(kMarching, {"noise.proximty.gaussian=0.1"}),
            "--set noise.proximty.gaussian=0.1: unknown key 'noise.proximty.gaussian'; did you mean "
            "'noise.proximity.gaussian'?");
  EXPECT_EQ(
      ErrorOf(kMarching, {"noise.proximity.gaussian=-0.1"}),
      "--set noise.proximity.gaussian=-0.1: noise.proximity.gaussian = -0.1 is out of range, allowed 0 to 1");
  EXPECT_EQ(
      ErrorOf(kMarching, {"noise.range_and_bearing.drop=1.5"}),
      "--set noise.range_and_bearing.drop=1.5: noise.range_and_bearing.drop = 1.5 is out of range, allowed 0 "
      "to 1");
  EXPECT_THAT(ErrorOf(kMarching, {"noise.light.drop=0.1"}), HasSubstr("unknown key 'noise.light.drop'"));
  EXPECT_EQ(
      ErrorOf(kMarching, {"faults=3:whels@500"}),
      "--set faults=3:whels@500: faults: '3:whels@500': no device is called 'whels'; did you mean 'wheels'?");
  EXPECT_EQ(ErrorOf(Marching("faults = '3:wheels@-5'\n")),
            "toy.toml:2:1: faults: '3:wheels@-5': the tick is a whole number, 0 to 1000000000");
  EXPECT_EQ(ErrorOf(Marching("faults = 3\n")), "toy.toml:2:1: faults is a whole number, expected text");
  EXPECT_EQ(ErrorOf(kMarching, {"random_faults.count=1001"}),
            "--set random_faults.count=1001: random_faults.count = 1001 is out of range, allowed 0 to 1000");
  EXPECT_THAT(ErrorOf(kMarching, {"random_faults.what=whels"}),
              HasSubstr("random_faults.what = \"whels\" is unknown, allowed stopped, wheels, leds, "));
  EXPECT_EQ(ErrorOf(kMarching, {"random_faults.role=prey"}),
            "--set random_faults.role=prey: random_faults.role = \"prey\" is unknown, allowed tested, all");
}

TEST(ExperimentErrorsTest, ScenarioAndControllerMustExistAndFit) {
  EXPECT_EQ(ErrorOf("name = 'x'\n"), "toy.toml: scenario is missing; known: marching, waiting");
  EXPECT_EQ(ErrorOf("scenario = 'marchng'\n"),
            "toy.toml:1:1: unknown scenario 'marchng'; did you mean 'marching'?");
  EXPECT_EQ(ErrorOf(kMarching, {"controller=quux"}),
            "--set controller=quux: unknown controller 'quux'; known: walker, runner, waiter");
  EXPECT_EQ(ErrorOf(Marching("controller = 'waiter'\n")),
            "toy.toml:2:1: controller 'waiter' is written for the scenario 'waiting', not for 'marching'");
}

TEST(ExperimentErrorsTest, RulesThatSpanKeysPointAtOneOfThem) {
  EXPECT_EQ(ErrorOf(Marching("[genome]\nlength_min = 3\n")),
            "toy.toml:3:1: genome.length_min = 3 must not exceed genome.length_max = 2");
  EXPECT_EQ(ErrorOf(Marching("[search]\npopulation = 7\n")),
            "toy.toml:3:1: search.population = 7 must be even: couples breed");
  EXPECT_EQ(
      ErrorOf(Marching("[genome]\nstep = 0.3\n")),
      "toy.toml:3:1: genome.step = 0.3 must be 0 (continuous) or a whole fraction of 1 m, such as 0.1 or "
      "0.05");
  EXPECT_EQ(ErrorOf(kMarching, {"genome.genes=0"}),
            "--set genome.genes=0: genome.genes = 0 leaves nothing to evolve: use 1 or more");
  EXPECT_EQ(ErrorOf(kMarching, {"genome.genes=0", "search.algorithm=random"}), "");
  EXPECT_EQ(
      ErrorOf(kMarching, {"arena.side=1", "arena.wall_thickness=0.8"}),
      "--set arena.wall_thickness=0.8: arena.wall_thickness = 0.8 must not exceed half of arena.side = 1");
  EXPECT_THAT(ErrorOf(Marching("name = '../up'\n")), StartsWith("toy.toml:2:1: name = \"../up\" is no good"));
}

TEST(ExperimentErrorsTest, WhatIsQuotedStaysInOneLine) {
  EXPECT_EQ(ErrorOf(Marching("controller = \"a\\nb\\u001b[31m\"\n")),
            "toy.toml:2:1: unknown controller 'a\\nb\\x1b[31m'; known: walker, runner, waiter");
}

}  // namespace
}  // namespace gauntlet
