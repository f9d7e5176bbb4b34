#include "sim/random/random_stream.h"

#include <Random123/philox.h>

#include <cmath>
#include <string>

#include "base/check.h"
#include "sim/geometry/trigonometry.h"

namespace gauntlet::sim {
namespace {

std::uint32_t LowWord(std::uint64_t value) {
  return static_cast<std::uint32_t>(value);
}
std::uint32_t HighWord(std::uint64_t value) {
  return static_cast<std::uint32_t>(value >> 32);
}

// Stands where a stream's counter holds its purpose, so that no derived seed reads a block of a stream.
constexpr std::uint32_t kSeedDomain = 0x53454544;  // "SEED"

}  // namespace

PhiloxBlock Philox4x32(const PhiloxBlock& counter, const PhiloxKey& key) {
  const r123::Philox4x32 philox;
  const r123::Philox4x32::ctr_type in = {{counter[0], counter[1], counter[2], counter[3]}};
  const r123::Philox4x32::key_type with = {{key[0], key[1]}};
  const r123::Philox4x32::ctr_type out = philox(in, with);
  return {out.v[0], out.v[1], out.v[2], out.v[3]};
}

RandomStream::RandomStream(std::uint64_t seed, StreamPurpose purpose, std::uint32_t a, std::uint32_t b)
    : key_{LowWord(seed), HighWord(seed)}, counter_{0, static_cast<std::uint32_t>(purpose), a, b} {}

std::uint32_t RandomStream::NextUint32() {
  if (used_ == 4) {
    block_ = Philox4x32(counter_, key_);
    ++counter_[0];
    used_ = 0;
  }
  return block_[static_cast<std::size_t>(used_++)];
}

std::uint64_t RandomStream::NextUint64() {
  const std::uint64_t low = NextUint32();
  return low | (static_cast<std::uint64_t>(NextUint32()) << 32);
}

double RandomStream::Uniform() {
  return static_cast<double>(NextUint64() >> 11) * 0x1p-53;
}

double RandomStream::Uniform(double low, double high) {
  GAUNTLET_CHECK(low <= high, "Uniform(" + std::to_string(low) + ", " + std::to_string(high) + ")");
  const double value = low + (high - low) * Uniform();
  if (value < high || low == high) return value;
  return std::nextafter(high, low);
}

std::uint32_t RandomStream::Below(std::uint32_t bound) {
  GAUNTLET_CHECK(bound >= 1, "Below(0) has nothing to draw from");
  // Multiply and reject (Lemire 2019): the high word is uniform once the 2^32 mod bound lowest products of
  // each value are left out.
  std::uint64_t product = static_cast<std::uint64_t>(NextUint32()) * bound;
  if (LowWord(product) < bound) {
    const std::uint32_t rejected = (0u - bound) % bound;
    while (LowWord(product) < rejected) product = static_cast<std::uint64_t>(NextUint32()) * bound;
  }
  return HighWord(product);
}

double RandomStream::Gaussian() {
  const double radius = std::sqrt(-2.0 * Log(1.0 - Uniform()));
  return radius * Cos(2.0 * kPi * Uniform());
}

std::uint64_t DeriveSeed(std::uint64_t campaign_seed, SeedPurpose purpose, std::uint32_t search,
                         std::uint64_t individual, std::uint32_t evaluation, std::uint32_t replicate) {
  // The arguments do not fit into one counter: the first block keys the second.
  const PhiloxBlock of_search = Philox4x32({static_cast<std::uint32_t>(purpose), kSeedDomain, search, 0},
                                           {LowWord(campaign_seed), HighWord(campaign_seed)});
  const PhiloxBlock of_run = Philox4x32({LowWord(individual), HighWord(individual), evaluation, replicate},
                                        {of_search[0], of_search[1]});
  return of_run[0] | (static_cast<std::uint64_t>(of_run[1]) << 32);
}

}  // namespace gauntlet::sim
