#include "master/cases/argos_controllers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace gauntlet::master {
namespace {

using testing::HasSubstr;

std::string ErrorOf(const std::string& text) {
  const auto table = ArgosControllerTable(text, "mine.argos");
  return table.ok() ? "no error" : table.error().message;
}

TEST(ArgosControllerTable, HoldsEveryElementAndAttribute) {
  const auto table = ArgosControllerTable(
      R"(<argos-configuration><controllers>
           <walker id="w"><sensors><positioning/></sensors><params speed="2.5" say="a &quot;?\"/></walker>
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

}  // namespace
}  // namespace gauntlet::master
