#include "master/campaign/state_digest.h"

#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>

#include "base/canonical_encoder.h"
#include "master/store/run_numbers.h"

namespace gauntlet {
namespace {

// Changes whenever the encoding does. Do not reuse a number.
constexpr std::uint64_t kDigestFormat = 1;

using Digest = std::array<unsigned char, 32>;

// BLAKE2b with 32 bytes of output and no key.
Digest HashOf(const std::string& bytes) {
  Digest digest{};
  GAUNTLET_CHECK(sodium_init() >= 0, "libsodium does not start");
  crypto_generichash(digest.data(), digest.size(), reinterpret_cast<const unsigned char*>(bytes.data()),
                     bytes.size(), nullptr, 0);
  return digest;
}

}  // namespace

Result<ResultsDigest> ResultsDigest::Restore(std::string_view bytes) {
  ResultsDigest restored;
  if (bytes.size() != restored.digest_.size()) {
    return Error{ErrorKind::kCorrupt, fmt::format("a results digest of {} bytes instead of {}", bytes.size(),
                                                  restored.digest_.size())};
  }
  std::copy(bytes.begin(), bytes.end(), restored.digest_.begin());
  return restored;
}

std::string ResultsDigest::bytes() const {
  return {digest_.begin(), digest_.end()};
}

void ResultsDigest::Add(const StoredRun& run) {
  CanonicalEncoder encoder;
  encoder.String(bytes());
  encoder.Uint(kOnlySearch);
  encoder.Uint(SequenceOf(run.id));
  encoder.Uint(run.individual);
  encoder.Uint(run.evaluation);
  encoder.Uint(run.replicate);
  encoder.Uint(run.seed);
  encoder.Uint(run.hash);
  encoder.Int(static_cast<int>(run.verdict));
  digest_ = HashOf(encoder.bytes());
}

std::string StateHash(std::string_view experiment, const ResultsDigest& results, std::string_view population,
                      std::string_view search_state) {
  CanonicalEncoder encoder;
  encoder.Reserve(experiment.size() + population.size() + search_state.size() + 1024);
  encoder.Uint(kDigestFormat);
  encoder.String(experiment);
  encoder.String(results.bytes());
  encoder.String(population);
  encoder.String(search_state);
  std::string hex;
  for (const unsigned char byte : HashOf(encoder.bytes())) hex += fmt::format("{:02x}", byte);
  return hex;
}

}  // namespace gauntlet
