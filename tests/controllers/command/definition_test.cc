// Covers: controllers/command/definition_checks.cc
#include "controllers/command/definition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/controllers/command/command_definitions.h"

namespace gauntlet::controllers::command {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

// "path: what" of the complaint about SmallTable with these keys besides; "" of none.
std::string ComplaintAbout(const json& more) {
  json table = SmallTable();
  if (more.is_object()) table.update(more);
  const ReadDefinition read = Read(table);
  return read.complaint ? read.complaint->path + ": " + read.complaint->what : "";
}

json ListOf(const json& element) {
  return json::array({element});
}

TEST(CommandDefinition, FourKeysAreEnough) {
  const Definition definition = DefinitionWith({});
  EXPECT_EQ(definition.run, (std::vector<std::string>{"sim", "{case}"}));
  EXPECT_EQ(definition.Reported(), std::vector<std::string>{"items"});
  EXPECT_EQ(definition.wall_limit, 600.0);
  EXPECT_TRUE(definition.confine);
}

TEST(CommandDefinition, EachOfTheFourIsMissed) {
  for (const char* key : {"run", "metrics", "fitness", "failure"}) {
    json table = SmallTable();
    table.erase(key);
    const ReadDefinition read = Read(table);
    ASSERT_TRUE(read.complaint) << key;
    EXPECT_EQ(read.complaint->path, key);
    EXPECT_THAT(read.complaint->what, HasSubstr(std::string(key) + " is missing"));
  }
}

TEST(CommandDefinition, CanonicalTextReadsBackAndIsTheSameAgain) {
  Definition definition = DefinitionWith(
      {{"template", "course.argos"},
       {"files", {"course.argos"}},
       {"metric", json::array({{{"name", "score"}, {"from", "log:score (\\d+)"}, {"unit", "items"}},
                               {{"name", "loss"}, {"formula", "10 - score"}}})},
       {"parameter", ListOf({{"name", "speed"}, {"default", 0.1}, {"low", 0.0}, {"high", 0.5}})},
       {"point", ListOf({{"name", "nest"}, {"x", 1.0 / 3.0}})},
       {"keep_out", ListOf({{"x", 1}, {"radius", 0.5}})},
       {"standing", ListOf({{"length", 2}, {"width", 0.1}, {"degrees", 30}})},
       {"axis", ListOf({{"metric", "score"}, {"min", 0}, {"max", 10}, {"parts", 5}})},
       {"place", {{"x", "score"}, {"y", "loss"}, {"same_within", 0.5}}},
       {"refused", ListOf({{"pattern", "Impossible to place"}})},
       {"cores", 2},
       {"confine", false},
       {"setup", "export A='b\"c'\n"}});
  definition.files = {{"course.argos", std::string(64, 'a'), false}, {"sim", std::string(64, 'b'), true}};
  const std::string text = CanonicalText(definition);
  const Result<Definition> again = Parse(text);
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(CanonicalText(*again), text);
  EXPECT_EQ(again->points.at(0).x, 1.0 / 3.0);
  EXPECT_EQ(again->files.at(1).executable, true);
  EXPECT_EQ(again->setup, definition.setup);
}

TEST(CommandDefinition, AnotherDefinitionHasAnotherText) {
  const std::string text = CanonicalText(DefinitionWith({}));
  for (const json& more : std::initializer_list<json>{{{"run", {"sim", "{case} "}}},
                                                      {{"wall_limit", 599.0}},
                                                      {{"confine", false}},
                                                      {{"probe", {"sim", "--version"}}}}) {
    EXPECT_NE(CanonicalText(DefinitionWith(more)), text) << more;
  }
}

TEST(CommandDefinition, SaysWhatIsWrongAndWithWhichKey) {
  struct Wrong {
    json more;
    std::string complaint;
  };
  const std::vector<Wrong> all = {
      {{{"wall_limt", 5}}, "wall_limt: [command]: unknown key 'wall_limt'; did you mean 'wall_limit'?"},
      {{{"wall_limit", "long"}}, "wall_limit: wall_limit = \"long\", expected a number, 0.1 to 604800 s"},
      {{{"wall_limit", -1}}, "wall_limit: wall_limit = -1"},
      {{{"cores", 1.5}}, "cores: cores = 1.5, expected a whole number"},
      {{{"run", "sim {case}"}}, "run: run = \"sim {case}\", expected a list of texts"},
      {{{"run", {"sim", "{cas}"}}}, "did you mean 'case'?"},
      {{{"run", {"sim", "{parameters.speed}"}}}, "unknown placeholder 'parameters.speed'"},
      {{{"run", {"sim", "{case"}}}, "a '{' without '}'"},
      {{{"fitness", "item"}},
       "fitness: fitness = \"item\": character 1: unknown measure 'item'; did you mean"},
      {{{"metrics", {"items", "items"}}}, "the metric 'items' is given twice"},
      {{{"metrics", {"items", "2nd"}}}, "begins with a letter"},
      {{{"metric", ListOf({{"name", "a"}, {"from", "log:("}})}}, "metric.1.from"},
      {{{"metric", ListOf({{"name", "a"}, {"from", "json:a"}})}}, "is none of log:PATTERN, csv:FILE:COLUMN"},
      {{{"metric", ListOf({{"name", "a"}, {"from", "log:a"}, {"formula", "1"}})}}, "has both"},
      {{{"metric", ListOf({{"name", "a"}, {"from", "trajectory:order"}})}}, "needs the key trajectory"},
      {{{"trajectory", "t.csv"}, {"metric", ListOf({{"name", "a"}, {"from", "trajectory:odrer"}})}},
       "unknown measure 'odrer'; did you mean 'order'?"},
      {{{"metric", ListOf({{"name", "a"}, {"formula", "b"}})}}, "metric.1.formula"},
      {{{"metric", ListOf({{"nme", "a"}})}}, "metric.1.nme: unknown key 'nme'; did you mean 'name'?"},
      {{{"files", {"/etc/passwd"}}}, "files: files: '/etc/passwd' is no path below a folder"},
      {{{"files", {"a/../../b"}}}, "'a/../../b' is no path below a folder"},
      {{{"trajectory", "../t.csv"}}, "'../t.csv' is no path below a folder"},
      {{{"parameter", ListOf({{"name", "a"}, {"default", 2}, {"low", 0}, {"high", 1}})}},
       "its default 2 is not within low = 0 and high = 1"},
      {{{"axis", ListOf({{"metric", "item"}, {"max", 1}})}}, "axis.1.metric: axis.1.metric: unknown metric"},
      {{{"axis", ListOf({{"metric", "items"}, {"min", 1}, {"max", 1}})}}, "goes from 1 to 1"},
      {{{"place", {{"x", "items"}, {"y", "items"}}}}, "place.same_within is missing"},
      {{{"keep_out", ListOf({{"x", 1}})}}, "a disc has a radius, a rectangle a length and a width"},
      {{{"point", ListOf({{"x", 1}})}}, "points have names that differ"},
      {{{"refused", ListOf({{"pattern", "(?=a)"}})}}, "refused.1.pattern: the pattern (?=a)"},
  };
  for (const Wrong& wrong : all)
    EXPECT_THAT(ComplaintAbout(wrong.more), HasSubstr(wrong.complaint)) << wrong.more;
}

TEST(CommandDefinition, WhatIsNoCanonicalTextIsRefused) {
  for (const char* text : {"", "{", "[]", R"({"format": 2})", R"({"format": 1})"})
    EXPECT_FALSE(Parse(text).ok()) << text;
}

TEST(CommandDefinition, EveryListedKeyIsKnown) {
  for (const KeyInfo& key : Keys()) {
    const std::string list = key.path.substr(0, key.path.find('.'));
    EXPECT_THAT(ComplaintAbout({{list, nullptr}}), testing::Not(HasSubstr("unknown key"))) << key.path;
    EXPECT_THAT(key.description.empty() && key.unit.empty() && key.max == 0.0, false) << key.path;
  }
}

}  // namespace
}  // namespace gauntlet::controllers::command
