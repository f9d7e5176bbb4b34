// A chapter of the thesis in small, through the command line: test cases evolved against a controller, and
// random ones, all simulated again with fresh seeds and compared.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "analysis/statistics/rank_test.h"
#include "tests/support/process.h"

namespace gauntlet::testing_support {

// Runs that belong together: one evolution's final population, or a single random case.
struct SimulatedCase {
  double fitness = 0.0;
  bool condition_1 = false;  // of foraging (thesis 5.1.1)
  bool condition_2 = false;
};
using StudyCluster = std::vector<SimulatedCase>;
// The sampling unit of the statistics is the cluster.
using StudySample = std::vector<StudyCluster>;

double MeanFitness(const StudySample& sample);
double ShareOf(const StudySample& sample, const std::function<bool(const SimulatedCase&)>& holds);
bool BroughtNothing(const SimulatedCase& one);  // fitness 0
// Prints a row of the table for each: n, mean, standard deviation, zeros, and the conditions where there are
// any.
void PrintSamples(const std::vector<std::pair<std::string, StudySample>>& samples);

struct Comparison {
  analysis::RankTest test;   // one-tailed Mann-Whitney
  double lower_bound = 0.0;  // one-sided 95 %, of A = P(first > second); clusters are resampled
};
// Computes and prints it.
Comparison CompareSamples(const std::string& name, const StudySample& first, const StudySample& second);
// Every chapter's finding: evolved cases are tougher for the controller than random ones, and the improved
// controller stands them better. `evolved`: simulated with the controller and with the improved one.
void ExpectTougherAndBetter(const StudySample& random, const std::vector<StudySample>& evolved);

// One study: an experiment and the controllers that are tested in it. Every call runs programs and takes
// minutes; what fails is a test failure.
class Study {
 public:
  static constexpr int kEvolutions = 10;
  static constexpr int kRandomCases = 200;

  explicit Study(std::string experiment) : experiment_(std::move(experiment)) {}

  // The random cases, as case files that live as long as this object.
  std::vector<std::string> RandomCases(int count) const;
  // The final populations of evolutions against the controller with the experiment's defaults, as such files.
  // Evolves once only.
  const std::vector<std::vector<std::string>>& EvolvedCases(const std::string& controller) const;
  // Per run the metrics PREFIX1, PREFIX2, ... of these cases (none: the empty arena), `replicates` runs of
  // each, with `settings` of the experiment (key=value) changed.
  std::vector<std::vector<double>> Windows(const std::vector<std::string>& cases, int replicates,
                                           const std::vector<std::string>& settings,
                                           const std::string& prefix) const;

  // Valid random cases, every one a cluster, simulated with each of the controllers, with the same seeds.
  std::vector<StudySample> Random(const std::vector<std::string>& controllers) const;
  // Evolutions against the first controller with the experiment's defaults; their final populations simulated
  // with each of the controllers, with the same seeds.
  std::vector<StudySample> Evolved(const std::vector<std::string>& controllers) const;

 private:
  StudyCluster Simulate(const std::string& controller, const std::vector<std::string>& cases,
                        const std::string& dir, int seed) const;

  std::string experiment_;
  TemporaryDirectory scratch_;
  mutable std::map<std::string, std::vector<std::vector<std::string>>> evolved_;  // by controller
  mutable int evaluations_ = 0;
};

}  // namespace gauntlet::testing_support
