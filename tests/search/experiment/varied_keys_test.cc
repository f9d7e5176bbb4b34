#include "search/experiment/varied_keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "search/experiment/experiment_file.h"
#include "search/search_table.h"

namespace gauntlet {
namespace {

using testing::ElementsAre;

Experiment Flocking() {
  return ParseExperiment("", "test.toml", {"scenario=flocking"}, BuiltInCatalogue()).value();
}

Result<std::vector<VariedKey>> Parse(const std::vector<std::string>& texts) {
  const Experiment experiment = Flocking();
  return ParseVariedKeys(texts, AllKeysOf(experiment), experiment);
}

VariedKey One(const std::string& text) {
  return Parse({text}).value().front();
}

std::string ErrorOfKeys(const std::vector<std::string>& texts) {
  const auto keys = Parse(texts);
  return keys ? "" : keys.error().message;
}

TEST(VariedKeysTest, ANumberGoesFromEndToEnd) {
  const VariedKey key = One("controller_parameters.bird_speed=.05..0.15");
  EXPECT_EQ(key.ValueAt(0.0), KeyValue(0.05));
  EXPECT_EQ(key.ValueAt(1.0), KeyValue(0.15));
  EXPECT_NEAR(NumberOf(key.ValueAt(0.5)), 0.1, 1e-12);
}

TEST(VariedKeysTest, OnALogarithmicScaleTheMiddleIsTheGeometricMean) {
  const VariedKey key = One("controller_parameters.bird_speed=0.01..0.16:log");
  EXPECT_NEAR(NumberOf(key.ValueAt(0.5)), 0.04, 1e-12);
  EXPECT_EQ(key.ToText(), "controller_parameters.bird_speed=0.01..0.16:log");
}

TEST(VariedKeysTest, WhatIsDrawnMayBeNormalAndHaveWeights) {
  const Experiment experiment = Flocking();
  const auto drawn = [&](const std::string& text) {
    return ParseVariedKeys({text}, AllKeysOf(experiment), experiment, Varied::kDrawn);
  };
  const VariedKey normal = drawn("controller_parameters.bird_speed=0.1..0.14:normal").value().front();
  EXPECT_NEAR(NumberOf(normal.ValueAt(0.5)), 0.12, 1e-12);
  EXPECT_NEAR(NumberOf(normal.ValueAt(1.0)), 0.14, 1e-8);
  // A quarter of all lies above .639 standard deviations when two are the ends.
  EXPECT_NEAR(NumberOf(normal.ValueAt(0.75)), 0.12 + 0.01 * 0.639, 1e-4);
  EXPECT_EQ(normal.ToText(), "controller_parameters.bird_speed=0.1..0.14:normal");
  const VariedKey weighted = drawn("physics=impulse:3|box2d").value().front();
  EXPECT_EQ(weighted.ValueAt(0.74), KeyValue(std::string("impulse")));
  EXPECT_EQ(weighted.ValueAt(0.76), KeyValue(std::string("box2d")));
  EXPECT_EQ(weighted.ToText(), "physics=impulse:3|box2d:1");
  // A campaign reads again what it has written.
  const std::string sevenths = drawn("physics=impulse:0.1|box2d:0.6").value().front().ToText();
  EXPECT_EQ(drawn(sevenths).value().front().ToText(), sevenths);
  EXPECT_NE(ErrorOfKeys({"controller_parameters.bird_speed=0.1..0.14:normal"}), "") << "tried, not drawn";
}

TEST(VariedKeysTest, EachWholeNumberHasAsMuchRoom) {
  const VariedKey key = One("genome.genes=2..5");
  std::map<std::int64_t, int> counts;
  for (int i = 0; i < 400; ++i) ++counts[std::get<std::int64_t>(key.ValueAt((i + 0.5) / 400.0))];
  EXPECT_EQ(counts, (std::map<std::int64_t, int>{{2, 100}, {3, 100}, {4, 100}, {5, 100}}));
}

TEST(VariedKeysTest, GenesLieOnTheirGrid) {
  const VariedKey key = One("genome.length_max=1..2");
  EXPECT_NEAR(NumberOf(key.ValueAt(0.26)), 1.3, 1e-12);
}

TEST(VariedKeysTest, AListGivesEachOfItsValues) {
  const VariedKey key = One("physics=impulse|box2d");
  EXPECT_EQ(key.ValueAt(0.2), KeyValue(std::string("impulse")));
  EXPECT_EQ(key.ValueAt(0.999), KeyValue(std::string("box2d")));
  EXPECT_EQ(key.ToText(), "physics=impulse|box2d");
}

RC_GTEST_PROP(VariedKeysProperties, APlaceLeadsToAValueAndBack, (unsigned seed)) {
  const double place = (seed % 1'000'000U) / 1e6;
  static const std::vector<VariedKey> keys =
      Parse({"controller_parameters.bird_speed=0.01..0.16:log", "genome.genes=2..5", "genome.length_max=1..2",
             "physics=impulse|box2d"})
          .value();
  for (const VariedKey& key : keys) {
    const KeyValue value = key.ValueAt(place);
    const KeyValue again = key.ValueAt(key.PlaceOf(value));
    if (std::holds_alternative<double>(value)) {
      RC_ASSERT(std::abs(NumberOf(again) - NumberOf(value)) < 1e-9);
      RC_ASSERT(NumberOf(value) >= key.low && NumberOf(value) <= key.high);
    } else {
      RC_ASSERT(again == value);
    }
    RC_ASSERT(Parse({key.ToText()}).value().front().ValueAt(place) == value);
  }
}

TEST(VariedKeysTest, RoundingKeepsTwoDigitsAndTheRange) {
  const VariedKey key = One("controller_parameters.bird_speed=0.0512..0.15");
  EXPECT_EQ(key.RoundedAt(0.5), KeyValue(0.1));
  EXPECT_EQ(key.RoundedAt(0.0), KeyValue(0.0512));
}

TEST(VariedKeysTest, ValuesTakeTheirPlaceInTheExperiment) {
  const auto keys = Parse({"controller_parameters.bird_speed=0.05..0.15", "physics=impulse|box2d"}).value();
  const Experiment changed = WithValues(Flocking(), keys, std::vector<KeyValue>{0.07, std::string("box2d")});
  EXPECT_EQ(changed.controller_parameters.at("bird_speed"), 0.07);
  EXPECT_EQ(changed.physics, sim::PhysicsKind::kBox2d);
}

TEST(VariedKeysTest, SayWhatIsWrong) {
  const auto range = [](const std::string& text) {
    return ErrorOfKeys({"controller_parameters.bird_speed=" + text});
  };
  const std::string key = "--vary controller_parameters.bird_speed=";
  EXPECT_EQ(ErrorOfKeys({}), "nothing varies: --vary KEY=LOW..HIGH is needed");
  EXPECT_EQ(ErrorOfKeys({"bird_speed"}),
            "--vary bird_speed: KEY=LOW..HIGH, KEY=LOW..HIGH:log or KEY=A|B is needed");
  EXPECT_EQ(ErrorOfKeys({"controller_parameters.bird_sped=1..2"}),
            "--vary controller_parameters.bird_sped=1..2: unknown key 'controller_parameters.bird_sped'; did "
            "you mean 'controller_parameters.bird_speed'?");
  EXPECT_EQ(ErrorOfKeys({"camera_drop=0..1"}),
            "--vary camera_drop=0..1: unknown key 'camera_drop'; did you mean "
            "'noise.omnidirectional_camera.drop'?");
  EXPECT_EQ(
      ErrorOfKeys({"quux=0..1"}),
      "--vary quux=0..1: unknown key 'quux'; known: physics, arena.*, genome.*, random_faults.*, noise.*, "
      "scenario_parameters.*, controller_parameters.*");
  EXPECT_EQ(range("0.1"), key + "0.1: '0.1' is no range, as in controller_parameters.bird_speed=0.5..2");
  EXPECT_EQ(range("a..b"), key + "a..b: 'a..b' is no range of two numbers, as in 0.5..2");
  EXPECT_EQ(range("0.15..0.05"), key + "0.15..0.05: 0.15 is not below 0.05");
  EXPECT_THAT(range("0.05..1e9"),
              testing::StartsWith(key + "0.05..1e9: controller_parameters.bird_speed = "));
  EXPECT_EQ(ErrorOfKeys({"noise.proximity.gaussian=0..1:log"}),
            "--vary noise.proximity.gaussian=0..1:log: the range begins at 0, which has no logarithm");
  EXPECT_EQ(ErrorOfKeys({"genome.genes=2.5..4"}),
            "--vary genome.genes=2.5..4: genome.genes is a whole number, 0 to 64, and 2.5 is none");
  EXPECT_EQ(ErrorOfKeys({"genome.genes=2..4", "genome.genes=3..5"}),
            "--vary genome.genes=3..5: genome.genes varies twice");
  EXPECT_EQ(ErrorOfKeys({"physics=impulse"}),
            "--vary physics=impulse: impulse is a single value: LOW..HIGH or A|B is needed");
  EXPECT_EQ(ErrorOfKeys({"physics=impulse|impulse"}), "--vary physics=impulse|impulse: impulse stands twice");
}

TEST(VariedKeysTest, WhatNoRunReadsDoesNotVary) {
  EXPECT_EQ(ErrorOfKeys({"search.population=10..20"}),
            "--vary search.population=10..20: search.population says how is searched");
  EXPECT_EQ(ErrorOfKeys({"seed=1..2"}), "--vary seed=1..2: seed gives every run its seed");
  EXPECT_EQ(ErrorOfKeys({"store.trajectories=true|false"}),
            "--vary store.trajectories=true|false: store.trajectories has no influence on a run");
  EXPECT_EQ(ErrorOfKeys({"faults=1:wheels@5|2:wheels@5"}),
            "--vary faults=1:wheels@5|2:wheels@5: faults is a text");
}

}  // namespace
}  // namespace gauntlet
