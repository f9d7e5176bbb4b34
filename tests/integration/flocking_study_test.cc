// The thesis' chapter 4 in small, through the command line: ten evolutions against random testing, every case
// simulated again with fresh seeds.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>

#include "analysis/statistics/bootstrap.h"
#include "analysis/statistics/rank_test.h"
#include "tests/integration/campaign_driver.h"

namespace gauntlet {
namespace {

using analysis::ClusterBootstrapA;
using analysis::MannWhitney;
using analysis::RankTest;
using nlohmann::json;
using testing_support::Gauntlet;
using testing_support::ProcessResult;
using testing_support::Show;
using testing_support::TemporaryDirectory;

constexpr int kEvolutions = 10;
constexpr int kRandomCases = 200;
using Clusters = std::vector<std::vector<double>>;

// The genomes of a campaign's population as case files; their paths.
std::vector<std::string> WriteCases(const json& population, const std::string& prefix) {
  std::vector<std::string> paths;
  for (const json& member : population) {
    paths.push_back(fmt::format("{}-{:04}.json", prefix, paths.size()));
    std::ofstream(paths.back()) << json::object({{"obstacles", member.at("genome")}});
  }
  return paths;
}

std::vector<double> Simulate(const std::string& experiment, const std::vector<std::string>& cases,
                             const std::string& dir, int seed) {
  std::vector<std::string> arguments = {"evaluate", experiment, "--json", "--quiet",
                                        "--dir",    dir,        "--seed", std::to_string(seed)};
  for (const std::string& path : cases) arguments.insert(arguments.end(), {"--case", path});
  const ProcessResult result = Gauntlet(arguments, std::chrono::seconds(1200));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const json document = json::parse(result.out, nullptr, false);
  std::vector<double> fitness;
  for (const json& one : document["cases"]) fitness.push_back(one["fitness"].get<double>());
  return fitness;
}

std::vector<double> Flatten(const Clusters& clusters) {
  std::vector<double> values;
  for (const std::vector<double>& cluster : clusters)
    values.insert(values.end(), cluster.begin(), cluster.end());
  return values;
}

void PrintRow(const std::string& name, const std::vector<double>& values) {
  const double n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  const auto zeros = static_cast<double>(std::count(values.begin(), values.end(), 0.0));
  fmt::print("{:<34} n {:>4}  mean {:.3f}  sd {:.3f}  zeros {:.1f} %\n", name, values.size(), mean,
             std::sqrt(squares / (n - 1.0)), 100.0 * zeros / n);
}

struct Comparison {
  RankTest test;
  double lower_bound;  // one-sided 95 %, of A = P(first > second)
};

Comparison Compare(const std::string& name, const Clusters& first, const Clusters& second) {
  const Comparison comparison{MannWhitney(Flatten(first), Flatten(second)),
                              ClusterBootstrapA(first, second, 0.90, 4000, 1).low};
  fmt::print("{:<34} A {:.3f} (95 % lower bound {:.3f}), one-tailed p {:.3g}\n", name, comparison.test.a,
             comparison.lower_bound, comparison.test.p_greater);
  return comparison;
}

Clusters Singletons(const std::vector<double>& values) {
  Clusters clusters;
  for (const double value : values) clusters.push_back({value});
  return clusters;
}

Clusters EvolveAndSimulate(const std::string& evolved_for, const std::vector<std::string>& simulated_with,
                           const TemporaryDirectory& scratch, Clusters* other) {
  Clusters own;
  for (int seed = 1; seed <= kEvolutions; ++seed) {
    const std::string dir = scratch / fmt::format("{}-{}", evolved_for, seed);
    const ProcessResult evolved =
        Gauntlet({"evolve", evolved_for, "--dir", dir, "--seed", std::to_string(seed), "--quiet"},
                 std::chrono::seconds(600));
    EXPECT_EQ(evolved.exit_code, 0) << evolved.err;
    const std::vector<std::string> cases = WriteCases(Show(dir)["population"], dir + "-case");
    own.push_back(Simulate(simulated_with[0], cases, dir + "-again", 1000 + seed));
    other->push_back(Simulate(simulated_with[1], cases, dir + "-other", 1000 + seed));
  }
  return own;
}

TEST(FlockingStudy, EvolvedCasesAreTougherAndTheImprovedControllerStandsThemBetter) {
  const TemporaryDirectory scratch;
  ASSERT_EQ(Gauntlet({"random", "flocking", "--cases", std::to_string(kRandomCases), "--seed", "5000",
                      "--dir", scratch / "random", "--quiet"},
                     std::chrono::seconds(600))
                .exit_code,
            0);
  const std::vector<std::string> random_cases =
      WriteCases(Show(scratch / "random")["population"], scratch / "random-case");
  const std::vector<double> random_original =
      Simulate("flocking", random_cases, scratch / "random-again", 6000);
  const std::vector<double> random_improved =
      Simulate("flocking-improved", random_cases, scratch / "random-improved", 6000);

  Clusters improved_on_original;
  const Clusters evolved =
      EvolveAndSimulate("flocking", {"flocking", "flocking-improved"}, scratch, &improved_on_original);
  Clusters original_on_improved;
  const Clusters improved_on_own = EvolveAndSimulate("flocking-improved", {"flocking-improved", "flocking"},
                                                     scratch, &original_on_improved);

  fmt::print("\n");
  PrintRow("random, original", random_original);
  PrintRow("random, improved", random_improved);
  PrintRow("F/F evolved for original", Flatten(evolved));
  PrintRow("I/F improved on those", Flatten(improved_on_original));
  PrintRow("I/I evolved for improved", Flatten(improved_on_own));
  PrintRow("F/I original on those", Flatten(original_on_improved));
  const Comparison tougher = Compare("random > evolved", Singletons(random_original), evolved);
  const Comparison better = Compare("I/F > F/F", improved_on_original, evolved);
  Compare("I/I > F/I", improved_on_own, original_on_improved);

  const double random_mean =
      std::accumulate(random_original.begin(), random_original.end(), 0.0) / kRandomCases;
  EXPECT_GE(random_mean, 0.55);
  EXPECT_LE(random_mean, 0.75);
  EXPECT_LT(tougher.test.p_greater, 0.01);
  EXPECT_GT(tougher.lower_bound, 0.56);
  EXPECT_LT(better.test.p_greater, 0.01);
}

}  // namespace
}  // namespace gauntlet
