// Prints the golden hash of the build it is linked with.
#include <cinttypes>
#include <cstdio>

#include "worker/golden_hash.h"

int main() {
  std::printf("%016" PRIx64 "\n", gauntlet::worker::GoldenHash());
  return 0;
}
