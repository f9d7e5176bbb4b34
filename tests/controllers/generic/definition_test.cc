#include "controllers/generic/definition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gauntlet::controllers::generic {
namespace {

constexpr const char* kText =
    "fitness = largest_cluster / robots\n"
    "failure = largest_cluster < 0.5 * robots\n"
    "reached = clusters == 1\n"
    "light.1.x = -2\nlight.1.y = 1.5\nlight.1.height = 0.5\nlight.1.intensity = 3\nlight.1.color = red\n"
    "nest.1.x = 0\nnest.1.y = 0\nnest.1.radius = 0\nnest.1.length = 2\nnest.1.width = 1\nnest.1.grey = 0.5\n";

// What is wrong when these follow the two formulas that have to be.
std::string ErrorOf(const std::vector<DefinitionEntry>& entries) {
  DefinitionReader reader;
  EXPECT_TRUE(reader.Set("fitness", "1").ok());
  EXPECT_TRUE(reader.Set("failure", 0.0).ok());
  for (const auto& [path, value] : entries) {
    if (const Status set = reader.Set(path, value); !set.ok()) return set.error().message;
  }
  const Result<Definition> definition = reader.Finish();
  return definition.ok() ? "" : definition.error().message;
}

TEST(DefinitionTest, EveryKeyThatIsListedIsTaken) {
  DefinitionReader reader;
  for (const KeyInfo& key : DefinitionKeys()) {
    const std::string text = key.choices.empty() ? "robots" : key.choices.back();
    const auto* number = std::get_if<double>(&key.default_value);
    const Status set = reader.Set(key.path, number != nullptr ? KeyValue(*number) : text);
    EXPECT_TRUE(set.ok()) << key.path << ": " << set.error().message;
  }
}

TEST(Definition, IsReadAndWrittenInOneForm) {
  const Result<Definition> definition = ParseDefinition(kText);
  ASSERT_TRUE(definition.ok()) << definition.error().message;
  EXPECT_EQ(definition->fitness, "largest_cluster / robots");
  EXPECT_EQ(definition->reached, "clusters == 1");
  ASSERT_EQ(definition->lights.size(), 1U);
  EXPECT_EQ(definition->lights[0].position, sim::Vec2(-2.0, 1.5));
  EXPECT_EQ(definition->lights[0].color, sim::Color::kRed);
  ASSERT_EQ(definition->nests.size(), 1U);
  EXPECT_TRUE(definition->nests[0].Holds({1.0, 0.5}));
  EXPECT_FALSE(definition->nests[0].Holds({1.01, 0.0}));

  DefinitionReader reader;
  const Result<std::vector<DefinitionEntry>> entries = EntriesOf(kText);
  for (auto entry = entries->rbegin(); entry != entries->rend(); ++entry)
    ASSERT_TRUE(reader.Set(entry->first, entry->second).ok());
  EXPECT_EQ(*reader.Text(), kText);
}

TEST(Definition, FillsInDefaultsAndTakesTheLastOfTwoValues) {
  DefinitionReader reader;
  ASSERT_TRUE(reader.Set("fitness", 1.0).ok());
  ASSERT_TRUE(reader.Set("failure", "0").ok());
  ASSERT_TRUE(reader.Set("fitness", "2").ok());
  ASSERT_TRUE(reader.Begin("light.1").ok());
  ASSERT_TRUE(reader.Set("source.1.radius", 0.25).ok());
  const Result<std::string> text = reader.Text();
  EXPECT_EQ(
      *text,
      "fitness = 2\nfailure = 0\n"
      "light.1.x = 0\nlight.1.y = 0\nlight.1.height = 0.5\nlight.1.intensity = 3\nlight.1.color = black\n"
      "source.1.x = 0\nsource.1.y = 0\nsource.1.radius = 0.25\nsource.1.length = 0\nsource.1.width = 0\n"
      "source.1.grey = 0\n");
}

TEST(Definition, SaysWhatWouldBeRight) {
  EXPECT_EQ(ErrorOf({{"failure", "largest_clutser < 3"}}),
            "failure = \"largest_clutser < 3\": character 1: unknown measure 'largest_clutser'; did you mean "
            "'largest_cluster'?");
  EXPECT_EQ(ErrorOf({{"reached", "items_brought > 3 && collisions > 1"}}).substr(0, 85),
            "reached = \"items_brought > 3 && collisions > 1\": character 22: unknown measure 'colli");
  EXPECT_EQ(ErrorOf({{"ligth.1.x", 1.0}}), "[generic]: unknown key 'ligth'; did you mean 'light'?");
  EXPECT_EQ(ErrorOf({{"light.1.hight", 1.0}}), "unknown key 'light.1.hight'; did you mean 'light.1.height'?");
  EXPECT_EQ(ErrorOf({{"light.1.x", 51.0}}), "light.1.x = 51.0 is out of range, allowed -50 to 50 m");
  EXPECT_EQ(ErrorOf({{"light.1.x", "left"}}), "light.1.x = \"left\", expected a number, -50 to 50 m");
  EXPECT_EQ(ErrorOf({{"light.1.color", "pink"}}),
            "light.1.color = \"pink\" is unknown, allowed black, red, green, blue, yellow, white, magenta, "
            "cyan, orange");
  EXPECT_EQ(ErrorOf({{"light.x", 1.0}}), "light is a list: each of it begins with [[generic.light]]");
  EXPECT_EQ(ErrorOf({{"light", 1.0}}), "light is a list: each of it begins with [[generic.light]]");
  EXPECT_EQ(ErrorOf({{"light.101.x", 1.0}}), "light.101: a list has the places 1 to 100");
  EXPECT_EQ(ErrorOf({{"light.2.x", 1.0}}), "light.2 without light.1");
  EXPECT_EQ(ErrorOf({{"ground.1.radius", -1.0}}),
            "ground.1.radius = -1.0 is out of range, allowed 0 to 50 m");
  EXPECT_EQ(ErrorOf({{"ground.1.radius", 1.0}, {"ground.1.width", 2.0}}),
            "ground.1: radius = 1, length = 0, width = 2: a disc has a radius, a rectangle a length and a "
            "width, in m");
}

TEST(Definition, NeedsAFitnessAndAFailure) {
  EXPECT_EQ(ParseDefinition("").error().message,
            "[generic] fitness is missing: a formula such as \"largest_cluster / robots\"");
  EXPECT_EQ(ParseDefinition("fitness = 1\n").error().message,
            "[generic] failure is missing: a formula such as \"largest_cluster < 0.5 * robots\"");
  EXPECT_EQ(ParseDefinition("nonsense").error().message,
            "the line \"nonsense\" of a definition is no NAME = VALUE");
}

}  // namespace
}  // namespace gauntlet::controllers::generic
