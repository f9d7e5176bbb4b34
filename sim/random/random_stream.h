// Counter-based random numbers (Philox4x32-10; Salmon et al. 2011): a number depends on its key and its
// place, never on what was drawn before elsewhere. Neighbouring keys give independent streams.
#pragma once

#include <array>
#include <cstdint>

namespace gauntlet::sim {

using PhiloxBlock = std::array<std::uint32_t, 4>;
using PhiloxKey = std::array<std::uint32_t, 2>;
// The generator itself: a bijection of 128-bit counters for every key.
PhiloxBlock Philox4x32(const PhiloxBlock& counter, const PhiloxKey& key);

// What a stream is for. Stored runs depend on these numbers: do not renumber.
enum class StreamPurpose : std::uint32_t {
  kSpawn = 1,
  kController = 2,
  kGenome = 4,     // random test cases
  kVariation = 5,  // shuffling, crossover, mutation
  kTest = 6,
  kStatistics = 7,         // bootstrap
  kProposals = 8,          // of a search over settings
  kFirstDeviceNoise = 16,  // to 47: one for each device (sim/robot/disturber.h)
  kFaultyRobots = 48,
};

// Draws from one stream. Copying copies the position. Not for sharing between threads.
class RandomStream {
 public:
  // (seed, purpose, a, b) name the stream; typically a = robot, b = tick, or a = generation, b = slot.
  RandomStream(std::uint64_t seed, StreamPurpose purpose, std::uint32_t a = 0, std::uint32_t b = 0);

  std::uint32_t NextUint32();
  std::uint64_t NextUint64();
  // In [0, 1), 53 random bits.
  double Uniform();
  // In [low, high); low <= high, equal ones give low.
  double Uniform(double low, double high);
  // In [0, bound), without bias; bound >= 1.
  std::uint32_t Below(std::uint32_t bound);
  bool Chance(double probability) { return Uniform() < probability; }
  // Mean 0, standard deviation 1 (Box and Muller 1958).
  double Gaussian();

 private:
  PhiloxKey key_;
  PhiloxBlock counter_;  // number of the next block, purpose, a, b
  PhiloxBlock block_{};
  int used_ = 4;  // words of block_ that were handed out
};

// What a derived seed is for, so that confirming a result never meets a seed of the search. Do not renumber.
enum class SeedPurpose : std::uint32_t {
  kSearch = 1,
  kFinalResimulation = 2,
  kConfirm = 3,
  kStudy = 4,
  kEvaluate = 5,
  kMinimise = 6,
  kBlame = 7,
  kCheck = 8,
  kFit = 9,
  kMargin = 10,
  kRepair = 11,
  kProbability = 12,
};

// The seed of one run. Seeds are derived, never drawn in order, so any run can be repeated alone.
std::uint64_t DeriveSeed(std::uint64_t campaign_seed, SeedPurpose purpose, std::uint32_t search,
                         std::uint64_t individual, std::uint32_t evaluation, std::uint32_t replicate);

}  // namespace gauntlet::sim
