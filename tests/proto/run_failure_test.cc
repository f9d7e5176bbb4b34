// Failures of runs in words.
#include "proto/run_failure.h"

#include <gtest/gtest.h>

namespace gauntlet::proto {
namespace {

TEST(Explained, SaysWhatANumberStandsFor) {
  const auto explained_exit = [](int code) {
    return Explained(Describe({.kind = FailureKind::kCrashed, .exit_code = code}));
  };
  EXPECT_EQ(Explained(Describe({.kind = FailureKind::kCrashed, .signal = 11})),
            "crashed with signal 11 (SIGSEGV)");
  EXPECT_EQ(explained_exit(kExitException), "crashed with exit code 87 (an exception that nobody caught)");
  EXPECT_EQ(explained_exit(kExitWithoutResult),
            "crashed with exit code 89 (exit was called before the run's end)");
  EXPECT_EQ(explained_exit(3), "crashed with exit code 3 (exit was called before the run's end)");
  EXPECT_EQ(explained_exit(kExitSignalled + 15),
            "crashed with exit code 143 (SIGTERM, which its own process sent)");
}

TEST(Explained, LeavesOtherMessagesAsTheyAre) {
  for (const char* message :
       {"exceeded its CPU time", "crashed with signal x", "", "crashed with exit code "})
    EXPECT_EQ(Explained(message), message);
}

}  // namespace
}  // namespace gauntlet::proto
