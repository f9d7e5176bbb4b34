// What the runs of gauntlet-worker-faulty do, chosen by their seed.
#pragma once

#include <cstdint>

namespace gauntlet::worker {

enum FaultyRun : std::uint64_t {
  kComplete = 1,  // fitness 0.5
  kAbort,         // prints "about to abort", then SIGABRT
  kSegmentationFault,
  kSpin,          // for ever
  kAllocate,      // for ever
  kAllocateHuge,  // in one piece
  kThrow,         // std::runtime_error("thrown on purpose")
  kExitWithThree,
  kPrintForEver,
  kWaitForFile,   // sleeps until the file named by the scenario exists, then completes
  kClosePipe,     // closes all its descriptors, then sleeps
  kWriteGarbage,  // writes nonsense to every socket it has
  kSleep,         // until it is killed, at no cost
};

// kWaitForFile creates the scenario's file name with this ending first.
inline constexpr const char* kBegun = ".begun";

}  // namespace gauntlet::worker
