// Compiled for the oldest x86-64 processor, unlike everything else (CMakeLists.txt).
#include <unistd.h>

namespace gauntlet {
namespace {

// Before anything else of the program: its own initialisation may use the instructions already.
__attribute__((constructor(101))) void RefuseProcessorsWithoutTheInstructions() {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt")) return;
  constexpr char kText[] =
      "gauntlet: this processor lacks instructions that the programs are built with (x86-64-v2: SSE4.2, "
      "POPCNT; "
      "processors since 2009 have them). Results are the same bits on every machine that has them.\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kText, sizeof kText - 1);
  _exit(2);
}

}  // namespace
}  // namespace gauntlet
