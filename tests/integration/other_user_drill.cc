#include "tests/integration/other_user_drill.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>

#include "tests/integration/service_driver.h"
#include "tests/integration/stranger.h"

namespace gauntlet::testing_support {

void EvolveUnderForgery(const SmallCampaign& campaign, const std::string& dir, int each) {
  using testing::HasSubstr;
  using testing::Not;
  // The folder is open to all, as on a shared machine: only the files' own modes protect them.
  const std::filesystem::path folder = std::filesystem::path(dir).parent_path();
  ASSERT_EQ(chmod(folder.c_str(), 0755), 0);
  const std::unique_ptr<Process> master =
      StartGauntlet(EvolveArguments(campaign, dir, 2),
                    {"GAUNTLET_WORKER=" + WorkerPath() + "-slow", "GAUNTLET_TEST_RUN_MILLISECONDS=200"});
  ASSERT_TRUE(RunsDone(dir, 2)) << master->Err();
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_EQ(ForgeAsAnotherUser(dir, each), "");
  fmt::print("{} messages of each kind in {:.1f} s\n", each,
             std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count());
  EXPECT_TRUE(master->Running()) << "it must last longer than the attack, or little is shown";
  nlohmann::json status;
  EXPECT_TRUE(StatusBecomes(dir, [&](const nlohmann::json& now) {
    status = now;
    return now.value("rejected_messages", 0) >= each;
  }));
  fmt::print("{} messages and connections were dropped\n", status.value("rejected_messages", 0));
  EXPECT_EQ(status.value("workers", 0), 2);
  const ProcessResult result = master->Wait(std::chrono::seconds(600));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(StateHash(dir), UndisturbedHash(campaign));
  for (const char* event :
       {"runner-failure", "run-given-up", "run-returned", "worker-refused", "forged", "0000000000000666"})
    EXPECT_THAT(MasterLog(dir), Not(HasSubstr(event)));
}

}  // namespace gauntlet::testing_support
