// The same runs, bit for bit, whatever the compiler. No expected number stands here: the builds are compared
// with each other. (compare_builds does so for the optimisation.)
#include <array>
#include <cstdio>
#include <set>
#include <string>

#include "controllers/registry.h"
#include "gtest/gtest.h"
#include "proto/golden_hashes.h"
#include "worker/golden_hash.h"
#include "worker/run_executor.h"

namespace gauntlet {
namespace {

std::string Hex(std::uint64_t value) {
  std::array<char, 20> text;
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(value));
  return text.data();
}

std::string GoldenText() {
  return proto::WriteGoldenHashes(worker::GoldenHashes());
}

// What the program prints.
std::string OutputOf(const std::string& path) {
  FILE* pipe = ::popen(("'" + path + "'").c_str(), "r");
  if (pipe == nullptr) return "cannot start " + path;
  std::array<char, 100> buffer{};
  std::string output;
  while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr) output += buffer.data();
  if (::pclose(pipe) != 0) return path + " failed: " + output;
  return output;
}

TEST(GoldenHash, EveryControllerHasItsOwn) {
  const proto::GoldenHashes hashes = worker::GoldenHashes();
  std::set<std::uint64_t> different;
  for (const controllers::ControllerInfo& controller : controllers::Controllers()) {
    ASSERT_TRUE(hashes.contains(std::string(controller.name))) << controller.name;
    different.insert(hashes.at(std::string(controller.name)));
  }
  EXPECT_EQ(different.size(), hashes.size());
}

TEST(GoldenHash, IsTheSameInEveryCall) {
  EXPECT_EQ(GoldenText(), GoldenText());
}

TEST(GoldenHash, IsTheSameFromAnotherCompiler) {
#ifdef GAUNTLET_GOLDEN_OTHER_COMPILER
  EXPECT_EQ(OutputOf(GAUNTLET_GOLDEN_OTHER_COMPILER), GoldenText());
#else
  GTEST_SKIP() << "no second compiler here, or a build with sanitizers";
#endif
}

TEST(Run, GivesTheSameResultTwice) {
  for (const controllers::ControllerInfo& controller : controllers::Controllers()) {
    sim::RunSpec spec;
    spec.scenario = controller.scenario;
    spec.controller = controller.name;
    spec.scenario_parameters["time_limit"] = 20.0;
    spec.test_case.obstacles = {{1.7, 1.6, 0.8, 0.2, 20.0}};
    spec.seed = 5;
    const sim::RunResult first = worker::Run(spec);
    spec.record_trajectory = true;
    const sim::RunResult second = worker::Run(spec);
    EXPECT_EQ(first.verdict, sim::Verdict::kCompleted) << first.message;
    EXPECT_EQ(Hex(first.hash), Hex(second.hash)) << controller.name;
    EXPECT_EQ(Hex(first.trajectory_hash), Hex(second.trajectory_hash));
    spec.seed = 6;
    EXPECT_NE(Hex(worker::Run(spec).trajectory_hash), Hex(first.trajectory_hash)) << controller.name;
  }
}

TEST(Run, RefusesAnInvalidSpecByName) {
  sim::RunSpec spec;
  spec.scenario = "flocking";
  spec.controller = "flocking";
  spec.test_case.obstacles = {{0.0, 0.0, 7.0, 0.2, 0.0}};
  const sim::RunResult result = worker::Run(spec);
  EXPECT_EQ(result.verdict, sim::Verdict::kRefused);
  EXPECT_EQ(result.message.substr(0, 9), "no-path: ");
  EXPECT_EQ(result.ticks, 0);
  EXPECT_EQ(result.hash, sim::HashOf(result));
}

}  // namespace
}  // namespace gauntlet
