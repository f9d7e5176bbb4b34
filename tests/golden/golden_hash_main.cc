// Prints the golden hashes of the build it is linked with, as gauntlet-worker --golden does.
#include <cinttypes>
#include <cstdio>

#include "worker/golden_hash.h"

int main() {
  for (const auto& [controller, hash] : gauntlet::worker::GoldenHashes()) {
    std::printf("%s %016" PRIx64 "\n", controller.c_str(), hash);
  }
  return 0;
}
