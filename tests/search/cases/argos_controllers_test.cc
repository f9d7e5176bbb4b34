#include "search/cases/argos_controllers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace gauntlet {
namespace {

using testing::HasSubstr;

std::string ErrorOf(const std::string& text) {
  const auto table = ArgosControllerTable(text, "mine.argos");
  return table.ok() ? "no error" : table.error().message;
}

TEST(ArgosControllerTable, HoldsEveryElementAndAttribute) {
  const auto table = ArgosControllerTable(
      R"(<argos-configuration><controllers>
           <walker id="w"><sensors><positioning/></sensors><params speed="2.5" say="a &quot;?\"> b
           </params></walker>
         </controllers></argos-configuration>)",
      "mine.argos");
  ASSERT_TRUE(table.ok()) << table.error().message;
  EXPECT_THAT(*table, HasSubstr(R"({0, "walker", nullptr},
    {1, "id", "w"},
    {1, "sensors", nullptr},
    {2, "positioning", nullptr},
    {1, "params", nullptr},
    {2, "speed", "2.5"},
    {2, "say", "a \042\077\134"},
    {2, "", "b"},
)"));
}

TEST(ArgosControllerTable, NamesWhatIsWrong) {
  EXPECT_EQ(ErrorOf("<argos-configuration><controllers></argos-configuration>"),
            "mine.argos:1:37: malformed XML: Start-end tags mismatch");
  EXPECT_EQ(ErrorOf("<experiment/>"),
            "mine.argos:1:2: the root element is <experiment>, expected <argos-configuration>");
  EXPECT_EQ(ErrorOf("<argos-configuration/>"),
            "mine.argos:1:2: there is no controller: expected <controllers> with an element for each");
  std::string deep = "<argos-configuration><controllers>";
  for (int i = 0; i < 50; ++i) deep += "<a>";
  for (int i = 0; i < 50; ++i) deep += "</a>";
  EXPECT_EQ(ErrorOf(deep + "</controllers></argos-configuration>"),
            "mine.argos:1:36: <a> is nested deeper than 32 elements");
}

constexpr const char* kTwo = R"(<argos-configuration><controllers>
    <walker id="w" library="lib"><actuators/><sensors/><params><turning speed="2.5" name="x"/></params></walker>
    <sitter id="s" library="lib"><actuators/><sensors/><params/></sitter>
  </controllers></argos-configuration>)";

std::string RefusalOf(const std::string& text, const std::string& id = "") {
  const auto read = ReadArgosControllers(text, "mine.argos", id);
  return read.ok() ? "no error" : read.error().message;
}

TEST(ReadArgosControllers, KnowsWhatTheFileSaysOfTheRobots) {
  const auto with_arena = [](const std::string& arena) {
    std::string text = kTwo;
    return text.insert(text.find("</argos"), "<arena>" + arena + "</arena>");
  };
  const std::string distributed = R"(<foot-bot id="x"><controller config="s"/></foot-bot><distribute><entity>
      <foot-bot id="F0-" rab_data_size="24"><controller config="w"/></foot-bot></entity></distribute>)";
  const auto read = ReadArgosControllers(with_arena(distributed), "mine.argos", "w");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->robots, "F0-");
  EXPECT_EQ(read->message_bytes, 24);
  const auto numbered = ReadArgosControllers(
      with_arena(R"(<foot-bot id="30"><controller config="w"/></foot-bot>)"), "mine.argos", "w");
  ASSERT_TRUE(numbered.ok()) << numbered.error().message;
  EXPECT_EQ(numbered->robots, "");
  EXPECT_EQ(numbered->message_bytes, std::nullopt);
  EXPECT_EQ(ReadArgosControllers(with_arena(distributed), "mine.argos", "s")->robots, "x");
  EXPECT_EQ(ReadArgosControllers(kTwo, "mine.argos", "w")->robots, std::nullopt);
  EXPECT_EQ(ReadArgosControllers(with_arena("<box/>"), "mine.argos", "w")->robots, "");
  EXPECT_EQ(
      ErrorOf(with_arena(R"(<foot-bot id="f" rab_data_size="many"><controller config="w"/></foot-bot>)")),
      "mine.argos:2:6: <foot-bot id=\"f\"> has rab_data_size=\"many\", expected bytes from 1 to 65536");
  const auto table = ArgosControllerTable(with_arena(distributed), "mine.argos");
  ASSERT_TRUE(table.ok()) << table.error().message;
  EXPECT_THAT(*table, HasSubstr("    {1, gauntlet::argos_form::kRobotsLine, \"F0-\"},\n"
                                "    {1, gauntlet::argos_form::kMessageLine, \"24\"},\n"));
}

TEST(ReadArgosControllers, TakesAllAndChoosesOne) {
  const auto read = ReadArgosControllers(kTwo, "mine.argos", "s");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->id, "s");
  EXPECT_EQ(read->sections,
            "<walker id=\"w\" library=\"lib\">\n  <actuators />\n  <sensors />\n  <params>\n    <turning "
            "speed=\"2.5\" name=\"x\" />\n  </params>\n</walker>\n<sitter id=\"s\" library=\"lib\">\n  "
            "<actuators />\n  <sensors />\n  <params />\n</sitter>\n");
  const auto bare = ReadArgosControllers(
      R"(<controllers><a id="a"><actuators/><sensors/><params/></a></controllers>)", "a.xml", "");
  ASSERT_TRUE(bare.ok()) << bare.error().message;
  EXPECT_EQ(bare->id, "a");
}

TEST(ReadArgosControllers, SaysWhatArgosWouldMiss) {
  EXPECT_EQ(RefusalOf(kTwo), "mine.argos has several controllers: choose one by --controller, of: s, w");
  EXPECT_EQ(RefusalOf(kTwo, "v"), "mine.argos has no controller 'v'; it has: s, w");
  EXPECT_EQ(RefusalOf("<controllers><a id='a'><sensors/><params/></a></controllers>"),
            "mine.argos:1:15: <a> has no <actuators>, which ARGoS wants even when it is empty");
  EXPECT_EQ(RefusalOf("<controllers><a><sensors/></a></controllers>"),
            "mine.argos:1:15: <a> has no id=\"...\"");
  EXPECT_EQ(RefusalOf("<arena/>"),
            "mine.argos:1:2: <arena> has no controller: expected <controllers> with an element for each");
  EXPECT_EQ(RefusalOf("<controllers>"), "mine.argos:1:13: malformed XML: Start-end tags mismatch");
}

TEST(ReadArgosControllers, GivesParametersOfTheCampaign) {
  const auto read = ReadArgosControllers(kTwo, "mine.argos", "w");
  ASSERT_TRUE(read.ok());
  const ArgosControllers changed =
      WithParameters(*read, {{"turning.speed", 3.25}, {"turning.name", 1.0}, {"link_range", 1.0}});
  EXPECT_EQ(changed.sections,
            "<walker id=\"w\" library=\"lib\">\n  <actuators />\n  <sensors />\n  <params>\n    <turning "
            "speed=\"3.25\" name=\"x\" />\n  </params>\n</walker>\n<sitter id=\"s\" library=\"lib\">\n  "
            "<actuators />\n  <sensors />\n  <params />\n</sitter>\n");
  EXPECT_THAT(WithParameters(*read, {{"turning.speed", 2.5}}).sections, testing::Eq(read->sections));
}

TEST(WithParameters, TellsElementsOfOneNameApart) {
  const auto read = ReadArgosControllers(
      R"(<controllers><a id="a"><actuators/><sensors/><params><port n="1"/><port n="2"/></params></a></controllers>)",
      "a.xml", "");
  ASSERT_TRUE(read.ok()) << read.error().message;
  const ArgosControllers changed = WithParameters(*read, {{"port.n", 3}, {"port-2.n", 4}, {"port-3.n", 5}});
  EXPECT_THAT(changed.sections,
              testing::ContainsRegex("<port n=\"3\" />[ \n]*<port n=\"4\" />[ \n]*</params>"));
}

TEST(UnlikenessTo, SaysWhatIsOfAnotherController) {
  const auto read = ReadArgosControllers(kTwo, "mine.argos", "w");
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(UnlikenessTo(*read, "walker", {"turning.speed"}), "");
  EXPECT_EQ(UnlikenessTo(*read, "w", {}), "");
  EXPECT_EQ(UnlikenessTo(*read, "flocker", {"turning.speed", "turning.gain", "size"}),
            "it is a <walker>, and it has no turning.gain, size");
}

}  // namespace
}  // namespace gauntlet
