// The bulk of what is stored, spec and result of every run, made small: runs of a campaign are much alike, so
// that Zstandard saves most with one of them at hand.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "base/result.h"

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;
struct ZSTD_CDict_s;
struct ZSTD_DDict_s;

namespace gauntlet {

// Packs and unpacks byte strings of one kind. Not thread-safe.
class Packing {
 public:
  Packing();

  // From now on bytes that resemble `example` become small; what was packed before is still unpacked. Once.
  void Learn(std::string_view example);
  bool learned() const { return compress_with_ != nullptr; }

  // At most one byte longer than `bytes`. What differs from bytes shortly before in one short stretch, as the
  // specs of replicates do, is not compressed again.
  std::string Pack(std::string_view bytes);
  // Error: kCorrupt, not what Pack has made with the same example.
  Result<std::string> Unpack(std::string_view packed);

 private:
  struct Freer {
    void operator()(ZSTD_CCtx_s* context) const;
    void operator()(ZSTD_DCtx_s* context) const;
    void operator()(ZSTD_CDict_s* dictionary) const;
    void operator()(ZSTD_DDict_s* dictionary) const;
  };

  struct Packed {
    std::string bytes;
    std::string packed;
  };

  std::string PackWhole(std::string_view bytes);
  // Empty: not so much like `before`.
  static std::string PackChanged(std::string_view bytes, const Packed& before);
  Result<std::string> UnpackChanged(std::string_view packed);

  std::unique_ptr<ZSTD_CCtx_s, Freer> compressor_;
  std::unique_ptr<ZSTD_DCtx_s, Freer> decompressor_;
  std::unique_ptr<ZSTD_CDict_s, Freer> compress_with_;
  std::unique_ptr<ZSTD_DDict_s, Freer> decompress_with_;
  // The last ones that were packed as a whole: results of several workers come in turn.
  std::array<Packed, 8> before_;
  std::size_t wholes_ = 0;
};

}  // namespace gauntlet
