// libFuzzer's entry point for the parser that GAUNTLET_FUZZED_PARSER names.
#include <cstddef>
#include <cstdint>

#include "tests/fuzz/parsers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const gauntlet::fuzz::Parser* const parser = [] {
    for (const gauntlet::fuzz::Parser& candidate : gauntlet::fuzz::Parsers()) {
      if (candidate.name == GAUNTLET_FUZZED_PARSER) return &candidate;
    }
    __builtin_trap();
  }();
  parser->read({reinterpret_cast<const char*>(data), size});
  return 0;
}
