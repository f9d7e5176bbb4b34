#include "master/store/packing.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#include "base/check.h"

namespace gauntlet {
namespace {

// How the bytes behind it are packed; the first byte of everything packed. Stored: do not change.
constexpr char kPlain = 'p';
constexpr char kAlone = 'z';        // Zstandard
constexpr char kWithExample = 'e';  // Zstandard, the example as its dictionary
constexpr char kChanged = 'c';  // a stretch of bytes that takes the place of another, then bytes packed so

// In front of what is changed: the letter, where (little-endian) and how many bytes, then the bytes.
constexpr std::size_t kWhereBytes = sizeof(std::uint32_t);
constexpr std::size_t kChangeHead = 1 + kWhereBytes + 1;
// Replicates differ in their seed, of eight bytes.
constexpr std::size_t kMostChanged = 16;
// Longer than any spec: results with trajectories are no use to remember.
constexpr std::size_t kMostRemembered = 64U << 10;
static_assert(std::endian::native == std::endian::little);

// Zstandard's fastest that does not pack much less. Level 3, its default, makes results 1 to 4 % smaller
// (with trajectories 5 %) and takes two to four times as long (ten times).
constexpr int kLevel = -1;
// What Zstandard puts around the bytes takes back what it could save of fewer: results of a few numbers.
constexpr std::size_t kFewestBytes = 64;
// Of what is unpacked: far above any result with every robot's trajectory.
constexpr std::uint64_t kMostBytes = 256U << 20;

Error Damaged(const std::string& what) {
  return {ErrorKind::kCorrupt, what};
}

}  // namespace

void Packing::Freer::operator()(ZSTD_CCtx_s* context) const {
  ZSTD_freeCCtx(context);
}
void Packing::Freer::operator()(ZSTD_DCtx_s* context) const {
  ZSTD_freeDCtx(context);
}
void Packing::Freer::operator()(ZSTD_CDict_s* dictionary) const {
  ZSTD_freeCDict(dictionary);
}
void Packing::Freer::operator()(ZSTD_DDict_s* dictionary) const {
  ZSTD_freeDDict(dictionary);
}

Packing::Packing() : compressor_(ZSTD_createCCtx()), decompressor_(ZSTD_createDCtx()) {
  GAUNTLET_CHECK(compressor_ && decompressor_, "no memory for Zstandard");
}

void Packing::Learn(std::string_view example) {
  GAUNTLET_CHECK(!learned(), "only one example can be learned from");
  compress_with_.reset(ZSTD_createCDict(example.data(), example.size(), kLevel));
  decompress_with_.reset(ZSTD_createDDict(example.data(), example.size()));
  GAUNTLET_CHECK(compress_with_ && decompress_with_, "no memory for Zstandard");
  before_ = {};  // with the example it becomes smaller
}

std::string Packing::Pack(std::string_view bytes) {
  if (bytes.size() < kFewestBytes) return kPlain + std::string(bytes);
  if (bytes.size() > kMostRemembered) return PackWhole(bytes);
  for (const Packed& before : before_) {
    if (std::string changed = PackChanged(bytes, before); !changed.empty()) return changed;
  }
  Packed& oldest = before_[wholes_++ % before_.size()];
  oldest = {std::string(bytes), PackWhole(bytes)};
  return oldest.packed;
}

std::string Packing::PackChanged(std::string_view bytes, const Packed& before) {
  if (bytes.size() != before.bytes.size()) return {};
  const auto from = std::mismatch(bytes.begin(), bytes.end(), before.bytes.begin()).first - bytes.begin();
  const std::string_view rest = bytes.substr(static_cast<std::size_t>(from));
  const auto same = std::mismatch(rest.rbegin(), rest.rend(), before.bytes.rbegin()).first - rest.rbegin();
  const std::string_view change = rest.substr(0, rest.size() - static_cast<std::size_t>(same));
  if (change.size() > kMostChanged || kChangeHead + change.size() + before.packed.size() > bytes.size())
    return {};
  const auto where = static_cast<std::uint32_t>(from);
  std::string packed(kChangeHead, kChanged);
  std::memcpy(&packed[1], &where, kWhereBytes);
  packed[1 + kWhereBytes] = static_cast<char>(change.size());
  packed.reserve(kChangeHead + change.size() + before.packed.size());
  return packed.append(change).append(before.packed);
}

std::string Packing::PackWhole(std::string_view bytes) {
  std::string packed(1 + ZSTD_compressBound(bytes.size()), kPlain);
  char* const to = packed.data() + 1;
  const std::size_t room = packed.size() - 1;
  const std::size_t size =
      learned() ? ZSTD_compress_usingCDict(compressor_.get(), to, room, bytes.data(), bytes.size(),
                                           compress_with_.get())
                : ZSTD_compressCCtx(compressor_.get(), to, room, bytes.data(), bytes.size(), kLevel);
  if (ZSTD_isError(size) != 0 || size >= bytes.size()) {
    packed.assign(1, kPlain);
    return packed.append(bytes);
  }
  packed.front() = learned() ? kWithExample : kAlone;
  packed.resize(1 + size);
  return packed;
}

Result<std::string> Packing::Unpack(std::string_view packed) {
  if (packed.empty()) return Damaged("nothing is stored where packed bytes should be");
  const char how = packed.front();
  packed.remove_prefix(1);
  if (how == kPlain) return std::string(packed);
  if (how == kChanged) return UnpackChanged(packed);
  if (how != kAlone && how != kWithExample)
    return Damaged(fmt::format("the packed bytes begin with {:#04x}, which is no way of packing",
                               static_cast<unsigned char>(how)));
  if (how == kWithExample && !learned())
    return Damaged("the example that the bytes were packed with is missing");
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size > kMostBytes) return Damaged("the packed bytes do not say how many they were");
  std::string bytes(size, '\0');
  const std::size_t got =
      how == kAlone
          ? ZSTD_decompressDCtx(decompressor_.get(), bytes.data(), bytes.size(), packed.data(), packed.size())
          : ZSTD_decompress_usingDDict(decompressor_.get(), bytes.data(), bytes.size(), packed.data(),
                                       packed.size(), decompress_with_.get());
  if (ZSTD_isError(got) != 0)
    return Damaged(fmt::format("the packed bytes do not unpack: {}", ZSTD_getErrorName(got)));
  if (got != size) return Damaged(fmt::format("{} bytes were unpacked instead of {}", got, size));
  return bytes;
}

Result<std::string> Packing::UnpackChanged(std::string_view packed) {
  std::uint32_t where = 0;
  const std::size_t head = kChangeHead - 1;
  const std::size_t count =
      packed.size() < head ? kMostChanged + 1 : static_cast<unsigned char>(packed[kWhereBytes]);
  if (count > kMostChanged || packed.size() - head <= count || packed[head + count] == kChanged)
    return Damaged("the packed bytes do not say what was changed of them");
  std::memcpy(&where, packed.data(), kWhereBytes);
  TRY(std::string bytes, Unpack(packed.substr(head + count)));
  if (count > bytes.size() || where > bytes.size() - count)
    return Damaged("what was changed of the packed bytes lies outside of them");
  bytes.replace(where, count, packed.substr(head, count));
  return bytes;
}

}  // namespace gauntlet
