#include "master/dispatch/pool/worker_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/master/store/store_records.h"

namespace gauntlet {
namespace {

using testing::HasSubstr;

// A worker program that is killed from outside the first `kills` times it is asked.
class WorkerProgramTest : public testing::Test {
 protected:
  void SetUp() override { setenv("GAUNTLET_WORKER", program_.c_str(), 1); }
  void TearDown() override { unsetenv("GAUNTLET_WORKER"); }
  void KilledTimes(int kills) {
    std::ofstream(program_) << "#!/bin/sh\n"
                            << "echo x >> '" << starts_ << "'\n"
                            << "[ $(wc -l < '" << starts_ << "') -gt " << kills << " ] || kill -KILL $$\n"
                            << "echo flocking 00000000000000ff\n";
    std::filesystem::permissions(program_, std::filesystem::perms::owner_all);
  }

  ScratchDirectory scratch_;
  std::string program_ = scratch_ / "worker";
  std::string starts_ = scratch_ / "starts";
};

TEST_F(WorkerProgramTest, AKillFromOutsideIsNoAnswer) {
  KilledTimes(2);
  const Result<proto::GoldenHashes> golden = GoldenHashesOfThisMachine({"flocking"});
  ASSERT_TRUE(golden.ok()) << golden.error().message;
  EXPECT_EQ(*golden, (proto::GoldenHashes{{"flocking", 0xff}}));
}

TEST_F(WorkerProgramTest, GivesUpOnOneThatIsAlwaysKilled) {
  KilledTimes(1000);
  const Result<proto::GoldenHashes> golden = GoldenHashesOfThisMachine({"flocking"});
  ASSERT_FALSE(golden.ok());
  EXPECT_THAT(golden.error().message, HasSubstr("worker ended by signal 9"));
}

}  // namespace
}  // namespace gauntlet
