// What `gauntlet list --plugin` says of libraries, good ones and bad ones.
// Covers: base/system/sha256.cc, master/directory/plugins.cc, sdk/plugin.cc,
// worker/plugin/describe_plugin.cc, worker/plugin/plugin_library.cc
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/plugin/plugin_files.h"

namespace gauntlet::testing_support {
namespace {

using testing::HasSubstr;

TEST(PluginList, ShowsControllersWithTheirParameters) {
  const ProcessResult text = Gauntlet({"list", "--plugin", PluginPath("of_twins")});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("twin: light flocking from a library"));
  EXPECT_THAT(text.out, HasSubstr("written for the scenario light-flocking"));
  const ProcessResult result =
      Gauntlet({"list", "--json", "--plugin", PluginPath("of_twins"), "--plugin", PluginPath("of_faults")});
  const nlohmann::json json = nlohmann::json::parse(result.out);
  ASSERT_EQ(json["plugins"].size(), 2u);
  const nlohmann::json& twin = json["plugins"][0]["controllers"][0];
  EXPECT_EQ(twin["name"], "twin");
  ASSERT_EQ(twin["parameters"].size(), 9u);
  EXPECT_EQ(twin["parameters"][0]["name"], "target_distance");
  EXPECT_EQ(twin["parameters"][0]["default"], 0.75);
  EXPECT_EQ(twin["parameters"][0]["unit"], "m");
  EXPECT_EQ(json["plugins"][0]["sha256"], Sha256(ReadFile(PluginPath("of_twins"))));
}

struct Refusal {
  std::string plugin;
  std::string why;
};
void PrintTo(const Refusal& refusal, std::ostream* os) {
  *os << refusal.plugin;
}

class RefusedPlugin : public testing::TestWithParam<Refusal> {};

TEST_P(RefusedPlugin, IsRefusedByTheReason) {
  if (kSanitized && GetParam().plugin == "allocates_when_loaded")
    GTEST_SKIP() << "sanitizers know no memory limit";
  const std::string file = PluginPath(GetParam().plugin);
  const ProcessResult result = Gauntlet({"list", "--plugin", file});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(result.err, HasSubstr(file));
  EXPECT_THAT(result.err, HasSubstr(GetParam().why));
}

INSTANTIATE_TEST_SUITE_P(
    Plugins, RefusedPlugin,
    testing::Values(
        Refusal{"other_abi", "made for version 5 of the plug-in interface, this program has version 4"},
        Refusal{"other_compiler", "plug-in: arm64 libc++ 14; program: x86-64 libstdc++"},
        Refusal{"without_description", "exports no 'gauntlet_plugin'"},
        Refusal{"missing_symbol", "undefined symbol: symbol_that_nobody_has"},
        Refusal{"throws_when_loaded", "no license"}, Refusal{"exits_when_loaded", "called exit(0)"},
        Refusal{"allocates_when_loaded", "exceeded its memory when it was loaded"},
        Refusal{"throws_in_list", "its list of controllers throws: no list today"},
        Refusal{"built_in_name", "'flocking', which is the name of a built-in one"},
        Refusal{"bad_range", "parameter 'value': its range is 0 to -1"},
        Refusal{"built_in_scenario", "scenario 'flocking', which is the name of a built-in one"},
        Refusal{"two_scenarios_of_one_name", "two of its scenarios are called 'refused'"},
        Refusal{"no_such_time_limit", "its time limit 'seconds', in s, is none of its parameters"},
        Refusal{"no_such_metric", "a descriptor axis is of the metric 'counts', which is none"},
        Refusal{"fails_without_a_metric", "failing = 'count' is neither total_failure nor a metric"},
        Refusal{"without_requirements", "scenario 'refused' has no requirements"},
        Refusal{"with_passages", "scenario 'refused' has passages, which is for built-in"},
        Refusal{"throws_in_scenarios", "its list of scenarios throws: no scenarios today"}),
    [](const testing::TestParamInfo<Refusal>& parameter) { return parameter.param.plugin; });

TEST(PluginList, RefusesWhatIsNoLibrary) {
  const TemporaryDirectory scratch;
  std::ofstream(scratch / "text.so") << "no library\n";
  const ProcessResult text = Gauntlet({"list", "--plugin", scratch / "text.so"});
  EXPECT_EQ(text.exit_code, 2);
  EXPECT_THAT(text.err, HasSubstr("text.so: file too short"));
  const ProcessResult missing = Gauntlet({"list", "--plugin", scratch / "none.so"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("none.so"));
}

TEST(PluginList, RefusesTwoPluginsThatBringOneName) {
  const ProcessResult result =
      Gauntlet({"list", "--plugin", PluginPath("of_faults"), "--plugin", PluginPath("taken_name")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("both bring a controller 'chatty'"));
}

TEST(PluginList, RefusesTwoPluginsThatBringOneScenario) {
  const ProcessResult result = Gauntlet(
      {"list", "--plugin", PluginPath("of_faulty_scenarios"), "--plugin", PluginPath("taken_scenario")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("both bring a scenario 'sound'"));
}

TEST(PluginList, ShowsScenariosWithMetrics) {
  const ProcessResult text = Gauntlet({"list", "--plugin", PluginPath("of_patrol")});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("my-patrol: robots have to come to every patch"));
  EXPECT_THAT(text.out, HasSubstr("controller unless another is named: my-guard"));
  EXPECT_THAT(text.out, HasSubstr("share of the patches that a robot came to; describes behaviour"));
  EXPECT_THAT(text.out, HasSubstr("my-guard: wanders, turns from walls"));
  const nlohmann::json json = nlohmann::json::parse(
      Gauntlet({"list", "--json", "--plugin", PluginPath("of_patrol")}).out)["plugins"][0];
  EXPECT_EQ(json["scenarios"][0]["name"], "my-patrol");
  EXPECT_EQ(json["scenarios"][0]["metrics"].size(), 4u);
  EXPECT_EQ(json["controllers"][0]["scenario"], "my-patrol");
}

}  // namespace
}  // namespace gauntlet::testing_support
