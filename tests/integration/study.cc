#include "tests/integration/study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include "analysis/statistics/bootstrap.h"
#include "analysis/statistics/sample.h"
#include "tests/integration/campaign_driver.h"

namespace gauntlet::testing_support {
namespace {

using nlohmann::json;

constexpr int kRandomSeed = 5000;
constexpr int kFreshRandomSeed = 6000;   // of simulating the random cases again
constexpr int kFreshEvolvedSeed = 1000;  // plus the number of the evolution

// The genomes of a campaign's population as case files; their paths.
std::vector<std::string> WriteCases(const json& population, const std::string& prefix) {
  std::vector<std::string> paths;
  for (const json& member : population) {
    paths.push_back(fmt::format("{}-{:04}.json", prefix, paths.size()));
    std::ofstream(paths.back()) << json::object({{"obstacles", member.at("genome")}});
  }
  return paths;
}

analysis::Clusters FitnessOf(const StudySample& sample) {
  analysis::Clusters clusters;
  for (const StudyCluster& cluster : sample) {
    std::vector<double>& values = clusters.emplace_back();
    for (const SimulatedCase& one : cluster) values.push_back(one.fitness);
  }
  return clusters;
}

StudyCluster Flatten(const StudySample& sample) {
  StudyCluster all;
  for (const StudyCluster& cluster : sample) all.insert(all.end(), cluster.begin(), cluster.end());
  return all;
}

std::vector<double> FlatFitness(const StudySample& sample) {
  std::vector<double> values;
  for (const SimulatedCase& one : Flatten(sample)) values.push_back(one.fitness);
  return values;
}

void MustSucceed(const ProcessResult& result) {
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

}  // namespace

double MeanFitness(const StudySample& sample) {
  return analysis::Describe(FlatFitness(sample)).mean;
}

double ShareOf(const StudySample& sample, const std::function<bool(const SimulatedCase&)>& holds) {
  const StudyCluster all = Flatten(sample);
  return static_cast<double>(std::count_if(all.begin(), all.end(), holds)) / static_cast<double>(all.size());
}

bool BroughtNothing(const SimulatedCase& one) {
  return one.fitness == 0.0;
}

void PrintSamples(const std::vector<std::pair<std::string, StudySample>>& samples) {
  fmt::print("\n");
  for (const auto& [name, sample] : samples) {
    const StudyCluster all = Flatten(sample);
    const analysis::Description fitness = analysis::Describe(FlatFitness(sample));
    fmt::print("{:<34} n {:>4}  mean {:.3f}  sd {:.3f}  zeros {:.1f} %  condition 1 {:.1f} %  2 {:.1f} %\n",
               name, fitness.n, fitness.mean, fitness.sd.value_or(0.0),
               100.0 * ShareOf(sample, BroughtNothing), 100.0 * ShareOf(sample, &SimulatedCase::condition_1),
               100.0 * ShareOf(sample, &SimulatedCase::condition_2));
  }
}

Comparison CompareSamples(const std::string& name, const StudySample& first, const StudySample& second) {
  const Comparison comparison{
      analysis::MannWhitney(FlatFitness(first), FlatFitness(second)),
      analysis::ClusterBootstrapA(FitnessOf(first), FitnessOf(second), 0.90, 4000, 1).low};
  fmt::print("{:<34} A {:.3f} (95 % lower bound {:.3f}), one-tailed p {:.3g}\n", name, comparison.test.a,
             comparison.lower_bound, comparison.test.p_greater);
  return comparison;
}

void ExpectTougherAndBetter(const StudySample& random, const std::vector<StudySample>& evolved) {
  const Comparison tougher = CompareSamples("random > evolved", random, evolved[0]);
  const Comparison better = CompareSamples("improved > original on evolved", evolved[1], evolved[0]);
  EXPECT_LT(tougher.test.p_greater, 0.01);
  EXPECT_GT(tougher.lower_bound, 0.56);
  EXPECT_LT(better.test.p_greater, 0.01);
}

StudyCluster Study::Simulate(const std::string& controller, const std::vector<std::string>& cases,
                             const std::string& dir, int seed) const {
  std::vector<std::string> arguments = {
      "evaluate", experiment_, "--json", "--quiet",           "--set", "controller=" + controller,
      "--dir",    dir,         "--seed", std::to_string(seed)};
  for (const std::string& path : cases) arguments.insert(arguments.end(), {"--case", path});
  const ProcessResult result = Gauntlet(arguments, std::chrono::seconds(1200));
  MustSucceed(result);
  const json document = json::parse(result.out, nullptr, false);
  StudyCluster simulated;
  for (const json& one : document["cases"]) {
    const json& metrics = one["runs"][0]["metrics"];
    simulated.push_back({one["fitness"].get<double>(), metrics.value("condition_1", 0.0) == 1.0,
                         metrics.value("condition_2", 0.0) == 1.0});
  }
  return simulated;
}

std::vector<std::string> Study::RandomCases(int count) const {
  const std::string dir = scratch_ / "random";
  MustSucceed(Gauntlet({"random", experiment_, "--cases", std::to_string(count), "--seed",
                        std::to_string(kRandomSeed), "--dir", dir, "--quiet"},
                       std::chrono::seconds(1200)));
  return WriteCases(Show(dir)["population"], dir + "-case");
}

const std::vector<std::vector<std::string>>& Study::EvolvedCases(const std::string& controller) const {
  std::vector<std::vector<std::string>>& populations = evolved_[controller];
  if (!populations.empty()) return populations;
  for (int seed = 1; seed <= kEvolutions; ++seed) {
    const std::string dir = scratch_ / fmt::format("{}-{}", controller, seed);
    MustSucceed(Gauntlet({"evolve", experiment_, "--set", "controller=" + controller, "--dir", dir, "--seed",
                          std::to_string(seed), "--quiet"},
                         std::chrono::seconds(1200)));
    populations.push_back(WriteCases(Show(dir)["population"], dir + "-case"));
  }
  return populations;
}

std::vector<std::vector<double>> Study::Windows(const std::vector<std::string>& cases, int replicates,
                                                const std::vector<std::string>& settings,
                                                const std::string& prefix) const {
  const std::string dir = scratch_ / fmt::format("windows-{}", ++evaluations_);
  std::vector<std::string> arguments = {"evaluate", experiment_, "--json", "--quiet", "--dir", dir};
  arguments.insert(arguments.end(), {"--seed", std::to_string(kFreshRandomSeed),  //
                                     "--replicates", std::to_string(replicates)});
  for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
  std::vector<std::string> paths = cases;
  if (paths.empty()) {
    paths.push_back(scratch_ / "empty.json");
    std::ofstream(paths.back()) << R"({"obstacles": []})";
  }
  for (const std::string& path : paths) arguments.insert(arguments.end(), {"--case", path});
  const ProcessResult result = Gauntlet(arguments, std::chrono::seconds(1200));
  MustSucceed(result);
  const json document = json::parse(result.out, nullptr, false);
  std::vector<std::vector<double>> windows;
  for (const json& one : document["cases"]) {
    for (const json& run : one["runs"]) {
      std::vector<double>& values = windows.emplace_back();
      const json& metrics = run["metrics"];
      for (int i = 1; metrics.contains(prefix + std::to_string(i)); ++i) {
        values.push_back(metrics[prefix + std::to_string(i)].get<double>());
      }
    }
  }
  return windows;
}

std::vector<StudySample> Study::Random(const std::vector<std::string>& controllers) const {
  const std::vector<std::string> cases = RandomCases(kRandomCases);
  std::vector<StudySample> samples;
  for (const std::string& controller : controllers) {
    StudySample& sample = samples.emplace_back();
    for (const SimulatedCase& one :
         Simulate(controller, cases, scratch_ / fmt::format("random-{}", controller), kFreshRandomSeed)) {
      sample.push_back({one});
    }
  }
  return samples;
}

std::vector<StudySample> Study::Evolved(const std::vector<std::string>& controllers) const {
  std::vector<StudySample> samples(controllers.size());
  const auto& populations = EvolvedCases(controllers.front());
  for (std::size_t evolution = 0; evolution < populations.size(); ++evolution) {
    const int seed = static_cast<int>(evolution) + 1;
    for (std::size_t i = 0; i < controllers.size(); ++i) {
      const std::string dir =
          scratch_ / fmt::format("{}-{}-by-{}", controllers.front(), seed, controllers[i]);
      samples[i].push_back(Simulate(controllers[i], populations[evolution], dir, kFreshEvolvedSeed + seed));
    }
  }
  return samples;
}

}  // namespace gauntlet::testing_support
