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
class StreamedHash {
 public:
  StreamedHash() {
    GAUNTLET_CHECK(sodium_init() >= 0, "libsodium does not start");
    crypto_generichash_init(&state_, nullptr, 0, Digest().size());
  }
  void Add(std::string_view bytes) {
    crypto_generichash_update(&state_, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  }
  Digest Take() {
    Digest digest{};
    crypto_generichash_final(&state_, digest.data(), digest.size());
    return digest;
  }

 private:
  crypto_generichash_state state_;
};

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
  StreamedHash hash;
  hash.Add(encoder.bytes());
  digest_ = hash.Take();
}

std::string StateHash(std::string_view experiment, const ResultsDigest& results, std::string_view population,
                      std::string_view search_state) {
  CanonicalEncoder format;
  format.Uint(kDigestFormat);
  StreamedHash hash;
  hash.Add(format.bytes());
  const std::string digest = results.bytes();
  for (const std::string_view part : {experiment, std::string_view(digest), population, search_state}) {
    CanonicalEncoder size;
    size.Uint(part.size());
    hash.Add(size.bytes());
    hash.Add(part);
  }
  std::string hex;
  for (const unsigned char byte : hash.Take()) hex += fmt::format("{:02x}", byte);
  return hex;
}

}  // namespace gauntlet
