#include "controllers/command/placeholders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/controllers/command/command_definitions.h"

namespace gauntlet::controllers::command {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

Definition WithSpeed(const json& more = {}) {
  json table = {{"parameter", json::array({{{"name", "speed"}, {"default", 0.1}, {"high", 1}}})}};
  if (!more.is_null()) table.update(more);
  return DefinitionWith(table);
}

sim::RunSpec SomeRun() {
  sim::RunSpec spec;
  spec.seed = (std::uint64_t{1} << 40) + 6;
  spec.controller_parameters = {{"speed", 0.25}};
  spec.test_case.obstacles = {{.x = 1.5, .y = -2.0, .length = 0.5, .width = 0.2, .orientation_deg = 90.0},
                              {.x = 0.0, .y = 0.1, .length = 1.0, .width = 0.3, .orientation_deg = 0.0}};
  return spec;
}

TEST(Placeholders, AreReplacedWithinAnArgumentAndNeverSplitOne) {
  const Definition definition = WithSpeed(
      {{"run", {"sim", "--case={case}", "{out} {seed64}", "v={parameters.speed}", "{{x}}", "a b"}}});
  EXPECT_THAT(ArgumentsOf(definition, SomeRun()),
              ElementsAre("sim", "--case=case.json", "out.json 1099511627782", "v=0.25", "{x}", "a b"));
}

TEST(Placeholders, ACaseOfATemplateHasItsEnding) {
  EXPECT_EQ(CaseFileOf(WithSpeed({{"template", "my/course.argos"}})), "case.argos");
}

RC_GTEST_PROP(Placeholders, SeedsAreWhatProgramsTake, (std::uint64_t seed)) {
  RC_ASSERT(SeedOf(seed) >= 1U && SeedOf(seed) <= 2147483647U);
}

TEST(Placeholders, SeedsThatFollowEachOtherDiffer) {
  EXPECT_NE(SeedOf(7), SeedOf(8));
  EXPECT_EQ(SeedOf(0), 1U);
  EXPECT_EQ(SeedOf(2147483646), 2147483647U);
}

constexpr const char* kTemplate =
    "<seed>@seed@</seed>\n"
    "# @obstacles@\n"
    "<box id=\"b@number@\" x=\"@x@\" y=\"@y@\" l=\"@length@\" h=\"@half_width@\" r=\"@radians@\" "
    "d=\"@degrees@\"/>\n"
    "# @end@\n"
    "mail a@@b, v @parameters.speed@, @ alone, a @b c@\n";

TEST(Template, RepeatsTheMarkedLinesForEachObstacle) {
  const Definition definition = WithSpeed();
  ASSERT_TRUE(CheckTemplate(definition, kTemplate).ok())
      << CheckTemplate(definition, kTemplate).error().message;
  EXPECT_EQ(FillTemplate(definition, kTemplate, SomeRun()),
            "<seed>519</seed>\n"
            "<box id=\"b1\" x=\"1.5\" y=\"-2\" l=\"0.5\" h=\"0.1\" r=\"1.5707963267948966\" d=\"90\"/>\n"
            "<box id=\"b2\" x=\"0\" y=\"0.1\" l=\"1\" h=\"0.15\" r=\"0\" d=\"0\"/>\n"
            "mail a@b, v 0.25, @ alone, a @b c@\n");
}

TEST(Template, OfACaseWithoutObstaclesHasNone) {
  sim::RunSpec spec = SomeRun();
  spec.test_case.obstacles.clear();
  EXPECT_EQ(FillTemplate(WithSpeed(), "a\n@obstacles@\n@x@\n@end@\nb", spec), "a\nb");
}

TEST(Template, SaysTheLineOfWhatIsWrong) {
  const auto wrong = [](const char* text) {
    const Status status = CheckTemplate(WithSpeed(), text);
    return status.ok() ? std::string() : status.error().message;
  };
  EXPECT_THAT(wrong("a\n"), HasSubstr("there is no line with @obstacles@"));
  EXPECT_THAT(wrong("@obstacles@\n@x@\n"), HasSubstr("there is no line with @end@"));
  EXPECT_THAT(wrong("@end@\n"), HasSubstr("line 1: one line with @obstacles@"));
  EXPECT_THAT(wrong("@obstacles@\n@end@\n@obstacles@\n@end@\n"), HasSubstr("line 3"));
  EXPECT_THAT(wrong("a\n@obstacles@\n@xx@\n@end@\n"),
              HasSubstr("line 3: unknown mark 'xx'; did you mean 'x'?"));
  EXPECT_THAT(wrong("@x@\n@obstacles@\n@end@\n"), HasSubstr("line 1: unknown mark 'x'"));
}

}  // namespace
}  // namespace gauntlet::controllers::command
