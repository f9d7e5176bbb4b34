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
  EXPECT_THAT(ErrorOf("<argos-configuration><controllers></argos-configuration>"),
              HasSubstr("mine.argos:1:"));
  EXPECT_THAT(ErrorOf("<experiment/>"), HasSubstr("the root element is <experiment>"));
  EXPECT_THAT(ErrorOf("<argos-configuration/>"), HasSubstr("there is no controller"));
  std::string deep = "<argos-configuration><controllers>";
  for (int i = 0; i < 50; ++i) deep += "<a>";
  for (int i = 0; i < 50; ++i) deep += "</a>";
  EXPECT_THAT(ErrorOf(deep + "</controllers></argos-configuration>"), HasSubstr("nested deeper"));
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
  EXPECT_THAT(
      ErrorOf(with_arena(R"(<foot-bot id="f" rab_data_size="many"><controller config="w"/></foot-bot>)")),
      HasSubstr(R"(<foot-bot id="f"> has rab_data_size="many", expected bytes from 1 to 65536)"));
  const auto table = ArgosControllerTable(with_arena(distributed), "mine.argos");
  ASSERT_TRUE(table.ok()) << table.error().message;
  EXPECT_THAT(*table, HasSubstr("    {1, gauntlet::argos_form::kRobotsLine, \"F0-\"},\n"
                                "    {1, gauntlet::argos_form::kMessageLine, \"24\"},\n"));
}

TEST(ReadArgosControllers, TakesAllAndChoosesOne) {
  const auto read = ReadArgosControllers(kTwo, "mine.argos", "s");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->id, "s");
  EXPECT_THAT(read->sections, HasSubstr("<turning speed=\"2.5\" name=\"x\""));
  const auto bare = ReadArgosControllers(
      R"(<controllers><a id="a"><actuators/><sensors/><params/></a></controllers>)", "a.xml", "");
  ASSERT_TRUE(bare.ok()) << bare.error().message;
  EXPECT_EQ(bare->id, "a");
}

TEST(ReadArgosControllers, SaysWhatArgosWouldMiss) {
  EXPECT_THAT(RefusalOf(kTwo), HasSubstr("several controllers: choose one by --controller, of: s, w"));
  EXPECT_THAT(RefusalOf(kTwo, "v"), HasSubstr("no controller 'v'; it has: s, w"));
  EXPECT_THAT(RefusalOf("<controllers><a id='a'><sensors/><params/></a></controllers>"),
              HasSubstr("mine.argos:1:15: <a> has no <actuators>"));
  EXPECT_THAT(RefusalOf("<controllers><a><sensors/></a></controllers>"), HasSubstr("<a> has no id="));
  EXPECT_THAT(RefusalOf("<arena/>"), HasSubstr("<arena> has no controller"));
  EXPECT_THAT(RefusalOf("<controllers>"), HasSubstr("malformed XML"));
}

TEST(ReadArgosControllers, GivesParametersOfTheCampaign) {
  const auto read = ReadArgosControllers(kTwo, "mine.argos", "w");
  ASSERT_TRUE(read.ok());
  const ArgosControllers changed =
      WithParameters(*read, {{"turning.speed", 3.25}, {"turning.name", 1.0}, {"link_range", 1.0}});
  EXPECT_THAT(changed.sections, HasSubstr("<turning speed=\"3.25\" name=\"x\""));
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
