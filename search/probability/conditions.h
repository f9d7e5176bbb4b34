// The distribution over which a failure probability is asked for: what [conditions] of an experiment states,
// and the arenas. A sample is a list of independent random numbers, and all else is a function of it; so a
// step from one sample to a near one is a step of these numbers that is as probable as the way back.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/result.h"
#include "search/evolution/genome_generator.h"
#include "search/experiment/varied_keys.h"
#include "search/search_setup.h"

namespace gauntlet {

// One sample.
struct Sample {
  std::vector<double> scores;   // standard normal ones, of the keys that vary, in their order
  std::vector<GeneDraw> genes;  // of a generated arena; of a given one none
  std::size_t of_case = 0;      // of the given cases, from 0
};

// Immutable; thread-safe.
class Conditions {
 public:
  // setup.cases: those that are given; a single one without obstacles stands for the arenas that the
  // experiment generates. Error: that of ReadConditions or of the weights; no case; the ranges of genes leave
  // no room.
  static Result<Conditions> Make(const SearchSetup& setup, std::span<const Key> keys);

  const std::vector<VariedKey>& varied() const { return varied_; }
  bool generates() const { return generates_; }
  std::size_t size() const;  // of a sample: what a step can change

  Sample Draw(sim::RandomStream random) const;
  // A step that leaves the distribution as it is, and is reversible under it: the scores move together
  // (preconditioned Crank-Nicolson; Neal 1998, Cotter et al. 2013), some genes are moved or drawn anew.
  Sample Near(Sample sample, sim::RandomStream random) const;

  std::vector<KeyValue> ValuesOf(const Sample& sample) const;
  sim::TestCase CaseOf(const Sample& sample) const;
  // Its density as a share of the largest that there is; generated arenas count equal.
  double DensityOf(const Sample& sample) const;

 private:
  Conditions(const SearchSetup& setup, std::vector<VariedKey> varied, std::vector<double> weights);

  std::vector<VariedKey> varied_;
  std::vector<sim::TestCase> cases_;
  std::vector<double> weights_;  // of the cases, which sum to 1
  bool generates_ = false;
  GenomeGenerator generator_;
};

}  // namespace gauntlet
