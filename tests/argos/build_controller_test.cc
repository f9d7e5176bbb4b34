// `gauntlet build-controller` with a real compiler: the plug-in that it makes, and what it refuses.
// Covers: cli/compiler.cc
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "controllers/examples/light_flocking_registry.h"
#include "controllers/examples/light_flocking_scenario.h"
#include "controllers/registry.h"
#include "controllers/rows/row_checks.h"
#include "sdk/plugin.h"
#include "sim/simulation.h"
#include "tests/argos/light_flocking_form.h"
#include "tests/support/paths.h"
#include "tests/support/process.h"

namespace gauntlet::argos_form {
namespace {

namespace fs = std::filesystem;
using controllers::ControllerInfo;
using testing::HasSubstr;
using testing_support::ProcessResult;

const std::string kExample = std::string(GAUNTLET_SOURCE_DIR) + "/argos/example/light_flocking";

class BuildController : public testing::Test {
 protected:
  BuildController() : folder_(testing::TempDir() + "build-controller-" + std::to_string(getpid())) {
    fs::create_directories(folder_);
  }
  ~BuildController() override { fs::remove_all(folder_); }

  std::string File(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name) << content;
    return folder_ / name;
  }
  static ProcessResult Run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {GAUNTLET_BINARY_DIR "/gauntlet", "build-controller"});
    return testing_support::RunProcess(arguments);
  }
  static void ExpectRefusal(const std::vector<std::string>& arguments, const std::string& message) {
    const ProcessResult result = Run(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.out, "");
    EXPECT_THAT(result.err, HasSubstr(message));
  }

  fs::path folder_;
};

std::uint64_t TrajectoryOf(const controllers::ControllerFactory& robots) {
  const auto& table = controllers::light_flocking::LightFlockingScenarioParameters();
  auto settings = table.Read(*controllers::ResolveParameters(table.infos(), {}));
  settings.tick_limit = 300;
  controllers::light_flocking::LightFlockingScenario scenario(sim::TestCase{}, settings, robots, 5);
  const sim::RunResult result = Simulate(scenario, 5, false);
  EXPECT_EQ(result.verdict, sim::Verdict::kCompleted) << result.message;
  return result.trajectory_hash;
}

TEST_F(BuildController, MakesAPluginWhoseParametersAreThoseOfTheFile) {
  const std::string library = folder_ / "libflock.so";
  const ProcessResult built = Run({kExample + ".cc", "--argos", kExample + ".argos", "-o", library});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  void* const handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  ASSERT_NE(handle, nullptr) << dlerror();
  const auto* const plugin = static_cast<const sdk::Plugin*>(dlsym(handle, sdk::kPluginSymbol));
  ASSERT_NE(plugin, nullptr);
  EXPECT_STREQ(plugin->fingerprint, sdk::kPluginFingerprint.c_str());
  const Result<std::string> told = plugin->rows();
  ASSERT_TRUE(told.ok()) << told.error().message;
  const auto rows = controllers::ReadRows(nlohmann::json::parse(*told), library).value().controllers;
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].name, "light_flocking_controller");
  sim::Parameters values;
  for (const auto& parameter : rows[0].parameters) {
    values[parameter.name] = parameter.default_value;
  }
  EXPECT_EQ(values.at("wheel_turning.max_speed"), 10.0);
  EXPECT_EQ(values.at("flocking.gain"), 1000.0);

  const std::uint64_t trajectory = TrajectoryOf(plugin->make(rows[0].name, values));
  EXPECT_EQ(trajectory, TrajectoryOf(ExampleFlockers()));
  values["wheel_turning.max_speed"] = 8.0;
  EXPECT_NE(TrajectoryOf(plugin->make(rows[0].name, values)), trajectory);
}

// Without obstacles, where the built-in robots gather too.
TEST_F(BuildController, MakesRobotsThatGatherInAScenarioWhichAFileDefines) {
  const std::string library = folder_ / "libflock.so";
  const ProcessResult built = Run({kExample + ".cc", "--argos", kExample + ".argos", "-o", library});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  const ProcessResult evaluated = testing_support::RunProcess(
      {GAUNTLET_BINARY_DIR "/gauntlet", "evaluate", "gathering", "--plugin", library, "--set",
       "controller=light_flocking_controller", "--case", File("empty.json", R"({"obstacles": []})"),
       "--replicates", "3", "--dir", folder_ / "campaign", "--workers", "1", "--quiet", "--json"});
  ASSERT_EQ(evaluated.exit_code, 0) << evaluated.err;
  const nlohmann::json runs = nlohmann::json::parse(evaluated.out).at("cases").at(0).at("runs");
  ASSERT_EQ(runs.size(), 3u);
  for (const nlohmann::json& run : runs) {
    EXPECT_EQ(run.at("verdict"), "completed");
    EXPECT_EQ(run.at("failure").at("total"), false) << run.at("metrics").at("robots_in_goal");
  }
}

TEST_F(BuildController, NamesWhatIsWrong) {
  const std::string library = folder_ / "libbad.so";
  const std::string broken = File("broken.cpp", "int x = ;\n");
  ExpectRefusal({broken, "-o", library}, "broken.cpp:1:9: error:");
  ExpectRefusal({folder_ / "absent.cpp", "-o", library}, "there is no such source file");
  ExpectRefusal({broken}, "say -o libNAME.so");
  ExpectRefusal({"-o", library}, "which sources?");
  ExpectRefusal({broken, "-o", library, "--argos", File("cut.argos", "<argos-configuration>")},
                "cut.argos:1:");
  const std::string idle = File("idle.cpp", "int Idle() { return 1; }\n");
  File("libbad.so", "an earlier one");
  ExpectRefusal({idle, "-o", library}, "it brings neither a controller nor a scenario");
  EXPECT_EQ(fs::file_size(library), 14U) << "what was there stays";
  fs::remove(library);
  ExpectRefusal({broken, "-o", library, "-I", folder_ / "absent"}, "there is no such folder");
}

TEST_F(BuildController, SaysWhichCompilerItNeeds) {
  const std::string library = folder_ / "libbad.so";
  const std::string source = File("fine.cpp", "int Fine() { return 1; }\n");
  setenv("CXX", (folder_ / "absent").c_str(), 1);
  ExpectRefusal({source, "-o", library}, "there is no compiler");
  const std::string old = File("old-compiler",
                               "#!/bin/sh\n[ \"$1\" != -dumpversion ] || { echo 8.5.0; exit; }\n"
                               "echo \"unrecognized option '-std=gnu++20'\" >&2; exit 1\n");
  fs::permissions(old, fs::perms::owner_all);
  setenv("CXX", old.c_str(), 1);
  ExpectRefusal({source, "-o", library}, "is release 8.5.0, and g++ 10 or later is needed");
  setenv("CXX", "c++ -include /absent.h", 1);
  ExpectRefusal({source, "-o", library}, "/absent.h");
  unsetenv("CXX");
}

// What a shell makes of the call that --dry-run prints is the same plug-in.
TEST_F(BuildController, PrintsItsCallOfTheCompiler) {
  const std::string library = folder_ / "lib my bird.so";
  const ProcessResult told =
      Run({std::string(GAUNTLET_SOURCE_DIR) + "/sdk/example/my_bird.cc", "-o", library, "--dry-run"});
  ASSERT_EQ(told.exit_code, 0) << told.err;
  EXPECT_FALSE(fs::exists(library));
  EXPECT_EQ(testing_support::RunProcess({"/bin/sh", "-c", told.out}).exit_code, 0) << told.out;
  EXPECT_THAT(testing_support::RunProcess({GAUNTLET_BINARY_DIR "/gauntlet", "list", "--plugin", library}).out,
              HasSubstr("my-bird"));
}

TEST_F(BuildController, DefinesTheMacrosThatItIsGiven) {
  const std::string source = File("macro.cpp",
                                  "#include <argos3/core/control_interface/ci_controller.h>\n"
                                  "class CIdle : public argos::CCI_Controller {};\n"
                                  "static_assert(sizeof(GIT_BRANCH) == 4 && SIZE == 3);\n"
                                  "REGISTER_CONTROLLER(CIdle, \"idle\")\n");
  const ProcessResult built =
      Run({source, "-o", folder_ / "libmacro.so", "-D", "GIT_BRANCH=\"a b\"", "-DSIZE=3"});
  EXPECT_EQ(built.exit_code, 0) << built.err;
  ExpectRefusal({source, "-o", folder_ / "libmacro.so", "-DSIZE=3"}, "say -D GIT_BRANCH=VALUE");
}

TEST_F(BuildController, TakesNoSourcesThatContradictEachOtherOrTheFile) {
  const std::string library = folder_ / "libbad.so";
  const auto source = [this](const std::string& file, const std::string& label) {
    return File(file,
                "#include <argos3/core/control_interface/ci_controller.h>\n"
                "namespace { class CIdle : public argos::CCI_Controller {}; }\n"
                "REGISTER_CONTROLLER(CIdle, \"" +
                    label + "\")\n");
  };
  const std::string first = source("first.cpp", "idle");
  const ProcessResult with_loop_functions =
      Run({first, "-o", library, "--argos",
           File("loop.argos", R"(<argos-configuration><controllers><idle id="i"/></controllers>
                                 <loop_functions/></argos-configuration>)")});
  EXPECT_EQ(with_loop_functions.exit_code, 0);
  EXPECT_THAT(with_loop_functions.err,
              HasSubstr("loop.argos has loop functions, which Gauntlet does not run"));
  fs::remove(library);
  ExpectRefusal({first, source("second.cpp", "idle"), "-o", library},
                "several classes are registered by one name: idle");
  EXPECT_FALSE(fs::exists(library));
  ExpectRefusal({first, "-o", library, "--argos", kExample + ".argos"},
                "has light_flocking_controller, but the sources register idle");
}

TEST_F(BuildController, SaysWhatToDoInsteadOfWhatCannotBe) {
  const std::string library = folder_ / "libloop.so";
  ExpectRefusal({File("loop.cpp",
                      "#include <argos3/core/simulator/loop_functions.h>\n"
                      "using namespace argos;\n"
                      "class CLoop : public CLoopFunctions {};\n"
                      "REGISTER_LOOP_FUNCTIONS(CLoop, \"loop\")\n"),
                 "-o", library},
                "let a scenario judge the swarm");
  for (const std::string kind : {"actuator", "sensor"}) {
    const std::string upper = kind == "sensor" ? "SENSOR" : "ACTUATOR";
    ExpectRefusal(
        {File("device.cpp", "#include <argos3/core/simulator/" + kind + ".h>\nREGISTER_" + upper +
                                "(int, \"radio\", \"default\", \"\", \"1.0\", \"\", \"\", \"Usable\")\n"),
         "-o", library},
        "radio: Gauntlet's foot-bot has the devices of ARGoS' foot-bot");
  }
  ExpectRefusal({File("window.cpp",
                      "#include <argos3/plugins/simulator/visualizations/qt-opengl/"
                      "qtopengl_user_functions.h>\n"),
                 "-o", library},
                "Gauntlet shows no window");
}

}  // namespace
}  // namespace gauntlet::argos_form
